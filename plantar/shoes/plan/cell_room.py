"""Cell room in the shoe: pocket depth, width for leads or tail. In mm."""

import math
from dataclasses import dataclass, replace

import numpy as np

from plantar.errors import FootError
from plantar.shoes.cells.cell import Cell
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.heel import HOLE_OFF
from plantar.shoes.plan.shoe_plan import ShoePlan

CHANNELS = 16  # of a multiplexer
MULTIPLEXERS = 3  # that the read-out has, an analog input each
ROWS_MOST = 16  # of a sheet, which one multiplexer reads
COLUMNS_MOST = 32  # which the other two do
BRIDGES_MOST = 12  # amplifiers of load cells
TAIL_MOST = 50  # lines of the adapter for a sheet's tail

_TAIL_PLAY = 0.5  # mm on either side of a sheet's tail
_DEEPEST = 8.0  # mm: of a pocket that is deepened for leads


@dataclass(frozen=True)
class LeadRoom:
    """Narrow place of leads: area in mm^2 needed, each a square of its diameter, and present."""

    name: str
    needed: float
    room: float

    @property
    def holds(self) -> bool:
        return self.needed <= self.room * (1.0 + 1e-9)


def cell_parameters(cell: Cell | None, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters whose pockets hold a cell's body, grooves only for tiles, and notes on changes."""
    p = parameters
    if cell is None:
        return p, ()
    if cell.kind != "tile":
        p = replace(p, scribe=0.0)
    default = ShoeParameters().pocket_depth
    notes = []
    least, _, _, _ = ShoeParameters.range_of("pocket_depth")
    flush = cell.kind == "sheet" and p.pocket_depth == default  # a sheet ends level with the print around it
    body = max(cell.thickness, cell.connector_height)
    depth = max(least, body) if flush else max(p.pocket_depth, body)
    if depth != p.pocket_depth:
        what = "body" if body == cell.thickness else "connector"
        notes.append(
            f"pocket_depth is {depth:g} instead of {p.pocket_depth:g} mm: the cell's {what} is {body:g} mm thick"
        )
        p = replace(p, pocket_depth=depth)
    if p.board_length > 0.0 and bend_at_heel(cell, p) < cell.bend_radius:
        beside = math.sqrt(2.0 * max(p.pocket_depth - _cable(cell), 0.0))
        # what `bend_at_heel` gives, solved for the hole
        free = 0.25 * (math.sqrt(4.0 * cell.bend_radius - beside**2) - beside) ** 2
        gap = math.ceil(10.0 * (free + _cable(cell) + HOLE_OFF)) / 10.0
        notes.append(f"board_gap raised from {p.board_gap:g} to {gap:g} mm: the cable bends there")
        p = replace(p, board_gap=gap)
    return p, tuple(notes)


def _cable(cell: Cell) -> float:
    return cell.thickness if cell.kind == "sheet" else cell.lead_diameter


def bend_at_heel(cell: Cell, parameters: ShoeParameters) -> float:
    """Gives largest inner radius in mm by which a cell's cable turns from the channel up into the hole, by parameters.

    An arc of outer radius r touches the floors of two ways, a and b high, that meet at a right angle, and clears the
    corner between them where (r - a)^2 + (r - b)^2 = (r - t)^2, t being the cable's thickness.
    """
    a, b = (max(v - _cable(cell), 0.0) for v in (parameters.pocket_depth, parameters.board_gap - HOLE_OFF))
    return a + b + math.sqrt(2.0 * a * b)


def tail_lines(plan: ShoePlan) -> int:
    """Sheet tail lines: one a row and column, and one more."""
    return sum(plan.sheet_lines) + 1


def led_parameters(
    plan: ShoePlan, parameters: ShoeParameters, *, deepen: bool = True
) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters whose channel, ports and pockets (with deepen) pass a sheet's tail or the cells' leads of a
    plan, and notes.
    """
    p = parameters
    cell = plan.cell
    if cell is None or not plan.connectors:
        return p, ()
    _, widest, _, _ = ShoeParameters.range_of("channel_width")
    notes = []
    if cell.kind == "sheet":
        width = tail_lines(plan) * cell.tail_pitch + 2.0 * _TAIL_PLAY
        if width > widest:
            name = cell.label
            most = widest - 2.0 * _TAIL_PLAY
            raise FootError(
                f"cell {name}: a tail of {tail_lines(plan)} lines is {width - 2.0 * _TAIL_PLAY:g} mm wide; allowed: "
                f"{most:g} mm, by a smaller tail_pitch or a larger pitch"
            )
    elif cell.leads:
        if deepen:
            rooms = [r for r in lead_rooms(plan, p) if "channel" not in r.name]
            short = max((r.needed / r.room if r.room > 0.0 else math.inf for r in rooms), default=0.0)
            wanted = p.pocket_depth * max(1.0, short) + cell.thickness
            depth = math.ceil(10.0 * min(_DEEPEST, wanted)) / 10.0
            if short > 1.0:
                notes.append(
                    f"pocket_depth raised from {p.pocket_depth:g} to {depth:g} mm: the cells' leads pass there"
                )
                p = replace(p, pocket_depth=depth)
        width = min(widest, max(r.needed for r in lead_rooms(plan, p) if "channel" in r.name) / p.pocket_depth)
    else:
        return p, ()
    width = math.ceil(10.0 * width - 1e-6) / 10.0
    if width > p.channel_width:
        notes.append(f"channel_width raised from {p.channel_width:g} to {width:g} mm by what leads to the heel")
        p = replace(p, channel_width=width)
    return p, tuple(notes)


def lead_rooms(plan: ShoePlan, parameters: ShoeParameters) -> tuple[LeadRoom, ...]:
    """Gives fullest port, pocket and channel of a plan and parameters where cells have leads."""
    p = parameters
    cell = plan.cell
    if cell is None or not cell.leads or not plan.connectors:
        return ()
    each = cell.leads * cell.lead_diameter**2
    behind = np.ones(len(plan.cells))
    for i, j in reversed(plan.route):  # a tree, from the connectors outwards
        behind[i] += behind[j]
    patches = behind[list(plan.connectors)]
    rooms = [LeadRoom("channel", each * float(patches.sum()), p.channel_width * p.pocket_depth)]
    if plan.route:
        _, full = max(((behind[j], (i, j)) for i, j in plan.route), key=lambda f: f[0])
        width = min(p.port_width, plan.port(*full)[2])
        rooms.append(LeadRoom("fullest port", each * float(behind[full[1]]), width * p.pocket_depth))
    if cell.kind == "film":  # around the land
        beside = (min(cell.body) + 2.0 * cell.play - min(cell.active_extent)) * (p.pocket_depth - cell.thickness)
        rooms.append(LeadRoom("fullest pocket", each * float(patches.max()), beside))
    return tuple(rooms)


def refuse_too_many(plan: ShoePlan) -> None:
    """FootError where one microcontroller board does not read all cells of a plan."""
    cell = plan.cell
    if cell is None:
        return
    if cell.circuit == "matrix":
        rows, columns = plan.sheet_lines
        if rows > ROWS_MOST or columns > COLUMNS_MOST or rows + columns + 1 > TAIL_MOST:
            raise FootError(
                f"cell {cell.label}: {rows} rows and {columns} columns; one board reads {ROWS_MOST} rows and "
                f"{COLUMNS_MOST} columns, {TAIL_MOST - 1} together: use a larger pitch"
            )
    most = {"divider": CHANNELS * MULTIPLEXERS, "bridge": BRIDGES_MOST}.get(cell.circuit)
    if most is not None and len(plan.cells) > most:
        raise FootError(
            f"cell {cell.label}: {len(plan.cells)} of them; one board reads {most}: use larger cells or a sheet"
        )
