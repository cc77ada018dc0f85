"""Checks of a built shoe, measured on what was exported: the STL's triangles and the solid read back from the STEP."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.optional_library import optional_library
from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.checks.features import Feature, printed_features
from plantar.shoes.checks.mounting import Mounting, check_mounting
from plantar.shoes.checks.printability import Printing, choose_direction, print_hours
from plantar.shoes.checks.weights import Weights, weigh
from plantar.shoes.geometry.outline import ring
from plantar.shoes.geometry.section import thinnest_wall
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.cell_room import lead_rooms
from plantar.shoes.plan.insole_plan import EVEN_SHARE, even_share
from plantar.shoes.plan.load_share import LoadShare
from plantar.shoes.plan.observability import ACROSS, ALONG, ERROR, observability
from plantar.shoes.plan.pull_off import SNAP_MOST, PullOff
from plantar.shoes.plan.shoe_plan import ShoePlan, mirrored_plan
from plantar.shoes.plan.strength import LoadCase, Member, check_strength
from plantar.shoes.plan.touching import ACTIVE_LEAST, AREA_OFF, COP_OFF
from plantar.shoes.plan.wiring import cable_outlines, hole_outline, pocket_outlines
from plantar.shoes.solid.step_model import StepSolid
from plantar.shoes.units import to_mm

__all__ = ["Check", "ShoeCheck", "check_plan", "check_shoe", "corner_errors"]

_OVERHANG_SHARE = 0.02  # of the contact face: what may hang over without support on a printer that lays lines
_FLAT_SHARE, _HALF_SHARE = 0.95, 0.80  # of the load: what goes past the taxels is an error of every force read

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Check:
    """One check: its measured value, and what is allowed, in words."""

    name: str
    holds: bool
    value: float | bool
    allowed: str


@dataclass(frozen=True)
class ShoeCheck:
    """Measures of one shoe.

    Attributes:
        watertight: Whether every edge of the STL has two consistent triangles.
        min_wall_mm: Thinnest wall, floor or bar.
        size_mm: Extent (3,) of the printed part along x, y, z.
        overhang_mm: Reach of the contact face beyond the foot.
        reach_mm: Reach of any part beyond it, lugs and the board's holder included.
        printing: The build directions, the chosen first.
        mounting: The gaps between foot and shoe; None of an insole.
        pull_off: Holding forces; None without holders.
        shortest_edge_mm: Of the STEP.
        arc_share: Share of bent walls that are cylinders and cones, 0..1; 1 where none is bent.
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
    arc_share: float

    @property
    def holds(self) -> bool:
        """Whether every check holds."""
        return all(c.holds for c in self.checks)


def check_shoe(shoe: Shoe, build: ShoeBuild, *, surface: Array, step: StepSolid) -> ShoeCheck:
    """Measure one exported shoe.

    Args:
        shoe: The shoe as built.
        build: Its build.
        surface: Triangles (n, 3, 3) in mm, as read back from the STL.
        step: The solid as read back from the STEP.

    Returns:
        The measures and checks; a check that does not hold raises nothing.
    """
    with optional_library("trimesh", "shoes"):
        import trimesh
    assert build.retention is not None
    p = build.parameters
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(surface))
    watertight = bool(mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0)
    volume = step.volume
    difference = 100.0 * abs(float(mesh.volume) / volume - 1.0) if volume > 0.0 else math.inf
    shoe_kind, plan = build.kind == "shoe", _left(shoe, build)
    engraved = ((p.bottom - 0.01, p.bottom + p.scribe + 0.01), (p.thickness - p.mark_depth - 0.01, p.thickness + 0.01))
    wall = thinnest_wall(surface, engraved)
    printing = choose_direction(surface, p)
    mounting = check_mounting(build.foot, shoe.side, surface, build.retention, p) if shoe_kind else None
    load, members = check_strength(build.foot, plan.contact, p)
    members = members if shoe_kind else ()  # an insole bends with the foot and has no wall
    share = build.load_share
    weights = weigh(shoe, build, volume)
    retention = build.retention
    held = retention.pull_off(build.foot, 1e-3 * weights.total, load.mass, p) if retention.places else None
    reach = _reach(shoe.plan, surface)
    features = printed_features(shoe, build, surface)
    checks = (
        *_solid_checks(step, watertight, int(mesh.body_count), difference),
        Check("thinnest wall, mm", wall >= p.wall_min - 1e-2, round(wall, 3), f"{p.wall_min:g} or more"),
        *_layout_checks(shoe, p, step),
        *check_plan(shoe.plan, build),
        *_feature_checks(features),
        *(_insole_checks(shoe, surface, p) if mounting is None else _mounting_checks(mounting, reach, shoe, build)),
        *(() if held is None else _holding_checks(held)),
        *_lead_checks(shoe.plan, p),
        *_strength_checks(load, members, build, len(shoe.layout)),
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
        arc_share=round(step.round / (step.round + step.flat), 3) if step.round + step.flat > 0.0 else 1.0,
    )


