"""Checks of a built shoe, measured on exported STL and STEP."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.checks.features import printed_features
from plantar.shoes.checks.mounting import Mounting, check_mounting
from plantar.shoes.checks.printability import Printing, Weights, choose_direction, print_hours, weigh
from plantar.shoes.geometry.outline import ring
from plantar.shoes.geometry.section import thinnest_wall
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.cell_room import bend_at_heel, lead_rooms
from plantar.shoes.plan.ground_plate import ground_plate, has_ground_plate
from plantar.shoes.plan.insole_plan import EVEN_SHARE, even_share
from plantar.shoes.plan.load_share import LoadShare
from plantar.shoes.plan.pull_off import SNAP_MOST, PullOff
from plantar.shoes.plan.shoe_plan import ShoePlan, mirrored_plan
from plantar.shoes.plan.strength import LoadCase, Member, check_strength, load_case
from plantar.shoes.plan.touching import ACROSS, ACTIVE_LEAST, ALONG, AREA_OFF, COP_OFF, ERROR, observability
from plantar.shoes.plan.wiring import cable_outlines, hole_outline, pocket_outlines
from plantar.shoes.solid.kernel import SHORTEST
from plantar.shoes.solid.step_model import StepSolid
from plantar.shoes.units import to_mm

LOAD = "load of a taxel, N"
"""Name of the check that a cell carries its load."""

_OVERHANG_SHARE = 0.02  # of the contact face: what may hang over without support on a printer that lays lines
_LONG = 0.7  # of a foot's length: a sole that is shorter, as of a high heel, is no foot's that stands on a flat shoe
# of the load: what goes past the taxels is an error of every force read
_FLAT_SHARE = 0.95
_HALF_SHARE = 0.80

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Check:
    """One check: measured value, and what is allowed, in words."""

    name: str
    holds: bool
    value: float | bool
    allowed: str


@dataclass(frozen=True)
class ShoeCheck:
    """Measures of one shoe.

    Attributes:
        watertight: Whether every STL edge has two consistent triangles.
        min_wall_mm: Thinnest wall, floor or bar.
        size_mm: Printed extent (3,).
        overhang_mm: Contact face beyond the foot.
        reach_mm: Any part beyond it, lugs and board holder included.
        printing: Build directions, chosen first.
        mounting: None of an insole.
        pull_off: None without holders.
        shortest_edge_mm: Of the STEP.
    """

    watertight: bool
    volume_cm3: float
    mass_g: float
    min_wall_mm: float
    size_mm: tuple[float, float, float]
    overhang_mm: float
    reach_mm: float
    print_hours: float
    printing: tuple[Printing, ...]
    mounting: Mounting | None
    load: LoadCase
    members: tuple[Member, ...]
    load_share: LoadShare
    weights: Weights
    pull_off: PullOff | None
    checks: tuple[Check, ...]
    shortest_edge_mm: float

    @property
    def holds(self) -> bool:
        return all(c.holds for c in self.checks)


def check_shoe(
    shoe: Shoe, build: ShoeBuild, *, surface: Array, step: StepSolid, parts: Mapping[str, bool] | None = None
) -> ShoeCheck:
    """Gives measures and checks of a build's shoe, by STL surface (n, 3, 3) in mm and STEP solid (step); `parts`:
    whether each other part of the assembly is valid.
    """
    with optional_library("trimesh", "shoes"):
        import trimesh
    assert build.retention is not None
    p = build.parameters
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(surface))
    watertight = bool(mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0)
    volume = step.volume
    difference = 100.0 * abs(float(mesh.volume) / volume - 1.0) if volume > 0.0 else math.inf
    shoe_kind = build.kind == "shoe"
    left = shoe.plan if shoe.side == "left" else mirrored_plan(shoe.plan)
    engraved = ((p.bottom - 0.01, p.bottom + p.scribe + 0.01), (p.thickness - p.mark_depth - 0.01, p.thickness + 0.01))
    wall = thinnest_wall(surface, engraved)
    printing = choose_direction(surface, p)
    mounting = check_mounting(build.foot, shoe.side, surface, build.retention, p) if shoe_kind else None
    load, members = check_strength(build.foot, left.contact, p)
    members = members if shoe_kind else ()  # an insole bends with the foot and has no wall
    if has_ground_plate(left):
        members = (*members, ground_plate(left, load, p))
    share = build.load_share
    weights = weigh(shoe, build, volume)
    retention = build.retention
    held = retention.pull_off(build.foot, 1e-3 * weights.total, load.mass, p) if retention.places else None
    reach = _reach(shoe.plan, surface)
    checks = (
        *_solid_checks(step, watertight, int(mesh.body_count), difference),
        *(Check(f"{name} of the assembly valid", good, good, "true") for name, good in (parts or {}).items()),
        Check("thinnest wall, mm", wall >= p.wall_min - 1e-2, round(wall, 3), f"{p.wall_min:g} or more"),
        *_layout_checks(shoe, p, step),
        *check_plan(shoe.plan, build),
        *(
            Check(f"{f.name} ({f.part}), %", f.holds, round(100.0 * f.share, 1), "90 or more of it in the print")
            for f in printed_features(shoe, build, surface)
        ),
        *(_insole_checks(shoe, surface, p) if mounting is None else _mounting_checks(mounting, reach, shoe, build)),
        *(() if held is None else _holding_checks(held)),
        *(
            Check(f"leads in the {q.name}, mm2", q.holds, round(q.needed, 1), f"{q.room:.1f} or less")
            for q in lead_rooms(shoe.plan, p)
        ),
        *_bend_checks(shoe.plan, p),
        *_strength_checks(members, build),
        *_printing_checks(printing[0], shoe.plan, p),
    )
    size = np.ptp(surface.reshape(-1, 3), axis=0)
    return ShoeCheck(
        watertight=watertight,
        volume_cm3=round(volume / 1000.0, 3),
        mass_g=round(volume / 1000.0 * p.printed.density, 2),
        min_wall_mm=round(wall, 3),
        size_mm=(round(float(size[0]), 3), round(float(size[1]), 3), round(float(size[2]), 3)),
        overhang_mm=round(shoe.plan.overhang, 2),
        reach_mm=round(reach, 2),
        print_hours=round(print_hours(volume, printing[0].size[2], p.flow), 1),
        printing=printing,
        mounting=mounting,
        load=load,
        members=members,
        load_share=share,
        weights=weights,
        pull_off=held,
        checks=checks,
        shortest_edge_mm=round(step.shortest, 3),
    )


def check_plan(plan: ShoePlan, build: ShoeBuild) -> tuple[Check, ...]:
    """Gives checks decided by a build's plan: blind rim, CoP, touching taxels, load share."""
    rim = build.fit.blind_most
    share = build.load_share
    low = build.foot.passing(min(build.foot.height, build.parameters.clip_height_max)).bounds
    long = (build.foot.sole.bounds[2] - build.foot.sole.bounds[0]) / (low[2] - low[0])
    return (
        _least("length of the sole over that of the foot's lower part, %", 100.0 * long, 100.0 * _LONG),
        *(() if rim is None else (_most("blind rim beyond the taxels' centres, mm", plan.blind_rim, rim, 2),)),
        _most("overhang, mm", plan.overhang, build.parameters.overhang_max, 2, 1e-2),
        *_contact_checks(plan, build),
        _least("load that the taxels carry on flat ground, %", 100.0 * share.flat, 100.0 * _FLAT_SHARE),
        _least("load that the taxels carry on half the sole, %", 100.0 * share.half, 100.0 * _HALF_SHARE),
    )


