"""From the outline of a person's foot to a pair of insoles: fit, plan and solid in one call."""

from __future__ import annotations

from plantar.shoes.build import Progress, Rim, ShoeBuild, Sides, built_sides, planned_sides, sides_of
from plantar.shoes.cells.cell import Cell
from plantar.shoes.foot.foot import Foot
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.cell_room import cell_parameters, led_parameters
from plantar.shoes.plan.insole_plan import fit_insole, insole_foot, insole_parameters, plan_insole
from plantar.shoes.plan.load_share import check_load_share, relieved
from plantar.shoes.plan.strength import load_case
from plantar.shoes.solid.body import insole_steps
from plantar.shoes.solid.retention import Retention

__all__ = ["build_insole"]

_NOTE = "an insole of {:g} mm lies in the wearer's shoe, below the foot; nothing holds it"


def build_insole(
    foot: Foot,
    thickness: float,
    *,
    side: Sides = "both",
    cell_area: float = 691.0,
    rim: Rim = "fine",
    cell: Cell | None = None,
    parameters: ShoeParameters | None = None,
    name: str | None = None,
    layout_only: bool = False,
    progress: Progress | None = None,
) -> ShoeBuild:
    """Fit taxels to the outline of a foot and build a flat insole around them.

    Args:
        foot: The left foot: of a scan, of a last, or of an outline.
        thickness: From the ground's face of the pad to the face below the foot, in mm.
        side: "left", "right" or "both"; the right insole mirrors the left.
        cell_area: Area of a taxel in mm^2.
        rim: "fine" follows the edge with smaller cells, "whole" takes whole ones alone.
        cell: Other cells than hexagons of skin, in place of `rim` and `cell_area`.
        parameters: Dimensions; None takes the defaults.
        name: Name of the layout; None takes the foot's.
        layout_only: Leave the solid out, and with it OpenCascade.
        progress: Receives fraction and text.

    Returns:
        The insoles with their layouts and solids.

    Raises:
        InputError: If an argument is out of its range.
        FootError: If the foot cannot carry the taxels.

    Example:
        >>> from plantar.shoes.foot.foot import foot_from_dimensions
        >>> foot = foot_from_dimensions("a", length=0.26, width=0.095, corner_radius=0.03)
        >>> build = build_insole(foot, 6.0, layout_only=True)
        >>> build.kind, build.parameters.thickness, round(build.fit.covered_area_ratio, 2)
        ('insole', 6.0, 0.95)
    """
    sides = sides_of(side, rim)
    foot = insole_foot(foot)
    tell = progress or (lambda fraction, text: None)
    p, of_cell = cell_parameters(cell, parameters or ShoeParameters())
    p, notes = insole_parameters(foot, thickness, p)
    tell(0.0, "fitting the taxels to the sole")
    fit = fit_insole(foot, p, cell_area=cell_area, fine=rim == "fine", cell=cell)
    left = plan_insole(foot, fit, p, name=name)
    load = load_case(foot, p)
    p, led = led_parameters(left, p, deepen=False)
    p, lowered = relieved(left, load, p)
    share = check_load_share(left, load, p)
    told = (*foot.notes, *of_cell, *notes, *fit.notes, *led, *lowered, *left.notes, _NOTE.format(thickness))
    if layout_only:
        return ShoeBuild(foot, fit, p, planned_sides(left, sides), share, notes=told, kind="insole")
    shoes = built_sides(left, insole_steps(left, p), p, sides, tell)
    return ShoeBuild(foot, fit, p, shoes, share, Retention("none", (), 0.0, 0.0, ""), told, kind="insole")
