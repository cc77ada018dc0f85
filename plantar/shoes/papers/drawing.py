"""The dimensioned drawing of a shoe: seen from above, and two sections of the exported surface."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.geometry.outline import ring
from plantar.shoes.geometry.section import section_along
from plantar.shoes.plan.pad_outline import pad_rim
from plantar.shoes.solid.pad import land_top
from plantar.shoes.units import to_mm

__all__ = ["draw_shoe"]

_THIN = 0.6
_MOST_IDS = 120


def draw_shoe(
    shoe: Shoe, build: ShoeBuild, triangles: NDArray[np.float64], paths: Sequence[str | os.PathLike[str]]
) -> list[Path]:
    """Draw one shoe with its dimensions in mm.

    Args:
        shoe: The shoe.
        build: What it belongs to.
        triangles: Its surface (n, 3, 3) in mm, as exported.
        paths: Where to write; the endings give the formats.

    Returns:
        The paths.
    """
    p = build.parameters
    body = triangles.reshape(-1, 3)
    low, high = body.min(axis=0), body.max(axis=0)
    length, width = high[0] - low[0] + 56.0, high[1] - low[1] + 40.0
    tall = high[2] + 10.0  # of a section, in mm
    heights = [width, tall, tall * length / width]
    scale = 9.3 / length
    figure, (top, along, across) = new_figure(10.5, scale * sum(heights) + 4.0, rows=3, height_ratios=heights)
    _plan(top, shoe, build, low, high)
    cut_y, cut_x = _cuts(shoe, build)
    _section(along, shoe, build, triangles, 1, cut_y, "A-A")
    _section(across, shoe, build, triangles, 0, cut_x, "B-B")
    for x, text in ((cut_x, "B"),):
        top.plot([x, x], [low[1] - 4.0, high[1] + 4.0], color=COLOURS["reference"], lw=0.8, ls="-.")
        top.text(x, high[1] + 5.0, text, ha="center", fontsize=8)
    top.plot([low[0] - 4.0, high[0] + 4.0], [cut_y, cut_y], color=COLOURS["reference"], lw=0.8, ls="-.")
    top.text(high[0] + 6.0, cut_y, "A", va="center", fontsize=8)
    figure.suptitle(
        f"{shoe.layout.name}, {shoe.side} {build.kind}   |   {p.material}, {len(shoe.layout)} taxels of "
        f"{build.fit.cell_area:g} mm², "
        f"{100 * build.fit.covered_area_ratio:.0f} % of the sole covered   |   mm",
        fontsize=10,
    )
    style: dict[str, Any] = {"x": 0.01, "ha": "left", "fontsize": 6.5, "family": "monospace"}
    figure.supxlabel("\n".join(_notes(shoe, build, 1.0)), **style)
    figure.draw_without_rendering()  # lays the axes out, which gives the scale
    ends = top.transData.transform([(0.0, 0.0), (1.0, 0.0)])
    figure.supxlabel("\n".join(_notes(shoe, build, 25.4 * (ends[1, 0] - ends[0, 0]) / figure.dpi)), **style)
    return [save_figure(figure, path) for path in paths]


def _notes(shoe: Shoe, build: ShoeBuild, scale: float) -> list[str]:
    """The title block: scale, datums, tolerances, and what is measured on the first print."""
    p, made = build.parameters, build.parameters.made_by
    flat = 2.0 * made.scatter
    title = f"Plantar   {shoe.layout.name} {build.kind} {shoe.side}   {p.material}, {made.name}"
    lines = [
        f"{title}   view from above 1:{1.0 / scale:.2f}   third angle   not built: no one has printed it yet",
        f"Datums: D the printed lower face, z = {p.bottom:g}; E, F the planes y = 0 and x = 0 through the origin",
        "General tolerances ISO 2768-m. To D E F: position of pockets, ports, lugs 0.3, profile of the inner wall 0.3. "
        f"Flatness of D {flat:g}",
        "Inspect | nominal | tolerance",
        f"pocket depth from D | {p.pocket_depth:g} | +{flat:g} 0",
        f"floor over the pockets | {p.floor:g} | +-{flat:g}",
        f"ribs | {p.rib:g} | +-{made.press:g}",
    ]
    if build.kind == "shoe":
        lines.append(f"wall thickness and height | {p.rim_thickness:g}, {p.rim_height:g} | +-0.3")
        lines.append(f"gap between foot and wall | {p.clearance:g} | +-0.3")
    if shoe.plan.heel.board:
        wide, thick = p.board_length + 2.0 * made.slide, p.board_thickness + 2.0 * made.slide
        lines.append(f"slot of the board, length x width | {wide:g} x {thick:g} | +{made.slide:g} 0")
    if build.retention is not None and build.retention.kind == "straps":
        slot = f"{build.retention.width + 2:g} x {p.strap_thickness + 2:g}"
        lines.append(f"slots of the lugs, length x height | {slot} | +-0.5")
    return lines


def _cuts(shoe: Shoe, build: ShoeBuild) -> tuple[float, float]:
    """Where to cut: y through a row of taxels near the middle, x through what holds the shoe."""
    positions = to_mm(shoe.layout.positions)
    middle = 0.5 * (shoe.plan.contact.bounds[1] + shoe.plan.contact.bounds[3])
    cut_y = float(positions[np.argmin(np.abs(positions[:, 1] - middle)), 1]) + 1.3e-3
    places = build.retention.places if build.retention is not None else ()
    cut_x = places[-1].x if places else float(positions[:, 0].mean())
    return cut_y, cut_x + 1.3e-3


def _plan(axes: Any, shoe: Shoe, build: ShoeBuild, low: Any, high: Any) -> None:
    """The sole from above: outlines, cells with their ids, cable route, size."""
    plan, colour = shoe.plan, COLOURS[shoe.side]
    for pocket in plan.pockets:
        axes.plot(*_closed(ring(pocket)).T, color=COLOURS["edge"], lw=0.3)
    for i, cell in enumerate(plan.cells):
        axes.fill(*ring(cell).T, facecolor=COLOURS["cell"], edgecolor=COLOURS["edge"], lw=_THIN)
        if len(plan.cells) > _MOST_IDS:
            continue
        x, y = to_mm(shoe.layout.positions[i, :2])
        axes.text(x, y - 4.0, str(int(shoe.layout.ids[i])), ha="center", va="center", fontsize=6)
    centres = to_mm(shoe.layout.positions[:, :2])
    for i, j in plan.route:
        axes.plot(*centres[[i, j]].T, color=COLOURS["active"], lw=0.8)
    if plan.connectors:
        starts = centres[list(plan.connectors)]
        axes.plot(*starts.T, "s", color=COLOURS["cop"], ms=4, label="connector and cable")
        axes.plot([starts[0, 0], plan.heel.x], [starts[0, 1], plan.heel.y], color=COLOURS["cop"], lw=1.2)
    flip = np.array([1.0, 1.0 if shoe.side == "left" else -1.0])
    axes.plot(*_closed(ring(plan.contact)).T, color=colour, lw=2.0, label="contact face (pad)")
    if build.kind == "shoe":
        inside = {"color": COLOURS["reference"], "lw": 0.8, "ls": "--", "label": "inside of the wall"}
        axes.plot(*_closed(ring(plan.rim)).T, color=colour, lw=0.8, label="wall")
        axes.plot(*_closed(ring(plan.cavity)).T, **inside)
    axes.plot(
        *_closed(ring(build.foot.sole) * flip).T, color=COLOURS["truth"], lw=0.9, ls=":", label="sole of the foot"
    )
    axes.plot(0.0, 0.0, "+", color=COLOURS["truth"], ms=11, label="origin, below the ankle")
    face = plan.contact.bounds
    _dimension(axes, (face[0], low[1] - 8.0), (face[2], low[1] - 8.0), f"{face[2] - face[0]:.1f}")
    _dimension(axes, (low[0], low[1] - 16.0), (high[0], low[1] - 16.0), f"{high[0] - low[0]:.1f} over all")
    _dimension(axes, (low[0] - 8.0, face[1]), (low[0] - 8.0, face[3]), f"{face[3] - face[1]:.1f}")
    _directions(axes, shoe, low, high)
    axes.set_title(f"From above; overhang of the contact face {plan.overhang:.1f} mm", fontsize=9, loc="left")
    axes.set(xlim=(low[0] - 28.0, high[0] + 28.0), ylim=(low[1] - 24.0, high[1] + 14.0), ylabel="y, left")
    axes.set_aspect("equal")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.05), ncols=6, fontsize=7, frameon=False)


def _directions(axes: Any, shoe: Shoe, low: Any, high: Any) -> None:
    """Where toes, heel and the body's middle are."""
    middle = 0.5 * (low[1] + high[1])
    sides = ("outer", "inner") if shoe.side == "left" else ("inner", "outer")
    axes.text(high[0] + 18.0, middle, "toes", rotation=-90.0, ha="center", va="center", fontsize=8)
    axes.text(low[0] - 22.0, middle, "heel", rotation=90.0, ha="center", va="center", fontsize=8)
    axes.text(low[0] - 24.0, high[1] + 7.0, f"left, {sides[0]} side", fontsize=8)
    axes.text(low[0] - 24.0, low[1] - 20.0, f"right, {sides[1]} side", fontsize=8)