def _least(name: str, value: float, least: float, digits: int = 1) -> Check:
    return Check(name, value >= least, round(value, digits), f"{least:g} or more")


def _most(name: str, value: float, most: float, digits: int = 1, slack: float = 0.0) -> Check:
    return Check(name, value <= most + slack, round(value, digits), f"{most:g} or less")


def _solid_checks(step: StepSolid, watertight: bool, bodies: int, difference: float) -> Iterator[Check]:
    yield Check("solid valid", step.valid, step.valid, "true")
    yield Check("solids", step.solids == 1, float(step.solids), "1")
    yield Check("watertight", watertight, watertight, "true")
    yield Check("separate surfaces in the STL", bodies == 1, float(bodies), "1")
    yield _most("STL against STEP volume, %", difference, 0.5, 6)


def _layout_checks(shoe: Shoe, p: ShoeParameters, step: StepSolid) -> Iterator[Check]:
    cells, pockets = corner_errors(shoe, p, step)
    if p.scribe > 0.0:
        yield _most("cell corners against the solid, mm", cells, 0.05, 6)
    yield _most("pocket corners against the layout, mm", pockets, 0.05, 6)
    outside = _taxels_outside(shoe)
    yield Check("taxels beyond the contact face", outside == 0, float(outside), "0")
    if has_ground_plate(shoe.plan):
        return
    fewest, where = shoe.plan.fewest_taxels
    yield Check(f"taxels in the {where}, the barest of five places", fewest > 0, float(fewest), "1 or more")


