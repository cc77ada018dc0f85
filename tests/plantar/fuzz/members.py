"""Checks of the members that are no shapes: sums against exact ones, others as the functions give them, and batches."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar import batch
from plantar.mechanics.zmp import zero_moment_wrench
from plantar.percepts.feet import FeetPercept
from plantar.percepts.sole_pose import SolePose
from plantar.sensing import force, ground_plane, proximity, temperature, virtual_wrench

from .. import references as exact
from .shapes import strictly_convex
from .soles import Block, check, differing, not_finite, numbers, unit_wrenches

Array = NDArray[np.float64]
_SUM = 1e-14
"""Allowed error of a sum of up to 51 terms, over the sum of their absolute values."""


def _error(got: Array, wanted: Array, scale: Array) -> Array:
    return np.asarray((np.abs(got - wanted) / np.where(scale > 0.0, scale, 1.0)).max(axis=-1))


def _loads(block: Block) -> None:
    """Active taxels, faults, wrench, area and CoP of each percept against sums in extended precision, `math.fsum`."""
    percepts, layout = block.percepts, block.layout
    check("active", block, (np.array([p.active for p in percepts]) != block.active).any(axis=1))
    faulty = ~np.isfinite(block.force) | (np.nan_to_num(block.force, nan=-1.0, posinf=-1.0) >= layout.force_limit)
    check("health", block, (np.array([p.health.faulty for p in percepts]) != faulty).any(axis=1))
    check("sound_force", block, (np.isnan([p.sound_force for p in percepts]) != faulty).any(axis=1))
    kept = np.array([p.active_force for p in percepts])
    check("active_force", block, (kept != np.where(block.active, block.force, 0.0)).any(axis=1))
    wanted, scale = block.wrenches
    got = np.array([p.wrench_in_sole for p in percepts])
    check("wrench_in_sole", block, _error(got, wanted, scale), _SUM)
    right = np.array([exact.wrench_exact(unit_wrenches(layout), row) for row in kept[::10]])
    check("wrench_in_sole: math.fsum", block, _error(got[::10], right, scale[::10]), _SUM)
    vertical = np.array([p.vertical_force for p in percepts])
    check("vertical_force", block, _error(vertical[:, None], wanted[:, 2:3], scale[:, 2:3]), _SUM)
    areas = np.array([math.fsum(layout.areas[row]) for row in block.active])
    got_area = np.array([p.contact_area for p in percepts])
    check("contact_area", block, _error(got_area[:, None], areas[:, None], areas[:, None]), _SUM)
    loaded = wanted[:, 2] > 0.0
    weights = (kept * layout.rotations[:, 2, 2]).astype(np.longdouble)
    reach = float(np.abs(layout.positions[:, :2]).max()) + 1e-9
    for percept, carries, weight in zip(percepts, loaded, weights, strict=True):
        cop = percept.position_cop_in_sole
        assert (cop is not None) == carries
        if cop is not None:
            truth = np.asarray((weight @ layout.positions[:, :2]) / weight.sum(), dtype=float)
            assert np.abs(cop - truth).max() <= 1e-13 * reach


def _functions(block: Block) -> None:
    """Members of every modality as the functions give them, which their own tests compare with the definitions."""
    layout = block.layout
    for percept in block.percepts:
        reading, wrench = percept.reading, percept.wrench_in_sole
        pairs = [
            (percept.zero_moment_wrench_in_sole, zero_moment_wrench(wrench, minimum_force=0.0)),
            (
                percept.pressure_driven_wrench_in_sole,
                force.scaled_by_area(wrench, percept.contact_area, layout.cell_area),
            ),
        ]
        if (far := reading.proximity) is not None:
            level = layout.proximity_threshold
            assert percept.near.tolist() == proximity.near_taxels(far, level).tolist()
            contours = proximity.height_contours(layout, far, percept.options.contour_heights)
            plane, fitted = percept.ground_plane_in_sole, ground_plane.fit_ground_plane(layout, far)
            gain = percept.options.proximity_gain
            pairs += [
                (percept.preemptive_polygon_in_sole, proximity.preemptive_polygon(layout, far, level)),
                *((one[1:], two[1:]) for one, two in zip(percept.height_contours_in_sole, contours, strict=True)),
                (plane and (plane.height, plane.slope), fitted and (fitted.height, fitted.slope)),
                (percept.virtual_wrench_in_sole, virtual_wrench.virtual_ground_reaction_wrench(layout, far, gain)),
            ]
            assert strictly_convex(percept.preemptive_polygon_in_sole)
        if (heat := reading.temperature) is not None:
            pairs += [
                (percept.temperature_wrench_in_sole, temperature.temperature_wrench(layout, heat)),
                (percept.temperature_footprint_in_sole, temperature.temperature_footprint(layout, heat)),
            ]
        for one, two in pairs:
            assert numbers(one).tolist() == numbers(two).tolist()
            assert np.isfinite(numbers(one)).all()
        absent = (percept.near, percept.ground_plane_in_sole, percept.temperature_wrench_in_sole)
        assert reading.proximity is not None or absent == (None, None, None)
        if reading.acceleration is not None:
            turned = np.einsum("nij,nj->ni", layout.rotations, reading.acceleration)
            seen = np.isfinite(turned)
            np.testing.assert_allclose(percept.acceleration_in_sole[seen], turned[seen], rtol=0.0, atol=1e-12)


def _points(rows: Array) -> list[Array | None]:
    """The rows (n, 2) as the percepts give them: None for one that is NaN."""
    return [None if np.isnan(row).all() else row for row in rows]


def _batch_functions(block: Block) -> None:
    """The batch functions against the percepts, reading by reading."""
    layout, percepts = block.layout, block.percepts
    wanted, scale = block.wrenches
    check("wrenches", block, _error(batch.wrenches(layout, block.force), wanted, scale), _SUM)
    strided = np.repeat(block.force, 2, axis=0)[::2][::-1]
    check("wrenches: strided", block, _error(batch.wrenches(layout, strided)[::-1], wanted, scale), _SUM)
    whole = force.ground_reaction_wrench(layout, block.force)
    check("ground_reaction_wrench", block, _error(whole, wanted, scale), _SUM)
    sums = batch.loads(layout, block.force)
    check("loads: wrench", block, differing(list(sums.wrench), [p.wrench_in_sole for p in percepts]))
    check("loads: area", block, sums.contact_area != np.array([p.contact_area for p in percepts]))
    cops = [p.position_cop_in_sole for p in percepts]
    check("loads: CoP", block, differing(_points(sums.center_of_pressure), cops))
    hulls = batch.support_polygons(layout, block.force, vertices=True)
    check("support_polygons: area", block, hulls.area != np.array([p.support_area for p in percepts]))
    centroids = [p.centroid_in_sole for p in percepts]
    check("support_polygons: centroid", block, differing(_points(hulls.centroid), centroids))
    parts = [hulls.polygon(i) for i in range(len(block))]
    check("support_polygons: vertices", block, differing(parts, [p.support_polygon_in_sole for p in percepts]))
    bare = batch.support_polygons(layout, block.force)
    check("support_polygons: without vertices", block, bare.area != hulls.area)


def _two_feet(block: Block) -> None:
    """Every member of what two feet measure together is finite."""
    at = block.pose.position_in_world
    poses = [block.pose, SolePose.flat(at[0], at[1] + 0.3, at[2])]
    members = [n for n in dir(FeetPercept) if not n.startswith("_")]
    for i in range(0, len(block), 2):  # a reading each foot
        feet = FeetPercept([block.percepts[i], block.percepts[i - 1]], poses, float(at[2]))
        assert not any(not_finite([getattr(feet, m) for m in members]))


MEMBER_CHECKS = (_loads, _functions, _batch_functions, _two_feet)
"""The checks of this module, each a function of a block."""
