"""Workshop drawing of a shoe: A3 sheet to ISO 128, 129, 5459, 1101 and 7200. In mm.

Datum A is the printed lower face, B plane y = 0 and C plane x = 0 below the ankle.
"""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.geometry.section import section, section_along
from plantar.shoes.papers.sheet import Sheet, View
from plantar.shoes.plan.heel import slot_entry
from plantar.shoes.plan.shoe_plan import pad_rim
from plantar.shoes.solid.pad import land_top
from plantar.shoes.solid.step_model import release_date
from plantar.shoes.units import to_mm

_SCALES = ((2.0, "2:1"), (1.0, "1:1"), (0.5, "1:2"), (0.4, "1:2.5"), (0.2, "1:5"))
_PLAN = (150.0, 78.0)  # mm of paper for the view from above
_DETAIL = 17.0  # mm of paper: radius of a detail
_ROWS = 46  # of a column of the table of features
_DATUMS = "A printed lower face, B plane y = 0, C plane x = 0"
_OFF = 1.3e-3  # mm next to a place where corners lie

Array = NDArray[np.float64]


def draw_shoe(shoe: Shoe, build: ShoeBuild, triangles: Array, paths: Sequence[str | os.PathLike[str]]) -> list[Path]:
    """Draw a build's shoe with triangles (n, 3, 3) in mm to paths: .pdf, .png or .svg; returns these."""
    return sheet_of(shoe, build, triangles).write(*paths)


def sheet_of(shoe: Shoe, build: ShoeBuild, triangles: Array) -> Sheet:
    """Gives sheet of a build's shoe with triangles, as written by `draw_shoe`."""
    sheet = Sheet()
    body = triangles.reshape(-1, 3)
    low = body.min(axis=0)
    high = body.max(axis=0)
    size = high - low
    scale, name = next(((s, n) for s, n in _SCALES if size[0] * s <= _PLAN[0] and size[1] * s <= _PLAN[1]), _SCALES[-1])
    sheet.box((20.0, 10.0), (410.0, 287.0), "OUTLINE")
    cut_y, cut_x = _cuts(shoe, build)
    middle = 0.5 * (low + high)
    top = View(sheet, scale, (116.0, 222.0), (float(middle[0]), float(middle[1])))
    _plan(top, shoe, build, low, high, (cut_x, cut_y))
    below = 222.0 - 0.5 * size[1] * scale - 22.0 - size[2] * scale - 14.0
    along = View(sheet, scale, (116.0, below), (float(middle[0]), 0.0))
    cut = _section(along, shoe, build, triangles, 1, cut_y, "A-A")
    _heights(along, build, cut)
    across = View(sheet, scale, (246.0, 222.0 - 0.5 * size[2] * scale), (float(middle[1]), 0.0))
    cut = _section(across, shoe, build, triangles, 0, cut_x, "B-B")
    ends = [across.place(cut.bounds[0], z) for z in (0.0, cut.bounds[3])]
    sheet.dimension(ends[0], ends[1], f"{cut.bounds[3]:.1f} ±0.3", -9.0)
    _details(top, along, across, shoe, build, triangles, cut)
    _features(sheet, shoe, build)
    _inspection(sheet, shoe, build)
    _title(sheet, shoe, build, name)
    return sheet


def _cuts(shoe: Shoe, build: ShoeBuild) -> tuple[float, float]:
    positions = to_mm(shoe.layout.positions)
    middle = 0.5 * (shoe.plan.contact.bounds[1] + shoe.plan.contact.bounds[3])
    cut_y = float(positions[np.argmin(np.abs(positions[:, 1] - middle)), 1])
    places = build.retention.places if build.retention is not None else ()
    cut_x = places[-1].x if places else float(positions[:, 0].mean())
    return cut_y + _OFF, cut_x + _OFF