def check_plan(plan: ShoePlan, build: ShoeBuild) -> tuple[Check, ...]:
    """Gives the checks that a plan of a build decides: blind rim, center of pressure, touching taxels, their load
    share.
    """
    return (*_rim_checks(plan, build), *_contact_checks(plan, build), *_share_checks(build.load_share))


def _left(shoe: Shoe, build: ShoeBuild) -> ShoePlan:
    return (
        shoe.plan
        if shoe.side == "left"
        else next((s.plan for s in build.shoes if s.side == "left"), mirrored_plan(shoe.plan))
    )


def _solid_checks(step: StepSolid, watertight: bool, bodies: int, difference: float) -> Iterator[Check]:
    yield Check("solid valid", step.valid, step.valid, "true")
    yield Check("solids", step.solids == 1, float(step.solids), "1")
    yield Check("watertight", watertight, watertight, "true")
    yield Check("separate surfaces in the STL", bodies == 1, float(bodies), "1")
    yield Check("STL against STEP volume, %", difference <= 0.5, round(difference, 6), "0.5 or less")


def _layout_checks(shoe: Shoe, p: ShoeParameters, step: StepSolid) -> Iterator[Check]:
    cells, pockets = corner_errors(shoe, p, step)
    if p.scribe > 0.0:
        yield Check("cell corners against the solid, mm", cells <= 0.05, round(cells, 6), "0.05 or less")
    yield Check("pocket corners against the layout, mm", pockets <= 0.05, round(pockets, 6), "0.05 or less")
    outside = _taxels_outside(shoe)
    yield Check("taxels beyond the contact face", outside == 0, float(outside), "0")
    fewest, where = shoe.plan.fewest_taxels
    yield Check(f"taxels in the {where}, the barest of five places", fewest > 0, float(fewest), "1 or more")


def _rim_checks(plan: ShoePlan, build: ShoeBuild) -> Iterator[Check]:
    most = build.fit.blind_most
    if most is not None:
        blind = plan.blind_rim
        yield Check("blind rim beyond the taxels' centres, mm", blind <= most, round(blind, 2), f"{most:g} or less")


def _feature_checks(features: tuple[Feature, ...]) -> Iterator[Check]:
    for f in features:
        yield Check(f"{f.name} ({f.part}), %", f.holds, round(100.0 * f.share, 1), "90 or more of it in the print")