def _contact_checks(plan: ShoePlan, build: ShoeBuild) -> Iterator[Check]:
    if build.kind == "insole":  # which bends to the ground, and to the foot
        return
    seen = observability(plan)
    touching = build.touching
    p = build.parameters
    yield _least("taxels' centres over the face's length, %", 100.0 * seen.along, 100.0 * ALONG)
    yield _least("taxels' centres over the face's width, %", 100.0 * seen.across, 100.0 * ACROSS)
    most = ERROR * seen.width
    name = "error of the center of pressure for a load anywhere on the face, mm"
    yield Check(name, seen.error <= most, seen.error, f"{most:.1f} or less")
    if build.cop is not None:
        name = f"center of pressure off by seats, gains, hysteresis, threshold, range, crosstalk and rim ({p.use}), mm"
        yield Check(name, build.cop.holds, build.cop.together, f"{build.cop.limit:g} or less")
    each = cell_load(plan, load_case(build.foot, p), p)
    yield _most(LOAD, each, plan.layout.ranges["force"][1])
    if touching is None or has_ground_plate(plan):  # a few cells below a plate see force and its center, no footprint
        return
    at = f"at half the weight, seats within {touching.scatter:g} mm (1 sigma)"
    yield _least(f"taxels active {at}, %", 100.0 * touching.active, 100.0 * ACTIVE_LEAST)
    yield _least(f"footprint {at}, %", 100.0 * touching.area, 100.0 * (1.0 - AREA_OFF))
    yield _most(f"center of pressure off {at}, mm", touching.cop_error, COP_OFF, 3)


def _insole_checks(shoe: Shoe, surface: Array, p: ShoeParameters) -> Iterator[Check]:
    high = float(surface[..., 2].max())
    outline = shoe.plan.foot
    yield Check("thickness, mm", abs(high - p.thickness) <= 0.05, round(high, 3), f"{p.thickness:g} within 0.05")
    beyond = float(outline.distance(shapely.points(np.unique(surface.reshape(-1, 3)[:, :2].round(4), axis=0))).max())
    yield Check("beyond the foot's outline, mm", beyond <= 1e-2, round(beyond, 3), "0")
    covered = 100.0 * even_share(shoe.plan.cells, outline)
    yield _least("even pressure that the taxels carry, %", covered, 100.0 * EVEN_SHARE)


def _mounting_checks(m: Mounting, reach: float, shoe: Shoe, build: ShoeBuild) -> Iterator[Check]:
    p = build.parameters
    assert build.retention is not None
    yield _least("gap between foot and wall, mm", m.gap, p.clearance - 0.05, 3)
    yield _most("play at the wall's upper edge, mm", m.play, 1.2 * p.clearance + 0.5, 3)
    if build.retention.places:
        above = m.gap_above if math.isfinite(m.gap_above) else 1e3
        yield _least("gap between foot and clips or lugs, mm", above, 0.05, 3)
    how = "as its model moves" if m.links_known else "shank assumed"
    yield Check(f"places where the robot's other links meet print or straps, {how}", m.links == 0, float(m.links), "0")
    unread = build.foot.unread
    if unread:
        name = f"links near the foot whose shape is not read ({', '.join(unread)})"
        yield Check(name, False, float(len(unread)), "0: give the model its meshes, or state the shank (--shank)")
    yield _least("gap while the shoe is pushed on, mm", m.gap_on_the_way, p.clearance - 0.05, 3)
    yield Check("undercut of the foot's place, mm2", m.undercut == 0.0, m.undercut, "0")
    yield _most("gap between foot and floor, mm", m.floor_gap, 0.05, 3)
    yield _least("touching area over the floor, %", 100.0 * m.support_share, 97.0, 2)
    yield _most("reach of lugs, clips and holder, mm", reach, p.reach_max, 2, 1e-2)


def _holding_checks(held: PullOff) -> Iterator[Check]:
    enough = held.force >= held.swing
    allowed = f"{held.swing:.1f} or more (5 g)"
    yield Check("force that pulls the shoe off, N", enough, round(held.force, 1), allowed)
    enough = held.moment >= held.scuff
    allowed = f"{held.scuff:.2f} or more"
    yield Check("moment that holds the shoe in a scuff at the toe, N m", enough, round(held.moment, 2), allowed)
    if held.snap > 0.0:
        yield _most("force that snaps a clip on, N", held.snap, SNAP_MOST)


