"""Assembly page: numbered steps with pictures of the shoe's own solids. In mm."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.pages.page import Section, figure, page, row, table
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.checks.check import ShoeCheck
from plantar.shoes.checks.printability import BOARD_UP
from plantar.shoes.papers.bill import WINDOW, Part
from plantar.shoes.papers.picture import rendered_png
from plantar.shoes.plan.wiring import channel_lines, length_of, wire_lines
from plantar.shoes.solid.pad import mould_surface, pad_surface, prism_surface, taxel_surfaces
from plantar.shoes.wiring.wired_shoe import WiredShoe

Array = NDArray[np.float64]
Bodies = list[tuple[Array, tuple[float, float, float]]]

_PRINT = (0.36, 0.55, 0.72)
_PAD = (0.30, 0.31, 0.33)
_TAXELS = ((0.45, 0.72, 0.50), (0.55, 0.82, 0.58), (0.37, 0.62, 0.43))  # in turn, so that neighbours differ
_WIRE = (0.84, 0.28, 0.22)
_BOARD = (0.16, 0.42, 0.30)
_FOOT = (0.78, 0.74, 0.68)
_MOULD = (0.80, 0.63, 0.40)
_ABOVE = {"azimuth": -62.0, "elevation": 38.0}
_BELOW = {"azimuth": -62.0, "elevation": -48.0}
_BEHIND = {"azimuth": -160.0, "elevation": 14.0}
_LOW = {"azimuth": -62.0, "elevation": 20.0}
_WIRE_WIDE = 1.6
_STYLE = """
.step { display: grid; gap: .5rem 1.5rem; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); align-items: start; }
.step figure { margin: 0; }
.step > div > :first-child { margin-top: 0; }
code { overflow-wrap: anywhere; }
@media (max-width: 40rem) { .step { grid-template-columns: minmax(0, 1fr); } }
@media print { section { break-inside: avoid; } .step figure img { max-height: 7cm; } }
"""


def assembly_page(
    build: ShoeBuild,
    checks: Mapping[str, ShoeCheck],
    bills: Mapping[str, Sequence[Part]],
    wired: Mapping[str, WiredShoe] | None = None,
) -> str:
    """Gives HTML page of a build with solids, checks, bills and wiring by side, without network."""
    shoe = build.shoes[0]
    sides = " and ".join(s.side for s in build.shoes)
    kind = build.kind if len(build.shoes) == 1 else f"{build.kind}s"
    views = _Views(shoe, build)
    steps = list(_steps(shoe, build, checks, bills, views, (wired or {}).get(shoe.side)))
    sections = [Section("parts", "Parts", "".join(_parts(side, bill) for side, bill in bills.items()))]
    sections += [Section(f"step{n}", f"{n}. {name}", content) for n, (name, content) in enumerate(steps, start=1)]
    mirrored = ""
    if len(build.shoes) > 1:
        mirrored = f" The pictures show the {shoe.side} one; the {build.shoes[1].side} one mirrors it, cell by cell."
    about = f'<p class="about">{len(steps)} steps. Lengths in mm. {_words(mirrored)}</p>'
    return page(f"Assembly: {shoe.layout.name}, {sides} {kind}", about, sections, style=_STYLE)


def _words(text: str) -> str:
    return html.escape(text.strip())


def _parts(side: str, bill: Sequence[Part]) -> str:
    rows = []
    for part in bill:
        mass = "–" if part.mass_g is None else f"{part.mass_g:.1f}"
        order = _words(part.order)
        if part.address:
            order = f'<a href="{html.escape(part.address, quote=True)}">{order}</a>'
        cells = (str(part.quantity), *map(_words, (part.material, part.size)), mass, _words(part.note), order)
        rows.append(row(_words(part.part), cells))
    head = ("Part", "Number", "Material", "Size", "Mass in g", "Note", "To order")
    return table(f"parts, {side}", f"Of the {side} one", head, rows, words=("Material", "Size", "Note", "To order"))


def _step(paragraphs: Sequence[str], view: bytes, caption: str, more: str = "") -> str:
    text = "".join(f"<p>{p}</p>" for p in paragraphs if p)
    return f'<div class="step"><div>{text}</div>{figure(view, caption)}</div>\n{more}'


def _steps(
    shoe: Shoe, build: ShoeBuild, checks: Mapping[str, ShoeCheck], bills: Mapping[str, Sequence[Part]], views: _Views,
    wired: WiredShoe | None,
) -> Iterator[tuple[str, str]]:  # fmt: skip
    yield "Try the fit with a coupon", _coupon(shoe, build, views)
    yield "Print", _print(shoe, build, checks, views)
    if build.parameters.pad_thickness > 0.0:
        yield "Make the pad", _pad(shoe, build, checks, views)
    yield "Put the taxels into their pockets", _taxels(shoe, build, views)
    if wired is not None:
        yield "Wire them", _harness(shoe, wired)
    elif shoe.plan.connectors:
        yield "Wire them", _wires(shoe, build, views)
    if shoe.plan.connectors:
        yield "Lead the cable out", _exit(shoe, build, views)
    if build.parameters.pad_thickness > 0.0:
        yield "Glue the pad on", _glue(shoe, build, views)
    yield ("Put it on the foot" if build.kind == "shoe" else "Lay it into the shoe"), _put_on(shoe, build, bills, views)
    yield "Tare and compare", _tare(shoe, build, checks, views)


def _coupon(shoe: Shoe, build: ShoeBuild, views: _Views) -> str:
    p = build.parameters
    kind = "none" if build.retention is None else build.retention.kind
    other = {
        "clips": "The clip's coupon must snap over the foot's edge and come off again.",
        "straps": f"A strap of {p.strap_thickness:g} must slide through the lug's coupon with the foot beside it.",
        "screws": "The screw must run in its nut and press on the foot's side.",
    }.get(kind, "")
    return _step(
        [
            "Repeat the command of this shoe with <code>--coupon</code> and print what it writes, with the settings of "
            "the next step.",
            f"A taxel's base of {p.pocket_depth:g} depth must go into the pocket by hand, and its head must meet the "
            "groove in the ribs all round.",
            _words(other),
            "What is too tight or loose is a matter of <code>--set clearance=</code>, <code>rib=</code> or "
            "<code>pocket_depth=</code>; then make the shoe again.",
        ],
        views.of_cells(lifted=1),
        f"From below: one taxel (id {int(shoe.layout.ids[views.first])}) before its pocket",
    )


def _print(shoe: Shoe, build: ShoeBuild, checks: Mapping[str, ShoeCheck], views: _Views) -> str:
    p = build.parameters
    made = build.parameters.made_by
    rows = []
    for side, check in checks.items():
        best = check.printing[0]
        size = " x ".join(f"{v:.0f}" for v in best.size)
        figures = (best.direction, size, f"{check.volume_cm3:.0f}", f"{check.mass_g:.0f}", f"{check.print_hours:g}")
        rows.append(row(f"{build.kind}_{side}.stl", figures))
    head = ("File", "Direction", "Size on the bed", "Volume in cm³", "Mass in g", "Hours, about")
    best = checks[shoe.side].printing[0]
    supports = "A powder bed needs no supports."
    if made.supports:
        supports = (
            "No supports are needed." if best.overhang <= 0.0 else
            f"{best.overhang:.0f} mm² lean over by more than 45 degrees: support them from the bed alone."
        )  # fmt: skip
        supports += f" Ceilings of the pockets are bridges of up to {p.bridge_max:g}, which may sag by {made.sag:g}."
    gaps = f"press {made.press:g}, slide {made.slide:g}, play {made.play:g}"
    return _step(
        [
            f"Material: {_words(p.material)}, {made.name}. Direction: {_words(best.direction)}. {_words(supports)} "
            f"Then: {_words(made.finish)}.",
            f"Gaps a side: {gaps}; seats within {made.scatter:g} (1 sigma); it may shrink by {made.shrinkage:g} % and "
            f"spread by {made.foot:g} on the bed. A coupon of your printer replaces these (--set gap_slide=...).",
            f"Walls are {min(c.min_wall_mm for c in checks.values()):g} or thicker. The files are in mm; the 3MF "
            "states it, the STEP is for changes in CAD.",
        ],
        views.of_print(),
        f"The {shoe.side} print from above, toes to the right",
        table("prints", "What is printed", head, rows, words=("Direction",)),
    )


def _pad(shoe: Shoe, build: ShoeBuild, checks: Mapping[str, ShoeCheck], views: _Views) -> str:
    p = build.parameters
    weight = checks[shoe.side].weights.pad
    if p.pad_foam > 0.0:
        return _step(
            [
                f"Cut a {_words(p.pad_material)}, {p.pad_thickness:g} thick, to the outline of "
                f"<code>pad_{shoe.side}.stl</code>, and strips of it, {p.pad_rim_height:g} thick, for the rim. A "
                f"two-part foam of that firmness may be cast in <code>mould_{shoe.side}.stl</code> instead.",
                f"Cut holes of {WINDOW:g} at the taxels' centres where infrared sensors look out (layer WINDOWS of "
                f"<code>cells_{shoe.side}.dxf</code>).",
                "Rubber would be too hard: where the seats scatter, few taxels would touch the ground.",
            ],
            views.of_mould(),
            "The pad above its mould",
        )
    return _step(
        [
            f"Either print <code>mould_{shoe.side}.stl</code> in any material, wax it, and pour in "
            f"{weight / p.pad_density:.0f} cm³ ({weight:.0f} g) of silicone of about {p.pad_hardness:g} Shore A up to "
            "its edge; the face that lies open is the sole. It comes out upwards, as nothing hangs over.",
            f"Or print <code>pad_{shoe.side}.stl</code> in TPU of the same hardness, as it lies.",
            f"The sheet is {p.pad_thickness:g} thick, {p.pad_thickness + p.pad_rim_height:g} at its rim.",
        ],
        views.of_mould(),
        "The pad above its mould",
    )


def _taxels(shoe: Shoe, build: ShoeBuild, views: _Views) -> str:
    plan = shoe.plan
    p = build.parameters
    made = build.parameters.made_by
    count = len(shoe.layout)
    patches = len(plan.connectors)
    cut = int((build.fit.shares < 1.0 - 1e-6).sum())
    kinds = f", {cut} of them smaller than a whole one (cells_{shoe.side}.dxf has each outline)" if cut else ""
    groups = f" in {patches} patches" if patches > 1 else ""
    begin = (
        f" Begin at id {int(shoe.layout.ids[plan.connectors[0]])}, the nearest to the heel." if plan.connectors else ""
    )
    if plan.lands:  # films or a sheet, which the pad presses on
        what = "One sheet" if plan.lines is not None else f"{count} films{groups}"
        text = [
            f"{what} for each foot, to be glued to the ceilings of the pockets, {p.pocket_depth:g} deep, the active "
            f"face down; the pad's lands press there. The ids are on <code>drawing_{shoe.side}.png</code>.{begin}"
        ]
        return _step(text, views.of_cells(), f"From below: {what.lower()} before the pockets")
    return _step(
        [
            f"{count} taxels{groups} for each foot{kinds}. A head stands out by {p.taxel_protrusion:g}, a base goes "
            f"{p.pocket_depth:g} deep and is {made.sag + 2.0 * made.scatter:.2g} lower: heads rest on the ribs, and no "
            "base on a ceiling, which sags.",
            f"Glue the bases in by their rims with the heads along the grooves.{begin}"
            + (
                " Follow the order of the next step, so that each wire is laid before its pocket is shut."
                if begin
                else ""
            ),
            f"The ids are on <code>drawing_{shoe.side}.png</code>.",
        ],
        views.of_cells(),
        f"From below: {count} taxels before their pockets",
    )


def _harness(shoe: Shoe, wired: WiredShoe) -> str:
    """Leads as they are soldered, or the lines of a sheet's tail, with the drawing of the same nets."""
    wiring = wired.wiring
    shown = figure(wired.drawing, f"Wiring of the {shoe.side} one, seen from the ground")
    text = {
        "divider": "Each FSR has two leads, soldered to the tabs of its tail, never to the film: to 3V3, and to its "
        "channel of a multiplexer, from which a resistor of 1 kOhm leads to ground.",
        "bridge": "Each load cell's four leads go to its amplifier; DOUT of each has a pin of U1, all share PD_SCK.",
        "matrix": f"Order the board by <code>gerbers_{shoe.side}.zip</code>. Lay the sheet on its combs, front to the "
        "ground, glue them at the rim alone, and put the tail, contacts to the contacts, into J1 at pin 1.",
    }[wiring.circuit]
    rows = [
        row(f"T{lead.cell}", (lead.net, str(lead.start), str(lead.end), lead.colour, str(lead.length)))
        for lead in wiring.leads
    ]
    rows += [row(f"J1.{n}", (net or "spare", "FB1", f"J1.{n}", "", "")) for n, net in enumerate(wiring.tail, start=1)]
    head = ("Cell or line", "Net", "from", "to", "Colour", "Length")
    leads = table("harness", "What is joined to what", head, rows, words=("Net", "from", "to", "Colour"))
    about = (
        f"<p>{text} <code>nets.csv</code> has every pin of every net, <code>harness.csv</code> this table of both "
        f"sides, and <code>firmware_{shoe.side}</code> the program of U1.</p>"
    )
    return about + shown + leads