def _contact_checks(plan: ShoePlan, build: ShoeBuild) -> Iterator[Check]:
    if build.kind == "insole":  # which bends to the ground, and to the foot
        return
    seen, touching = observability(plan), build.touching
    least, share = 100.0 * ALONG, 100.0 * seen.along
    yield Check("taxels' centres over the face's length, %", share >= least, round(share, 1), f"{least:g} or more")
    least, share = 100.0 * ACROSS, 100.0 * seen.across
    yield Check("taxels' centres over the face's width, %", share >= least, round(share, 1), f"{least:g} or more")
    most = ERROR * seen.width
    name = "error of the center of pressure for a load anywhere on the face, mm"
    yield Check(name, seen.error <= most, seen.error, f"{most:.1f} or less")
    if touching is None:
        return
    at = f"at half the weight, seats within {touching.scatter:g} mm (1 sigma)"
    least, share = 100.0 * ACTIVE_LEAST, 100.0 * touching.active
    yield Check(f"taxels active {at}, %", share >= least, round(share, 1), f"{least:g} or more")
    least, share = 100.0 * (1.0 - AREA_OFF), 100.0 * touching.area
    yield Check(f"footprint {at}, %", share >= least, round(share, 1), f"{least:g} or more")
    good = touching.cop_error <= COP_OFF
    yield Check(f"center of pressure off {at}, mm", good, touching.cop_error, f"{COP_OFF:g} or less")


def _insole_checks(shoe: Shoe, surface: Array, p: ShoeParameters) -> Iterator[Check]:
    high = float(surface[..., 2].max())
    yield Check("thickness, mm", abs(high - p.thickness) <= 0.05, round(high, 3), f"{p.thickness:g} within 0.05")
    beyond = float(_beyond(shoe.plan.foot, surface))
    yield Check("beyond the foot's outline, mm", beyond <= 1e-2, round(beyond, 3), "0")
    covered, least = 100.0 * even_share(shoe.plan.cells, shoe.plan.foot), 100.0 * EVEN_SHARE
    yield Check("even pressure that the taxels carry, %", covered >= least, round(covered, 1), f"{least:g} or more")


def _beyond(outline: Any, surface: Array) -> float:
    points = np.unique(surface.reshape(-1, 3)[:, :2].round(4), axis=0)
    return float(outline.distance(shapely.points(points)).max())


def _mounting_checks(m: Mounting, reach: float, shoe: Shoe, build: ShoeBuild) -> Iterator[Check]:
    p, overhang = build.parameters, shoe.plan.overhang
    assert build.retention is not None
    least = p.clearance - 0.05
    yield Check("gap between foot and wall, mm", m.gap >= least, round(m.gap, 3), f"{least:g} or more")
    most = 1.2 * p.clearance + 0.5
    yield Check("play at the wall's upper edge, mm", m.play <= most, round(m.play, 3), f"{most:g} or less")
    if build.retention.places:
        above = m.gap_above if math.isfinite(m.gap_above) else 1e3
        yield Check("gap between foot and clips or lugs, mm", above >= 0.05, round(above, 3), "0.05 or more")
    name = "places where the robot's other links meet print or straps"
    yield Check(
        f"{name}, {'as its model moves' if m.links_known else 'shank assumed'}", m.links == 0, float(m.links), "0"
    )
    yield Check(
        "gap while the shoe is pushed on, mm",
        m.gap_on_the_way >= least,
        round(m.gap_on_the_way, 3),
        f"{least:g} or more",
    )
    yield Check("undercut of the foot's place, mm2", m.undercut == 0.0, m.undercut, "0")
    yield Check("gap between foot and floor, mm", m.floor_gap <= 0.05, round(m.floor_gap, 3), "0.05 or less")
    yield Check(
        "touching area over the floor, %", m.support_share >= 0.97, round(100.0 * m.support_share, 2), "97 or more"
    )
    allowed = f"{p.overhang_max:g} or less"
    yield Check("overhang, mm", overhang <= p.overhang_max + 1e-2, round(overhang, 2), allowed)
    allowed = f"{p.reach_max:g} or less"
    yield Check("reach of lugs, clips and holder, mm", reach <= p.reach_max + 1e-2, round(reach, 2), allowed)


def _holding_checks(held: PullOff) -> Iterator[Check]:
    enough = held.force >= held.swing
    yield Check("force that pulls the shoe off, N", enough, round(held.force, 1), f"{held.swing:.1f} or more (5 g)")
    enough = held.moment >= held.scuff
    yield Check(
        "moment that holds the shoe in a scuff at the toe, N m",
        enough,
        round(held.moment, 2),
        f"{held.scuff:.2f} or more",
    )
    if held.snap > 0.0:
        easy = held.snap <= SNAP_MOST
        yield Check("force that snaps a clip on, N", easy, round(held.snap, 1), f"{SNAP_MOST:g} or less")