def _plan(view: View, shoe: Shoe, build: ShoeBuild, low: Array, high: Array, cuts: tuple[float, float]) -> None:
    plan = shoe.plan
    sheet = view.sheet
    p = build.parameters
    flip = 1.0 if shoe.side == "left" else -1.0
    for pocket in plan.pockets:
        view.draw(pocket, "HIDDEN")
    centres = to_mm(shoe.layout.positions[:, :2])
    for (x, y), number in zip(centres.tolist(), shoe.layout.ids.tolist(), strict=True):
        sheet.text(view.place(x, y - 1.0), str(number), 2.0, align="center")
    for i, j in plan.route:
        sheet.line(view.at(centres[[i, j]]), "CABLE")
    for c in plan.connectors[:1]:
        sheet.line(view.at([centres[c], (plan.heel.x, plan.heel.y)]), "CABLE")
    view.draw(plan.contact, "OUTLINE")
    if build.kind == "shoe":
        view.draw(plan.rim)
        view.draw(plan.cavity)
    view.draw(shapely.affinity.scale(build.foot.sole, 1.0, flip, origin=(0.0, 0.0)), "FOOT")
    if plan.heel.board:
        slot = shapely.box(-p.board_gap - p.board_thickness, -0.5 * p.board_length, -p.board_gap, 0.5 * p.board_length)
        view.draw(plan.heel.placed(slot))
    left, bottom = view.place(low[0], low[1])
    right, upper = view.place(high[0], high[1])
    zero = view.place(0.0, 0.0)
    sheet.line([(left - 8.0, zero[1]), (right + 8.0, zero[1])], "CENTRE")
    sheet.line([(zero[0], bottom - 5.0), (zero[0], upper + 5.0)], "CENTRE")
    sheet.datum((right + 8.0, zero[1]), "B", (1.0, 0.0))
    sheet.datum((zero[0], upper + 5.0), "C", (0.0, 1.0))
    for letter, a, b, way in (
        ("A", (left - 14.0, view.place(0.0, cuts[1])[1]), (right + 4.0, view.place(0.0, cuts[1])[1]), (0.0, 1.0)),
        ("B", (view.place(cuts[0], 0.0)[0], bottom - 4.0), (view.place(cuts[0], 0.0)[0], upper + 4.0), (-1.0, 0.0)),
    ):
        sheet.line([a, b], "CENTRE")
        for end in (a, b):
            sheet.arrow((end[0] + 4.0 * way[0], end[1] + 4.0 * way[1]), way)
            sheet.line([end, (end[0] + 2.0 * way[0], end[1] + 2.0 * way[1])], "OUTLINE")
            sheet.text((end[0] - 2.0 + 5.0 * way[0], end[1] + 4.5 * way[1]), letter, 3.5)
    face = plan.contact.bounds
    a = view.place(face[0], low[1])
    b = view.place(face[2], low[1])
    sheet.dimension(a, b, f"{face[2] - face[0]:.1f} ±0.3", -6.0)
    sheet.dimension((left, bottom), (right, bottom), f"({high[0] - low[0]:.1f})", -13.0)
    a = view.place(low[0], face[1])
    b = view.place(low[0], face[3])
    sheet.dimension((left, a[1]), (left, b[1]), f"{face[3] - face[1]:.1f} ±0.3", -17.0)
    sides = ("outer", "inner") if shoe.side == "left" else ("inner", "outer")
    sheet.text((left, upper + 2.0), f"left, {sides[0]} side", 2.0)
    sheet.text((left, bottom - 3.5), f"right, {sides[1]} side", 2.0)
    sheet.text((right - 8.0, upper + 2.0), "toes", 2.5)
    sheet.text((left + 30.0, upper + 2.0), "heel", 2.5)
    sheet.text((24.0, 281.0), f"From above; the contact face reaches {plan.overhang:.1f} beyond the foot", 3.5)


def _section(view: View, shoe: Shoe, build: ShoeBuild, triangles: Array, axis: int, at: float, name: str) -> Any:
    p = build.parameters
    plan = shoe.plan
    sheet = view.sheet
    cut = section_along(triangles, axis, at)
    across = 1 - axis
    line = shapely.LineString([(at, -1e4), (at, 1e4)] if axis == 0 else [(-1e4, at), (1e4, at)])

    def filled(shapes: Any, low: float, high: float, colour: str) -> None:
        for part in (q for s in shapes for q in shapely.get_parts(s.intersection(line)) if q.length > 0.0):
            a = part.bounds[across]
            b = part.bounds[across + 2]
            sheet.areas.append((colour, view.at([(a, low), (b, low), (b, high), (a, high)])))

    top = land_top(plan, p) if plan.lands else p.bottom
    filled(plan.lands or plan.cells, p.pad_thickness, top, "#b7e4c7")
    filled(plan.pockets, top, p.ceiling, "#b7e4c7")
    if p.pad_thickness > 0.0:
        filled([plan.contact], 0.0, p.pad_thickness, "#adb5bd")
        filled([pad_rim(plan, p)], p.pad_thickness, p.pad_thickness + p.pad_rim_height, "#adb5bd")
    view.hatch(cut)
    high = min(p.rim_top + 14.0 if build.kind == "shoe" else 2.0 * p.thickness, p.thickness + build.foot.height)
    view.draw(_foot_section(shoe, build, axis, at, high), "FOOT")
    letter, seen = ("y", "the right") if axis == 1 else ("x", "the toes")
    left, upper = view.place(cut.bounds[0], max(cut.bounds[3], high))
    sheet.text((left, upper + 2.0), f"{name}   {letter} = {at:.1f}, seen from {seen}", 3.0)
    return cut