def _wires(shoe: Shoe, build: ShoeBuild, views: _Views) -> str:
    plan = shoe.plan
    ids = shoe.layout.ids.tolist()
    lengths = {j: length_of(line) for j, line in wire_lines(plan).items()}
    chain: dict[int, list[int]] = {}
    for i, j in plan.route:
        chain.setdefault(i, []).append(j)
    rows = []
    for i, nexts in chain.items():
        rows.append(row(f"from {ids[i]}", (", ".join(f"{ids[j]} ({lengths[j]:.0f})" for j in nexts),)))
    total = sum(lengths.values())
    patches = len(plan.connectors)
    span = f"{min(lengths.values()):.0f} to {max(lengths.values()):.0f}" if lengths else "none"
    starts = ", ".join(str(ids[c]) for c in plan.connectors)
    return _step(
        [
            f"{len(lengths)} wires for each foot join each taxel to the next through the ports in the ribs: {span} "
            f"long from centre to centre, {total:.0f} in all; add what your connectors take.",
            f"{'One patch starts' if patches == 1 else f'{patches} patches start'} at id {starts}; a tree of fewest "
            "hops leads from there to every taxel. <code>wiring.csv</code> has it with places and ports.",
        ],
        views.of_wires(),
        "From below: the wires in their pockets, through the ports, and the cable in its channel",
        table("wires", "To which taxels a wire leads, in order, with its length", ("Taxel", "to"), rows, words=("to",))
        if rows else "",
    )  # fmt: skip