def _share_checks(share: LoadShare) -> Iterator[Check]:
    flat, half = 100.0 * share.flat, 100.0 * share.half
    least = 100.0 * _FLAT_SHARE
    yield Check("load that the taxels carry on flat ground, %", flat >= least, round(flat, 1), f"{least:g} or more")
    least = 100.0 * _HALF_SHARE
    yield Check("load that the taxels carry on half the sole, %", half >= least, round(half, 1), f"{least:g} or more")


def _lead_checks(plan: ShoePlan, p: ShoeParameters) -> Iterator[Check]:
    for place in lead_rooms(plan, p):
        allowed = f"{place.room:.1f} or less"
        yield Check(f"leads in the {place.name}, mm2", place.holds, round(place.needed, 1), allowed)


def _strength_checks(load: LoadCase, members: tuple[Member, ...], build: ShoeBuild, taxels: int) -> Iterator[Check]:
    p = build.parameters
    for m in members:
        yield Check(f"stress of the {m.name}, MPa", m.holds, m.stress, f"{m.allowed:g} or less ({p.material})")
    each = load.force / max(1.0, p.load_share * taxels)
    limit = build.shoes[0].layout.ranges["force"][1]
    yield Check("load of a taxel, N", each <= limit, round(each, 1), f"{limit:g} or less")
    if build.retention is not None and build.retention.strain > 0.0:
        strain, most = 100.0 * build.retention.strain, 100.0 * p.printed.strain
        yield Check("strain of a clip's arm, %", strain <= most, round(strain, 2), f"{most:g} or less")


def _printing_checks(best: Printing, plan: ShoePlan, p: ShoeParameters) -> Iterator[Check]:
    powder = not p.made_by.supports
    most = round(_OVERHANG_SHARE * plan.contact.area)
    yield Check(
        f"overhang beyond 45 degrees, {best.direction}, mm2",
        powder or best.overhang <= most,
        best.overhang,
        f"{most:g} or less" + (", or more in a powder bed" if powder else ""),
    )
    size = " x ".join(f"{v:g}" for v in (p.bed_length, p.bed_width, p.bed_height))
    yield Check("longest side on the printer, mm", best.fits, best.size[0], f"within {size}")


def _reach(plan: ShoePlan, surface: Array) -> float:
    hull = shapely.MultiPoint(surface.reshape(-1, 3)[:, :2]).convex_hull
    return float(max(plan.foot.distance(shapely.points(ring(hull)))))


def corner_errors(shoe: Shoe, parameters: ShoeParameters, step: StepSolid) -> tuple[float, float]:
    """Distance of corners in the solid from where the layout states them.

    Args:
        shoe: The shoe.
        parameters: Its dimensions.
        step: The solid as read back from the STEP.

    Returns:
        Largest distance in mm of a layout's cell corner from the groove in the ribs, and of a pocket's corner from one
        in the pockets' ceiling, those left out that a port or the channel removes.
    """
    p = parameters
    cable = shapely.union_all([*cable_outlines(shoe.plan, p), hole_outline(shoe.plan, p)]).buffer(0.05)
    cable = cable.union(
        shapely.union_all(pocket_outlines(shoe.plan, p)).buffer(-1e-3)
    )  # and what is too thin next to it
    shapely.prepare(cable)
    corners = np.concatenate([to_mm(shoe.layout.cell_polygon(i)) for i in range(len(shoe.layout))])
    pockets = np.concatenate([ring(q) for q in shoe.plan.pockets])
    kept, pockets = (c[~shapely.contains_xy(cable, c[:, 0], c[:, 1])] for c in (corners, pockets))
    return _farthest(kept, step, p.bottom + p.scribe), _farthest(pockets, step, p.ceiling)


def _farthest(wanted: Array, step: StepSolid, height: float) -> float:
    """Largest distance from a wanted point (n, 2) to the nearest corner or circle found at a height."""
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