def _bend_checks(plan: ShoePlan, p: ShoeParameters) -> Iterator[Check]:
    if plan.cell is not None and plan.cell.bend_radius and plan.heel.board:
        yield _least("bend of the cable up the heel, mm", bend_at_heel(plan.cell, p), plan.cell.bend_radius, 2)


def cell_load(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> float:
    """Gives the most that a cell of a plan carries of a load, by parameters: all of it of a few below a plate."""
    return load.force if has_ground_plate(plan) else load.force / max(1.0, parameters.load_share * len(plan.layout))


def _strength_checks(members: tuple[Member, ...], build: ShoeBuild) -> Iterator[Check]:
    p = build.parameters
    for m in members:
        yield Check(f"stress of the {m.name}, MPa", m.holds, m.stress, f"{m.allowed:g} or less ({p.material})")
    if build.retention is not None and build.retention.strain > 0.0:
        yield _most("strain of a clip's arm, %", 100.0 * build.retention.strain, 100.0 * p.printed.strain, 2)


def _printing_checks(best: Printing, plan: ShoePlan, p: ShoeParameters) -> Iterator[Check]:
    check = _most(
        f"overhang beyond 45 degrees, {best.direction}, mm2", best.overhang, round(_OVERHANG_SHARE * plan.contact.area)
    )
    powder = not p.made_by.supports
    yield replace(check, holds=True, allowed=f"{check.allowed}, or more in a powder bed") if powder else check
    size = " x ".join(f"{v:g}" for v in (p.bed_length, p.bed_width, p.bed_height))
    yield Check("longest side on the printer, mm", best.fits, best.size[0], f"within {size}")


def _reach(plan: ShoePlan, surface: Array) -> float:
    hull = shapely.MultiPoint(surface.reshape(-1, 3)[:, :2]).convex_hull
    return float(max(plan.foot.distance(shapely.points(ring(hull)))))


def corner_errors(shoe: Shoe, parameters: ShoeParameters, step: StepSolid) -> tuple[float, float]:
    """Gives largest distances in mm of a shoe's corners in the solid (step) from the layout's, by parameters: of cells
    from the groove, of pockets from the ceiling, except those removed by port or channel or with a short edge.
    """
    p = parameters
    cable = shapely.union_all([*cable_outlines(shoe.plan, p), hole_outline(shoe.plan, p)]).buffer(SHORTEST)
    cable |= shapely.union_all(pocket_outlines(shoe.plan, p)).buffer(-1e-3)  # and what is too thin next to it
    shapely.prepare(cable)
    corners = np.concatenate([to_mm(shoe.layout.cell_polygon(i)) for i in range(len(shoe.layout))])
    pockets = np.concatenate([_apart(ring(q)) for q in shoe.plan.pockets])
    kept, pockets = (c[~shapely.contains_xy(cable, c[:, 0], c[:, 1])] for c in (corners, pockets))
    return _farthest(kept, step, p.bottom + p.scribe), _farthest(pockets, step, p.ceiling)


def _apart(corners: Array) -> Array:
    long = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T) >= SHORTEST
    return np.asarray(corners[long & np.roll(long, 1)])


def _farthest(wanted: Array, step: StepSolid, height: float) -> float:
    level = step.corners[np.abs(step.corners[:, 2] - height) < 1e-3, :2]
    round_ = step.circles[np.abs(step.circles[:, 2] - height) < 1e-3]
    if not len(level) or not len(wanted):
        return 0.0 if not len(wanted) else math.inf
    gaps = np.hypot(*(wanted[:, None] - level[None]).transpose(2, 0, 1))
    off = np.abs(np.hypot(*(wanted[:, None] - round_[None, :, :2]).transpose(2, 0, 1)) - round_[:, 3])
    return float(np.minimum(gaps.min(axis=1), off.min(axis=1, initial=math.inf)).max())


def _taxels_outside(shoe: Shoe) -> int:
    outline = shapely.Polygon(to_mm(shoe.layout.outline)).buffer(1e-3)
    cells = [shapely.Polygon(to_mm(shoe.layout.cell_polygon(i))) for i in range(len(shoe.layout))]
    return sum(not outline.covers(c) for c in cells)
