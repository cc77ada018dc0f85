"""Which cell that can be bought suits a foot and the weight of its robot.

A cell must carry the load case within its range: beyond it a film or sheet reads the same whatever presses, so that the
center of pressure is lost; and its lines must find ways. Of those that do, one that sees the footprint comes before a
few load cells, and of these the one whose center of pressure is off by the least.
"""

import math
from dataclasses import dataclass

from plantar.errors import FootError
from plantar.shoes.build import Shoe, build_shoe
from plantar.shoes.cells.cell import Cell, built_in_cells, read_cell
from plantar.shoes.checks.check import LOAD, check_plan
from plantar.shoes.foot.foot import Foot
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.strength import load_case
from plantar.shoes.wiring.flex_board import flex_board
from plantar.shoes.wiring.nets import wiring_of


@dataclass(frozen=True)
class CellChoice:
    """A chosen cell, and a line for each candidate with what speaks against it."""

    cell: Cell
    notes: tuple[str, ...]


def choose_cell(foot: Foot, parameters: ShoeParameters | None = None) -> CellChoice:
    """Choose the cell with which a foot's shoe holds its checks and sees the center of pressure best, by parameters.

    FootError if none does.

    Example:
        >>> from plantar.shoes.foot.foot import foot_from_dimensions
        >>> light = foot_from_dimensions("a", length=0.12, width=0.07, corner_radius=0.01, mass=4.0)
        >>> choose_cell(light).cell.name
        'velostat'
    """
    p = parameters or ShoeParameters()
    mass = load_case(foot, p).mass
    found: list[tuple[bool, float, str, Shoe]] = []
    against = []
    lighter: list[tuple[float, str]] = []  # masses in kg that cells carry which fail by the load alone
    for name in built_in_cells():
        cell = read_cell(name)
        if not cell.part:
            continue
        try:
            build = build_shoe(foot, side="left", cell=cell, parameters=p, layout_only=True)
        except FootError as error:
            against.append(f"cell {name}: {error}")
            continue
        failed = [c for c in check_plan(build.shoes[0].plan, build) if not c.holds]
        if failed:
            first = failed[0]
            if [c.name for c in failed] == [LOAD]:
                lighter.append((mass * build.shoes[0].layout.ranges["force"][1] / first.value, name))
            against.append(f"cell {name}: {first.name} is {first.value:g}, allowed {first.allowed}")
            continue
        assert build.cop is not None
        found.append((cell.count > 0.0, build.cop.together, name, build.shoes[0]))
    found.sort(key=lambda one: one[:3])
    while found:
        try:
            _find_ways(found[0][3], p)
            break
        except FootError as error:  # only now: finding all lines' ways takes longer than all that was checked before
            against.append(f"cell {found.pop(0)[2]}: {error}")
    if not found:
        most, strongest = max(lighter, default=(0.0, ""))
        allowed = f"up to {math.floor(most)} kg with cell {strongest}; " if lighter else ""
        raise FootError(
            f"no cell that can be bought suits this foot and {mass:g} kg: {'; '.join(against)}; allowed: {allowed}or "
            "--cell hex, a laboratory's cell that no shop sells"
        )
    _, off, name, _ = found[0]
    others = ", ".join(f"{other} ({far:g} mm)" for _, far, other, _ in found[1:])
    text = f"cell {name} is chosen for {mass:g} kg: its center of pressure is within {off:g} mm (95 %)"
    return CellChoice(read_cell(name), (text + (f"; others that hold: {others}" if others else ""), *against))


def _find_ways(shoe: Shoe, parameters: ShoeParameters) -> None:
    """FootError where a shoe's cells cannot be wired, or a line of its sheet finds no way."""
    wiring = wiring_of(shoe, parameters)
    if wiring is not None and wiring.circuit == "matrix":
        flex_board(shoe, parameters)