def _foot_section(shoe: Shoe, build: ShoeBuild, axis: int, at: float, top: float) -> Any:
    floor = build.parameters.thickness
    triangles = build.foot.triangles
    room = shapely.box(-1e4, floor, 1e4, top)
    if triangles is not None:
        turned = triangles if shoe.side == "left" else (triangles * np.array([1.0, -1.0, 1.0]))[:, ::-1]
        cut = section_along(turned + np.array([0.0, 0.0, floor]), axis, at)
        if not cut.is_empty:
            return cut.intersection(room)
    place = at if shoe.side == "left" or axis == 0 else -at
    line = shapely.LineString([(place, -1e4), (place, 1e4)] if axis == 0 else [(-1e4, place), (1e4, place)])
    bands = []
    heights = np.linspace(0.0, top - floor, 8)
    for low, high in zip(heights[:-1].tolist(), heights[1:].tolist(), strict=True):
        ends = build.foot.passing(high).intersection(line).bounds
        if len(ends) == 4:
            a, b = sorted(v * (-1.0 if axis == 0 and shoe.side == "right" else 1.0) for v in ends[1 - axis :: 2])
            bands.append(shapely.box(a, floor + low, b, floor + high))
    return shapely.union_all(bands)


def _heights(view: View, build: ShoeBuild, cut: Any) -> None:
    p = build.parameters
    sheet = view.sheet
    low = cut.bounds[0]
    high = cut.bounds[2]
    made = build.parameters.made_by
    levels = [(p.thickness, f"{p.thickness:g} ±{2 * made.scatter:g}")]
    levels += [(p.rim_top, f"{p.rim_top:g} ±0.3")] if build.kind == "shoe" else []
    for n, (level, text) in enumerate(levels):
        sheet.dimension(view.place(high, 0.0), view.place(high, level), text, 9.0 + 9.0 * n)
    sheet.dimension(view.place(low, 0.0), view.place(low, p.bottom), f"{p.bottom:g}", -8.0)
    sheet.datum(view.place(0.3 * low + 0.7 * high, p.bottom), "A", (0.0, -1.0))


