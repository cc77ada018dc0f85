"""A foot's pair of shoes or insoles: fit, plan and solid in one call."""

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.optional_library import missing_libraries, optional_library
from plantar.common.sides import SIDES
from plantar.errors import FootError, InputError
from plantar.layouts.layout import Side, SoleLayout
from plantar.shoes.cells.cell import Cell
from plantar.shoes.fit.cell_fit import fit_cells
from plantar.shoes.fit.fine_rim import BLIND_MOST, fit_fine_rim
from plantar.shoes.fit.taxels import TaxelFit, fit_taxels
from plantar.shoes.foot.foot import Foot
from plantar.shoes.foot.source import read_foot
from plantar.shoes.geometry.outline import CORNER
from plantar.shoes.order import FootSource
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import Block, Step, mirrored_step
from plantar.shoes.plan.cell_room import cell_parameters, led_parameters, refuse_too_many
from plantar.shoes.plan.cop_budget import CopBudget, check_cop_budget
from plantar.shoes.plan.ground_plate import plated
from plantar.shoes.plan.insole_plan import fit_insole, insole_foot, insole_parameters, plan_insole
from plantar.shoes.plan.load_share import LoadShare, check_load_share, relieved
from plantar.shoes.plan.low_wall import lowered_wall
from plantar.shoes.plan.shoe_plan import ShoePlan, mirrored_plan, plan_shoe
from plantar.shoes.plan.strength import load_case, strengthened
from plantar.shoes.plan.touching import Touching, check_touching, observability, softened
from plantar.shoes.solid.body import bare_floor, insole_steps, mark_outline, shoe_steps
from plantar.shoes.solid.kernel import build_solid, load_kernel
from plantar.shoes.solid.polyhedron import Polyhedron
from plantar.shoes.solid.retention import Retention, choose_retention
from plantar.shoes.solid.step_model import StepPart
from plantar.shoes.units import to_m

Sides = Literal["left", "right", "both"]  # which shoes to build

Rim = Literal["whole", "fine"]  # cells along the edge of the face: whole ones of the lattice, or a row of smaller ones

RIMS: tuple[Rim, ...] = ("whole", "fine")  # all kinds of rim

_FARTHER = 2.0  # mm that cells, which have one size, reach farther beyond the sole where they see too little
_ACTIVE = 0.146  # of the mean load of a taxel: 0.15 kg of the papers' 86 kg over two soles of 42

Progress = Callable[[float, str], None]  # receives the fraction done, 0..1, and what is being done


@dataclass(frozen=True)
class Shoe:
    """One shoe: plan, solid and triangles (n, 3, 3) in mm, sole frame; both None for layouts alone."""

    plan: ShoePlan
    solid: Polyhedron | None = None
    surface: NDArray[np.float64] | None = None

    @property
    def side(self) -> Side:
        return self.plan.side

    @property
    def layout(self) -> SoleLayout:
        return self.plan.layout

    @property
    def workplane(self) -> Any:
        """The printed solid as a `cadquery.Workplane`, in mm in the sole frame, to be changed and exported there.

        InputError for layouts alone.
        """
        if self.solid is None:
            raise InputError(f"the {self.side} shoe has no solid; build it without layout_only")
        with optional_library("cadquery", "shoes"):
            import cadquery
        shape = cadquery.Shape.cast(StepPart(self.layout.name, self.solid, {}).shape)
        return cadquery.Workplane("XY").newObject([shape])


@dataclass(frozen=True, repr=False)
class ShoeBuild:
    """Shoes of one foot.

    Attributes:
        fit: Left sole's cells.
        parameters: As used: the load case may raise some.
        shoes: Left first.
        retention: None for layouts.
        notes: Detected, assumed and decided.
        kind: "shoe", or "insole": flat without walls.
        touching: None of an insole.
        cop: Error of the center of pressure, by cause; None of an insole.
    """

    foot: Foot
    fit: TaxelFit
    parameters: ShoeParameters
    shoes: tuple[Shoe, ...]
    load_share: LoadShare
    retention: Retention | None = None
    notes: tuple[str, ...] = ()
    kind: Literal["shoe", "insole"] = "shoe"
    touching: Touching | None = None
    cop: CopBudget | None = None

    def __repr__(self) -> str:
        sides = " and ".join(shoe.side for shoe in self.shoes)
        return f"ShoeBuild({self.foot.name!r}: {self.kind}, {sides}, {len(self.fit.cells)} taxels a sole)"