def _exit(shoe: Shoe, build: ShoeBuild, views: _Views) -> str:
    plan = shoe.plan
    p = build.parameters
    ids = shoe.layout.ids.tolist()
    lines = channel_lines(plan, p)
    first = length_of(lines[0])
    others = [
        f"The cable of id {ids[c]} runs {length_of(line):.0f} to the patch before it."
        for c, line in zip(plan.connectors[1:], lines[1:], strict=True)
    ]
    start = f"Lay the cable of id {ids[plan.connectors[0]]} into the channel at the heel: {first:.0f} long"
    if plan.heel.board:
        up = p.thickness - p.ceiling + BOARD_UP
        size = f"{p.board_length:g} x {BOARD_UP:g} x {p.board_thickness:g} and higher"
        text = [
            f"{start}, then {up:.0f} up through the hole behind the wall to the board.",
            f"Slide the connection board ({size}) from above into the rails behind the heel, its connector outwards; "
            f"leave {p.board_gap:g} of room for parts between wall and board.",
        ]
        caption = "From behind: the connection board above its rails"
    else:
        where = "behind the heel" if build.kind == "shoe" else "at the heel"
        text = [f"{start} up to the plate's edge. It leaves {where}; there is no holder for a board."]
        caption = "From behind and below: where the cable leaves"
    return _step([*text, *others], views.of_exit(), caption)