def _details(top: View, along: View, across: View, shoe: Shoe, build: ShoeBuild, triangles: Array, cut: Any) -> None:
    plan = shoe.plan
    p = build.parameters
    made = build.parameters.made_by
    flat = 2.0 * made.scatter
    half = p.bottom + 0.5 * p.pocket_depth
    cut_y, _ = _cuts(shoe, build)
    beside = section_along(triangles, 1, cut_y + 0.5 * p.port_width + 2.0)  # next to the ports
    details: list[tuple[str, View, Any, Array, float, tuple[str, ...]]] = [
        ("pocket and rib", along, beside, np.array([_rib(beside, half), half]), 3.4, (
            f"pocket {p.pocket_depth:g} +{flat:g} 0 deep", f"floor {p.floor:g} ±{flat:g}",
            f"rib {p.rib:g} ±{made.press:g}", f"groove {p.scribe:g} x 45°"))
    ]  # fmt: skip
    if plan.route:
        ends, _, most = plan.port(*plan.route[0])
        level = section(triangles, p.bottom + max(p.scribe, 0.5 * p.pocket_depth) + 0.05 + _OFF)
        texts: tuple[str, ...] = (f"port {min(p.port_width, most):.1f} ±{made.slide:g} wide", "cut at half the depth")
        details.append(("port", top, level, ends.mean(axis=0), 8.5, texts))
    if build.retention is not None and build.retention.places:
        width = build.retention.width
        kind = build.retention.kind
        flip = build.retention.places[-1].side * (1.0 if shoe.side == "left" else -1.0)
        edge = cut.bounds[2 if flip > 0.0 else 0]
        high = p.thickness + build.retention.top(p)
        name, texts = {
            "straps": (
                "lug",
                (
                    f"slot {width + 2:g} x {p.strap_thickness + 2:g} ±0.5",
                    f"{p.rim_top + 1:g} ±0.3 from the ground",
                    f"lug {p.rim_thickness:g} ±0.3",
                ),
            ),
            "clips": ("clip", (f"hook {p.clip_hook:g} ±0.2, 45°", f"arm {p.clip_thickness:g} ±0.2 x {p.clip_width:g}")),
        }.get(kind, ("boss", (f"hole ⌀{width + 0.3:g} ±0.2", f"slot of the nut {0.8 * width + 0.4:g} ±0.2")))
        details.append((name, across, cut, np.array([edge - 2.0 * flip, high - 6.0]), 8.5, texts))
    if plan.heel.board:
        level = section(triangles, p.thickness + 0.5 * p.rim_height + _OFF)
        wide = p.board_length + 2.0 * made.slide
        thick = p.board_thickness + 2.0 * made.slide
        texts = (
            f"slot {wide:g} x {thick:g} +{made.slide:g} 0, entry {slot_entry(p):g} x 45°",
            f"gap to the wall {p.board_gap:g} ±0.3",
            f"rails {p.rim_height:g} ±0.3 high, from {p.thickness:g}",
        )
        end = plan.heel.point(-p.board_gap, 0.5 * p.board_length)
        details.append(("slot of the board", top, level, end, 8.5, texts))
    for n, detail in enumerate(details):
        _detail("DEFG"[n], (45.0 + 47.0 * n, 54.0), *detail)


def _rib(cut: Any, height: float) -> float:
    low, _, high, _ = cut.bounds
    parts = shapely.get_parts(cut.intersection(shapely.LineString([(low, height), (high, height)])))
    middles = [0.5 * (q.bounds[0] + q.bounds[2]) for q in parts if q.length < 6.0] or [0.5 * (low + high)]
    return float(min(middles, key=lambda x: abs(x - 0.5 * (low + high))))


def _detail(
    letter: str, at: tuple[float, float], name: str, source: View, shape: Any, centre: Array,
    radius: float, texts: Sequence[str],
) -> None:  # fmt: skip
    sheet = source.sheet
    scale = _DETAIL / radius
    circle = shapely.Point(centre).buffer(radius, quad_segs=24)
    view = View(sheet, scale, at, (float(centre[0]), float(centre[1])))
    view.hatch(shape.intersection(circle))
    view.draw(circle)
    source.draw(circle)
    x, y = source.place(centre[0] + 0.8 * radius, centre[1] + 0.8 * radius)
    sheet.text((x, y), letter, 3.0)
    sheet.text((at[0], at[1] + _DETAIL + 2.0), f"{letter}   {name}   {scale:g}:1", 2.5, align="center")
    for n, text in enumerate(texts):
        sheet.text((at[0], at[1] - _DETAIL - 3.6 - 3.0 * n), text, 2.0, align="center")