def _blind_note(plan: ShoePlan, fit: TaxelFit) -> tuple[str, ...]:
    if fit.cell is not None or fit.blind_most is not None or plan.blind_rim <= BLIND_MOST:
        return ()
    return (
        f"blind rim of {plan.blind_rim:.0f} mm beyond the outermost taxels' centres; a fine rim (--rim fine), "
        f"where one fits, has smaller cells along the edge and leaves {BLIND_MOST:g} mm at most",
    )


@missing_libraries("shoes")
def build_shoe(
    foot: Foot | str | os.PathLike[str],
    *,
    side: Sides = "both",
    cell_area: float = 691.0,
    taxels: int | None = None,
    overhang: float = 0.0,
    rim: Rim = "whole",
    cell: Cell | None = None,
    parameters: ShoeParameters | None = None,
    name: str | None = None,
    layout_only: bool = False,
    progress: Progress | None = None,
) -> ShoeBuild:
    """Fit taxels to a foot's sole and build the shoe around both.

    Args:
        foot: Left foot, or a file of one as `plantar shoe` takes it: mesh or drawing.
        side: "left", "right" or "both"; right mirrors left.
        cell_area: Taxel in mm^2.
        taxels: Their number; None takes as many whole cells as fit.
        overhang: Allowed reach beyond the sole in mm; more with `taxels`, or where cells would not see the CoP.
        rim: "whole" cells, or "fine": smaller ones along the edge.
        cell: Other cells than skin hexagons, see `read_cell`, in place of `rim` and `cell_area`.
        parameters: Dimensions.
        name: Layout's; None takes the foot's.
        layout_only: Leave out solid and OpenCascade.
        progress: Receives fraction and text.

    Returns:
        Shoes with layouts and solids.

    Raises:
        InputError: If an argument is out of range.
        FootError: If taxels do not fit.

    Example:
        >>> from plantar.shoes.foot.foot import foot_from_dimensions
        >>> foot = foot_from_dimensions("a", length=0.2, width=0.1, sole_center=(0.02, 0.0), corner_radius=0.01)
        >>> build = build_shoe(foot, layout_only=True)
        >>> [(shoe.side, len(shoe.layout)) for shoe in build.shoes]
        [('left', 21), ('right', 21)]
    """
    foot = _read(foot, parameters)
    sides = _sides_of(side, rim)
    if parameters is not None and parameters.material == "TPU":
        raise InputError("a shoe of TPU would bend under the robot; allowed: PA12, PETG, PLA (TPU is for insoles)")
    if rim == "fine" and taxels is not None:
        raise InputError("a fine rim takes as many taxels as it needs; leave their number out, or take rim whole")
    report = progress or (lambda fraction, text: None)
    p, of_cell = cell_parameters(cell, parameters or ShoeParameters())
    if not 0.0 <= overhang <= p.overhang_max:
        raise InputError(
            f"overhang of the taxels is {overhang:g} mm; allowed: 0 to {p.overhang_max:g} mm (overhang_max)"
        )
    report(0.0, "fitting the taxels to the sole")
    p, low = lowered_wall(foot, p)
    fit, left, chosen = _fitted(foot, p, name, cell_area, taxels, overhang, rim, cell)
    p = replace(p, border=fit.border)
    p, raised = strengthened(foot, left.contact, p)
    if raised:
        left = plan_shoe(foot, fit, p, name=name)
    p, led = led_parameters(left, p)
    load = load_case(foot, p)
    left, gentle = _sensitive(left, load.mass)
    p, plate = plated(left, load, p)
    p, soft = softened(left, load, p)
    p, lowered = relieved(left, load, p)
    refuse_too_many(left)
    changed = (*of_cell, *low, *chosen, *fit.notes, *gentle, *raised, *led, *plate, *soft, *lowered, *left.notes)
    notes = (*foot.notes, *changed, *_blind_note(left, fit))
    if load.source.startswith("estimated"):
        notes = (*notes, f"the robot's mass is taken as {load.mass:g} kg, {load.source}")
    share = check_load_share(left, load, p)
    touching = check_touching(left, load, p)
    cop = check_cop_budget(left, load, p)
    if layout_only:
        report(1.0, "layouts fitted")
        return ShoeBuild(
            foot, fit, p, _planned_sides(foot, left, sides, p), share, notes=notes, touching=touching, cop=cop
        )
    retention = choose_retention(foot, left, p)
    shoes = _built_sides(foot, left, shoe_steps(foot, left, retention, p), p, sides, report)
    return ShoeBuild(foot, fit, p, shoes, share, retention, (*notes, retention.note), touching=touching, cop=cop)