def _glue(shoe: Shoe, build: ShoeBuild, views: _Views) -> str:
    p = build.parameters
    free = (
        f" Its rim stays free: it ends {p.pad_relief:g} below the print, so that the load goes through the taxels."
        if p.pad_rim_height > 0.0 else ""
    )  # fmt: skip
    return _step(
        [
            f"Read every taxel once before. Then glue the pad to the {len(shoe.layout)} heads alone.{free}",
            "It wears; the next one has the same file.",
        ],
        views.of_pad(),
        "From below: the pad before the taxels",
    )


def _put_on(shoe: Shoe, build: ShoeBuild, bills: Mapping[str, Sequence[Part]], views: _Views) -> str:
    retention = build.retention
    p = build.parameters
    if build.kind == "insole":
        text = [
            f"Lay it into the wearer's shoe, pad down, toes to the front; it is {p.thickness:g} thick: take out the "
            "shoe's own sole where there is one.",
            "Lead the cable up behind the heel.",
        ]
        return _step(text, views.of_foot(), "The foot above the insole")
    kind = "none" if retention is None else retention.kind
    size = {part.part: part.size for part in bills[shoe.side]}
    count = {part.part: part.quantity for part in bills[shoe.side]}
    places = () if retention is None else retention.places
    if kind == "clips":
        heights = ", ".join(f"{q.edge:.0f}" for q in places)
        how = (
            f"{len(places)} clips snap over the foot's upper edge, {heights} above the floor; press one side at a time."
        )
    elif kind == "straps":
        how = (
            f"Draw {count['strap']} strap(s) ({size['strap']}) through the lugs and over the instep; cut the rest off."
        )
    elif kind == "screws":
        how = (
            f"Put {count['nut']} nuts {size['nut']} into their slots and turn {count['set screw']} set screws "
            f"{size['set screw']} in by hand until they press on the foot."
        )
    else:
        how = "Nothing holds it but the fit, as asked for."
    letter = "" if p.mark_height <= 0.0 else f" The mark in the floor reads {shoe.side[0].upper()}."
    return _step(
        [
            f"Push the shoe onto the foot from below until the foot stands on the floor.{letter}",
            _words(how),
            "It comes off the same way; nothing on the robot is changed.",
        ],
        views.of_foot(),
        "The foot above the shoe",
    )