def _section(
    axes: Any, shoe: Shoe, build: ShoeBuild, triangles: NDArray[np.float64], axis: int, at: float, name: str
) -> None:
    """A section with the foot's place, the taxels and the pad, and its heights."""
    import shapely

    p, colour = build.parameters, COLOURS[shoe.side]
    cut = section_along(triangles, axis, at)
    line = shapely.LineString([(at, -1e4), (at, 1e4)] if axis == 0 else [(-1e4, at), (1e4, at)])
    across = 1 - axis
    lands = shoe.plan.lands
    top = land_top(shoe.plan, p) if lands else p.bottom
    heads = [(q, p.pad_thickness, top) for q in lands or shoe.plan.cells]
    for shape, low, high in heads + [(q, top, p.ceiling) for q in shoe.plan.pockets]:
        for part in shapely.get_parts(shape.intersection(line)):
            if part.length > 0.0:
                ends = (part.bounds[across], part.bounds[across + 2])
                axes.fill_between(ends, low, high, facecolor=COLOURS["active"], alpha=0.55, lw=0)
    face = shoe.plan.contact.intersection(line).bounds
    start, end = face[across], face[across + 2]
    if p.pad_thickness > 0.0:
        axes.fill_between((start, end), 0.0, p.pad_thickness, facecolor=COLOURS["reference"], alpha=0.6, lw=0)
        rim = pad_rim(shoe.plan, p).intersection(line)
        for part in () if rim.is_empty else getattr(rim, "geoms", [rim]):
            ends = (part.bounds[across], part.bounds[across + 2])
            heights = (p.pad_thickness, p.pad_thickness + p.pad_rim_height)
            axes.fill_between(ends, *heights, facecolor=COLOURS["reference"], alpha=0.6, lw=0)
    top = min(p.rim_top + 14.0 if build.kind == "shoe" else 2.0 * p.thickness, p.thickness + build.foot.height)
    for part in shapely.get_parts(_foot_section(shoe, build, axis, at, top)):
        if part.geom_type == "Polygon":
            axes.fill(*ring(part).T, facecolor=COLOURS["truth"], alpha=0.08, lw=0)
    for part in getattr(cut, "geoms", [cut]):
        shape = shapely.geometry.polygon.orient(part)
        rings = [np.array(shape.exterior.coords), *(np.array(h.coords) for h in shape.interiors)]
        axes.fill(*rings[0].T, facecolor=colour, alpha=0.75, edgecolor=COLOURS["truth"], lw=_THIN)
        for hole in rings[1:]:
            axes.fill(*hole.T, facecolor="white", edgecolor=COLOURS["truth"], lw=_THIN)
    low, high = cut.bounds[0], cut.bounds[2]
    flat = build.kind == "insole"
    for place, upper in enumerate((p.thickness,) if flat else (p.thickness, p.rim_top)):
        x = high + 8.0 + 9.0 * place
        _dimension(axes, (x, 0.0), (x, upper), f"{upper:g}")
    _dimension(axes, (low - 8.0, p.bottom), (low - 8.0, p.ceiling), f"{p.ceiling - p.bottom:g}")
    _dimension(axes, (low - 16.0, 0.0), (low - 16.0, p.bottom), f"{p.bottom:g}")
    letter, seen = ("y", "the right") if axis == 1 else ("x", "the toes")
    axes.set_title(
        f"{name}, {letter} = {at:.1f}, seen from {seen}: pad {p.pad_thickness:g}, "
        f"taxels {p.taxel_protrusion:g} + {p.pocket_depth:g}, "
        f"floor {p.floor:g}" + ("" if flat else f", wall {p.rim_thickness:g}, clearance {p.clearance:g}"),
        fontsize=9,
        loc="left",
    )
    axes.set(
        xlim=(low - 28.0, high + 28.0),
        ylim=(-4.0, cut.bounds[3] + 6.0),
        xlabel="x, forward" if axis == 1 else "y, left",
        ylabel="z",
    )
    axes.set_aspect("equal")