def _read(foot: Foot | str | os.PathLike[str], parameters: ShoeParameters | None) -> Foot:
    """A foot as it is, or read from its file."""
    if isinstance(foot, Foot):
        return foot
    if not isinstance(foot, str | os.PathLike):
        raise InputError(f"foot is a {type(foot).__name__}; allowed: a Foot, or the path of a mesh or drawing")
    return read_foot(FootSource(file=Path(foot)), sole_band=(parameters or ShoeParameters()).sole_band)[0]


def _fitted(
    foot: Foot, p: ShoeParameters, name: str | None, cell_area: float, taxels: int | None, overhang: float, rim: Rim,
    cell: Cell | None,
) -> tuple[TaxelFit, ShoePlan, tuple[str, ...]]:  # fmt: skip
    """Cells and plan that see the center of pressure both ways, and notes; options as in `build_shoe`."""
    # The plate under the wall meets the ground, too; the load case may ask for a thicker wall.
    wall = strengthened(foot, foot.sole, p)[0].rim_thickness
    face = foot.passing(p.rim_height)
    reach = max(overhang, p.clearance + wall - p.border)

    def placed(reach: float) -> tuple[TaxelFit, ShoePlan]:
        over = reach if taxels is None else overhang
        options = {"overhang": over, "overhang_max": p.overhang_max, "border": p.border}
        if cell is not None:
            found = fit_cells(face, cell, rib=p.rib, taxels=taxels, **options)
        elif rim == "fine":
            found = fit_fine_rim(face, cell_area=cell_area, overhang=reach, border=p.border)
        else:
            found = fit_taxels(face, cell_area=cell_area, taxels=taxels, **options)
        return found, plan_shoe(foot, found, replace(p, border=found.border), name=name)

    tries = [reach]
    if taxels is None and rim == "whole":
        most = p.overhang_max - CORNER * p.border
        tries += [float(r) for r in np.arange(reach + _FARTHER, most, _FARTHER)]
    fit, left, notes = _observed(placed, tries)
    if cell is None and taxels is None and rim == "whole" and not observability(left).holds:
        raise FootError(
            f"cells of {cell_area:g} mm^2 do not see the center of pressure along and across this sole; allowed: "
            "--cell auto, which chooses cells that can be bought, or a smaller --cell-area"
        )
    return fit, left, notes


def _observed(
    placed: Callable[[float], tuple[TaxelFit, ShoePlan]], tries: list[float]
) -> tuple[TaxelFit, ShoePlan, tuple[str, ...]]:
    """Cells and plan of the first reach that observes the CoP both ways, else of the least."""
    problem = None
    kept = None
    least = tries[0]
    for reach in tries:
        try:
            found = placed(reach)
        except FootError as error:
            problem = problem or error
            continue
        if observability(found[1]).holds:
            text = (
                f"the cells reach up to {reach:.1f} mm beyond the sole: within {least:.1f} mm they would not see the "
                "center of pressure both ways"
            )
            return *found, () if reach == least else (text,)
        kept = kept or found
    if kept is not None:
        return *kept, ()
    raise problem or FootError("no cells fit")


def _sensitive(left: ShoePlan, mass: float) -> tuple[ShoePlan, tuple[str, ...]]:
    """A plan whose taxels are active under half of a robot's mass in kg, and a note where that is a lower level."""
    level = _ACTIVE * 0.5 * mass * GRAVITY / len(left.layout)
    if level > 0.5 * left.layout.force_threshold:
        return left, ()
    level = float(f"{level:.2g}")
    layout = replace(left.layout, thresholds={**left.layout.thresholds, "force": level})
    return replace(left, layout=layout), (f"taxels are active from {level:g} N on: the robot is light",)