def _features(sheet: Sheet, shoe: Shoe, build: ShoeBuild) -> None:
    plan = shoe.plan
    flip = 1.0 if shoe.side == "left" else -1.0
    rows = [
        (f"pocket {k}", f"{x:.2f}", f"{y:.2f}", "⌀0.3 A B C")
        for k, (x, y) in zip(shoe.layout.ids.tolist(), to_mm(shoe.layout.positions[:, :2]).tolist(), strict=True)
    ]
    ids = shoe.layout.ids.tolist()
    for i, j in plan.route:
        x, y = plan.port(i, j)[0].mean(axis=0).tolist()
        rows.append((f"port {ids[i]}-{ids[j]}", f"{x:.2f}", f"{y:.2f}", "⌀0.3 A B C"))
    if build.retention is not None:
        name = {"straps": "lug", "clips": "clip", "screws": "screw"}.get(build.retention.kind, "")
        for place in build.retention.places:
            rows.append((f"{name}, {'left' if place.side * flip > 0 else 'right'}", f"{place.x:.2f}", "wall", "0.3 C"))
    if plan.heel.board:
        rows.append(
            (f"board slot, {np.degrees(plan.heel.turn):.0f}°", f"{plan.heel.x:.2f}", f"{plan.heel.y:.2f}", "0.3 B C")
        )
    faces = ("contact face", "inner wall") if build.kind == "shoe" else ("contact face",)
    rows += [(name, "STEP", "STEP", "prof. 0.3 A B C") for name in faces]
    columns = -(-len(rows) // _ROWS)
    step = 3.4 * 0.9 * 2.0 / max(2, columns)
    per = -(-len(rows) // columns)
    wide = 124.0 / max(2, columns)
    for n in range(columns):
        widths = [0.33 * wide, 0.17 * wide, 0.17 * wide, 0.33 * wide]
        at = (410.0 - wide * (columns - n), 284.0)
        sheet.table(at, widths, [("Feature", "x to C", "y to B", "position"), *rows[n * per : (n + 1) * per]], step)


def _inspection(sheet: Sheet, shoe: Shoe, build: ShoeBuild) -> None:
    p = build.parameters
    made = build.parameters.made_by
    plan = shoe.plan
    flat = 2.0 * made.scatter
    rows = [
        ("flatness of A", "0", f"{flat:g}", "surface plate"),
        ("pocket depth from A", f"{p.pocket_depth:g}", f"+{flat:g} 0", "depth gauge"),
        ("ceilings, scatter of 5", "0", f"{made.scatter:g} (1 s)", "depth gauge"),
        ("floor over the pockets", f"{p.floor:g}", f"±{flat:g}", "caliper"),
        ("rib", f"{p.rib:g}", f"±{made.press:g}", "caliper"),
    ]
    if build.kind == "shoe":
        rows += [
            ("wall, thickness x height", f"{p.rim_thickness:g} x {p.rim_height:g}", "±0.3", "caliper"),
            ("gap of foot and wall", f"{p.clearance:g}", "±0.3", "feeler gauge"),
        ]
    if plan.heel.board:
        rows.append(("slot of the board", f"{p.board_length + 2 * made.slide:g}", f"+{made.slide:g} 0", "the board"))
    if build.retention is not None and build.retention.kind == "straps":
        rows.append(("slot of each lug", f"{build.retention.width + 2:g} x {p.strap_thickness + 2:g}", "±0.5", "strap"))
    sheet.table(
        (230.0, 112.0),
        [36.0, 26.0, 22.0, 22.0, 20.0],
        [("Inspect", "nominal", "tolerance", "with", "measured"), *((*row, "") for row in rows)],
        4.0,
    )


def _title(sheet: Sheet, shoe: Shoe, build: ShoeBuild, scale: str) -> None:
    p = build.parameters
    low = (230.0, 10.0)
    sheet.box(low, (410.0, 62.0), "OUTLINE")
    rows = [
        (("Title", f"{shoe.layout.name}, {shoe.side} {build.kind}"), ("Part", f"{build.kind}_{shoe.side}.step")),
        (("Material", f"{p.material}, {p.made_by.name}"), ("Scale", scale)),
        (("Tolerances", "ISO 2768-m, ISO 8015"), ("Sheet", "1 of 1, A3")),
        (("Surface", p.made_by.finish[:46]), ("Taxels", f"{len(shoe.layout)} of {build.fit.cell_area:g} mm²")),
        (("Drawn by", "Plantar"), ("Date", release_date()[:10])),
        (("State", "not built: no print of it is known"), ("Revision", "A")),
    ]
    for i, row in enumerate(rows):
        y = 62.0 - 8.6 * (i + 1)
        sheet.line([(low[0], y), (410.0, y)])
        for x, (label, text) in zip((low[0] + 1.5, 342.0), row, strict=True):
            sheet.text((x, y + 5.4), label, 1.6)
            sheet.text((x, y + 1.3), text, 2.6)
    sheet.line([(340.5, 62.0), (340.5, 10.0)])
    for radius in (1.6, 3.2):  # third angle
        sheet.line([(401.0 + radius * np.cos(a), 48.8 + radius * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 25)])
    sheet.line([(390.0, 47.2), (396.0, 45.6), (396.0, 52.0), (390.0, 50.4), (390.0, 47.2)])
    walls = f"; wall to plate r {p.fillet:g} in 3 facets, its inner edge {p.lead_in:g} x 45°" * (build.kind == "shoe")
    sheet.text((24.0, 12.0), f"Lengths in mm. Datums: {_DATUMS}. Mark {p.mark_depth:g} deep{walls}.", 2.0)