def _foot_section(shoe: Shoe, build: ShoeBuild, axis: int, at: float, top: float) -> Any:
    """The foot in the shoe, cut where the shoe is; upright sides where only its outline is known."""
    import shapely

    floor, triangles = build.parameters.thickness, build.foot.triangles
    low, high = shoe.plan.foot.bounds[1 - axis], shoe.plan.foot.bounds[3 - axis]
    room = shapely.box(low - 50.0, floor, high + 50.0, top)
    if triangles is not None:
        turned = triangles if shoe.side == "left" else (triangles * np.array([1.0, -1.0, 1.0]))[:, ::-1]
        cut = section_along(turned + np.array([0.0, 0.0, floor]), axis, at)
        if not cut.is_empty:  # of an open surface there is no section
            return cut.intersection(room)
    line = shapely.LineString([(at, -1e4), (at, 1e4)] if axis == 0 else [(-1e4, at), (1e4, at)])
    ends = shoe.plan.foot.intersection(line).bounds
    return shapely.box(ends[1 - axis], floor, ends[3 - axis], top) if len(ends) == 4 else shapely.Polygon()


def _closed(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate([points, points[:1]])


def _dimension(axes: Any, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension line with arrows at both ends and its figure in the middle."""
    axes.annotate("", xy=start, xytext=end, arrowprops={"arrowstyle": "<->", "lw": 0.7, "shrinkA": 0, "shrinkB": 0})
    upright = abs(start[0] - end[0]) < 1e-9
    axes.text(
        0.5 * (start[0] + end[0]) + (1.5 if upright else 0.0),
        0.5 * (start[1] + end[1]) - (0.0 if upright else 1.5),
        text,
        ha="left" if upright else "center",
        va="center" if upright else "top",
        fontsize=8,
    )