def _sides_of(side: Sides, rim: Rim) -> tuple[Side, ...]:
    if side not in ("left", "right", "both"):
        raise InputError(f"side is {side!r}; allowed: left, right, both")
    if rim not in RIMS:
        raise InputError(f"rim is {rim!r}; allowed: {', '.join(RIMS)}")
    return SIDES if side == "both" else (side,)


def _planned_sides(foot: Foot, left: ShoePlan, sides: tuple[Side, ...], p: ShoeParameters) -> tuple[Shoe, ...]:
    """Shoes without solids; each layout with its sole's pose, on the shoe's outer face, where it is known."""
    shoes = []
    for which in sides:
        plan = left if which == "left" else mirrored_plan(left)
        bare = foot.poses.get(which)
        pose = None if bare is None else bare.lowered(to_m(p.thickness))
        shoes.append(Shoe(replace(plan, layout=replace(plan.layout, pose=pose))))
    return tuple(shoes)


def _built_sides(
    foot: Foot,
    left: ShoePlan,
    steps: tuple[Step, ...],
    parameters: ShoeParameters,
    sides: tuple[Side, ...],
    report: Progress,
) -> tuple[Shoe, ...]:
    """Solids of the requested sides, with marks."""
    p = parameters
    report(0.1, "loading the CAD kernel")
    load_kernel()
    shoes = []
    for i, shoe in enumerate(_planned_sides(foot, left, sides, p)):
        plan = shoe.plan
        which = shoe.side
        report(0.4 + 0.6 * i / len(sides), f"building the {which} side")
        own = steps if which == "left" else tuple(mirrored_step(s) for s in steps)
        letters = mark_outline(plan, p, which, bare_floor(own)).geoms
        mark = tuple(Block(g, p.thickness - p.mark_depth, p.thickness + 0.5) for g in letters)
        solid = build_solid((*own, Step("cut", "mark", mark)))
        shoes.append(Shoe(plan, solid, solid.surface))
    report(1.0, "all sides built")
    return tuple(shoes)


_NOTE = "an insole of {:g} mm lies in the wearer's shoe, below the foot; nothing holds it"


@missing_libraries("shoes")
def build_insole(
    foot: Foot | str | os.PathLike[str],
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
    """Fit taxels to the outline of a left `foot` (scan, last or outline) in a flat insole.

    Its `thickness` in mm is from the pad's ground face to the foot's face; `side`, `cell_area`, `rim`, `cell`,
    `parameters`, `name`, `layout_only` and `progress` are as in `build_shoe`.

    Example:
        >>> from plantar.shoes.foot.foot import foot_from_dimensions
        >>> foot = foot_from_dimensions("a", length=0.26, width=0.095, corner_radius=0.03)
        >>> build = build_insole(foot, 6.0, layout_only=True)
        >>> build.kind, build.parameters.thickness, round(build.fit.covered_area_ratio, 2)
        ('insole', 6.0, 0.95)
    """
    sides = _sides_of(side, rim)
    foot = insole_foot(_read(foot, parameters))
    report = progress or (lambda fraction, text: None)
    p, of_cell = cell_parameters(cell, parameters or ShoeParameters())
    p, notes = insole_parameters(foot, thickness, p)
    report(0.0, "fitting the taxels to the sole")
    fit = fit_insole(foot, p, cell_area=cell_area, fine=rim == "fine", cell=cell)
    left = plan_insole(foot, fit, p, name=name)
    refuse_too_many(left)
    load = load_case(foot, p)
    p, led = led_parameters(left, p, deepen=False)
    p, lowered = relieved(left, load, p)
    share = check_load_share(left, load, p)
    every = (*foot.notes, *of_cell, *notes, *fit.notes, *led, *lowered, *left.notes, _NOTE.format(thickness))
    if layout_only:
        return ShoeBuild(foot, fit, p, _planned_sides(foot, left, sides, p), share, notes=every, kind="insole")
    shoes = _built_sides(foot, left, insole_steps(left, p), p, sides, report)
    return ShoeBuild(foot, fit, p, shoes, share, Retention("none", (), 0.0, 0.0, ""), every, kind="insole")