def _tare(shoe: Shoe, build: ShoeBuild, checks: Mapping[str, ShoeCheck], views: _Views) -> str:
    load = checks[shoe.side].load
    who = "robot" if build.kind == "shoe" else "person"
    return _step(
        [
            "With the foot in the air take the taxels' offsets (tare); the layout itself needs no calibration: cells "
            f"lie as in <code>layout_{shoe.side}.json</code>.",
            f"Stand on a flat floor and compare the sum over both feet with the {who}'s weight: {load.mass:g} kg "
            f"({_words(load.source)}) are {load.mass * GRAVITY:.0f} N.",
            f"Record it and read it with <code>plantar analyze standing.npz --layout layout_{shoe.side}.json</code>: "
            "it states forces, the centre of pressure, and taxels that are silent or stuck.",
        ],
        views.of_all(),
        "All of it together",
    )


class _Views:
    def __init__(self, shoe: Shoe, build: ShoeBuild) -> None:
        assert shoe.surface is not None
        self.shoe = shoe
        self.build = build
        self.surface = shoe.surface
        p = build.parameters
        taxels = taxel_surfaces(shoe.plan, p)
        self.taxels: Bodies = [(t, _TAXELS[i % len(_TAXELS)]) for i, t in enumerate(taxels)]
        self.pad = pad_surface(shoe.plan, p) if p.pad_thickness > 0.0 else None
        self.first = shoe.plan.connectors[0] if shoe.plan.connectors and shoe.plan.lines is None else 0
        self.apart = np.array([0.0, 0.0, 0.15 * float(np.ptp(shoe.surface[..., 1])) + p.bottom])

    def _shown(self, bodies: Bodies, view: Mapping[str, float]) -> bytes:
        return rendered_png(bodies, azimuth=view["azimuth"], elevation=view["elevation"])

    def of_print(self) -> bytes:
        return self._shown([(self.surface, _PRINT)], _ABOVE)

    def of_cells(self, lifted: int | None = None) -> bytes:
        shown = self.taxels if lifted is None else [self.taxels[self.first]]
        return self._shown([(self.surface, _PRINT), *((t - 1.5 * self.apart, c) for t, c in shown)], _BELOW)

    def of_mould(self) -> bytes:
        assert self.pad is not None
        mould = mould_surface(self.shoe.plan, self.build.parameters)
        turned = (self.pad * np.array([1.0, -1.0, -1.0])) + np.array([0.0, 0.0, float(mould[..., 2].max())])
        return self._shown([(mould, _MOULD), (turned + 2.0 * self.apart, _PAD)], _ABOVE)

    def _cables(self) -> Bodies:
        plan = self.shoe.plan
        p = self.build.parameters
        lines = [*wire_lines(plan).values(), *channel_lines(plan, p)]
        low = p.ceiling - min(_WIRE_WIDE, 0.6 * p.pocket_depth) - 0.1
        high = p.ceiling - 0.1
        shapes = [shapely.LineString(line).buffer(0.5 * _WIRE_WIDE, join_style="mitre") for line in lines]
        return [(prism_surface(s, low, high), _WIRE) for s in shapes if s.geom_type == "Polygon" and not s.interiors]

    def of_wires(self) -> bytes:
        return self._shown([(self.surface, _PRINT), *self._cables()], {**_BELOW, "elevation": -70.0})

    def of_exit(self) -> bytes:
        heel = self.shoe.plan.heel
        p = self.build.parameters
        if not heel.board:
            return self._shown([(self.surface, _PRINT), *self._cables()], {"azimuth": 160.0, "elevation": -35.0})
        half = 0.5 * p.board_length
        place = heel.placed(shapely.box(-p.board_gap - p.board_thickness, -half, -p.board_gap, half))
        board = prism_surface(place, p.thickness, p.thickness + BOARD_UP) + self.apart
        return self._shown([(self.surface, _PRINT), (board, _BOARD)], _BEHIND)

    def of_pad(self) -> bytes:
        assert self.pad is not None
        bodies = [(self.surface, _PRINT), *self.taxels]
        return self._shown([*bodies, (self.pad - 3.0 * self.apart, _PAD)], {**_BELOW, "elevation": -20.0})

    def _whole(self) -> Bodies:
        pad: Bodies = [] if self.pad is None else [(self.pad, _PAD)]
        return [(self.surface, _PRINT), *self.taxels, *pad]

    def of_foot(self) -> bytes:
        return self._shown([*self._whole(), (self._foot() + 2.0 * self.apart, _FOOT)], _LOW)

    def of_all(self) -> bytes:
        return self._shown([*self._whole(), (self._foot(), _FOOT)], _LOW)

    def _foot(self) -> Array:
        foot = self.build.foot
        low_x, _, high_x, _ = self.build.foot.sole.bounds
        surface = foot.triangles
        if surface is None:
            surface = prism_surface(foot.sole, 0.0, 0.3 * (high_x - low_x))
        if self.shoe.side == "right":
            surface = surface[:, ::-1] * np.array([1.0, -1.0, 1.0])
        return np.asarray(surface + np.array([0.0, 0.0, self.build.parameters.thickness]))
