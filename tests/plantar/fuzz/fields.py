"""Checks of proximity, temperature, acceleration, the ground's plane and the wrenches that nothing exerts."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.sensing import body_skin, ground_plane, proximity, temperature, virtual_wrench

from .shapes import strictly_convex
from .soles import Block, check, differing

__all__ = ["FIELD_CHECKS"]

Array = NDArray[np.float64]
_GAIN = 50.0


def _near_ground(block: Block) -> None:
    """Near taxels, their polygons, contours that nest, and the virtual wrench."""
    layout, distance, percepts = block.layout, block.proximity, block.percepts
    reach = layout.proximity_range
    known = np.where(np.isnan(distance), math.inf, distance)
    near = known < layout.proximity_threshold
    check("near_taxels", block, (proximity.near_taxels(distance, layout.proximity_threshold) != near).any(axis=1))
    seen = [i for i, p in enumerate(percepts) if p.near is not None]
    wrong = (np.array([percepts[i].near for i in seen]) != near[seen]).any(axis=1)
    check("Percept.near", block, wrong)
    hulls = [percepts[i].preemptive_polygon_in_sole for i in seen]
    check("Percept.preemptive_polygon_in_sole: convex", block, [not strictly_convex(h) for h in hulls])
    empty = np.array([len(h) > 0 for h in hulls]) != near[seen].any(axis=1)
    check("Percept.preemptive_polygon_in_sole: empty", block, empty)
    direct = [proximity.preemptive_polygon(layout, distance[i], layout.proximity_threshold) for i in seen]
    check("preemptive_polygon", block, differing(direct, hulls))
    stacks = [percepts[i].height_contours_in_sole for i in seen]
    heights = [[] if s is None else [c.height for c in s] for s in stacks]
    assert all(h == heights[0] for h in heights)
    masks = np.array([c.taxels for s in stacks if s for c in s]).reshape(len(seen), -1, len(layout))
    broken = (masks[:, :-1] & ~masks[:, 1:]).any(axis=(1, 2))
    check("Percept.height_contours_in_sole: nest", block, broken)
    measure = proximity.proximity_measure(distance, reach)
    right = np.clip(reach - known, 0.0, reach)
    check("proximity_measure", block, np.abs(measure - right).max(axis=1) / reach, 1e-15)
    normal = layout.rotations[:, :, 2]
    columns = np.hstack([normal, np.cross(layout.positions, normal)]).astype(np.longdouble)
    wanted = np.asarray(_GAIN * (right.astype(np.longdouble) @ columns), dtype=float)
    scale = np.asarray(_GAIN * (right @ np.abs(columns)), dtype=float) + 1e-300
    whole = virtual_wrench.virtual_ground_reaction_wrench(layout, distance, _GAIN)
    check("virtual_ground_reaction_wrench", block, (np.abs(whole - wanted) / scale).max(axis=1), 1e-14)
    own = np.array([percepts[i].virtual_wrench_in_sole for i in seen])
    check(
        "Percept.virtual_wrench_in_sole",
        block,
        (np.abs(own - wanted[seen]) / scale[seen]).max(axis=1),
        1e-14,
    )


def _plane_of_ground(block: Block) -> None:
    """Planes are finite, as flat as their points allow, and found again where every taxel sees one plane."""
    layout = block.layout
    planes = [plane for p in block.percepts if (plane := p.ground_plane_in_sole) is not None]
    values = np.array([(plane.height, *plane.slope, plane.residual) for plane in planes]).reshape(-1, 4)
    inliers = np.array([plane.inliers for plane in planes]).reshape(-1, len(layout))
    wrong = ~np.isfinite(values).all(axis=1) | ~inliers.any(axis=1)
    check("Percept.ground_plane_in_sole: finite", block, wrong)
    height, slope = 0.02, block.rng.uniform(-0.1, 0.1, 2)
    if np.abs(layout.positions[:, 2]).max() == 0.0 and len(layout) > 3:
        local = layout.positions[:, :2] - layout.positions[0, :2]
        missed = []
        for _ in range(0, len(block), 25):
            reading = height + 0.1 * (local @ slope)
            reading[int(block.rng.integers(len(layout)))] = np.nan
            plane = ground_plane.fit_ground_plane(layout, reading)
            assert plane is not None
            level = plane.height_at(layout.positions[:, :2])
            missed.append(float(np.abs(level - height - 0.1 * (local @ slope)).max()) if plane.directions == 2 else 0.0)
        check("fit_ground_plane: finds a plane", block, missed, 1e-9)
    points = ground_plane.ground_points(layout, block.proximity)
    lost = np.isnan(points).any(axis=2) != ~np.isfinite(block.proximity)
    check("ground_points", block, lost.any(axis=1))


def _switches(block: Block) -> None:
    """The sole wrench's switch reading by reading as over frames, and the early stop."""
    contact = np.array([p.wrench_in_sole for p in block.percepts])
    contact[:: max(1, len(block) // 7)] = np.nan
    virtual = virtual_wrench.virtual_ground_reaction_wrench(block.layout, block.proximity, _GAIN)
    frames = virtual_wrench.sole_wrenches(contact, virtual, 30.0, 10.0)
    switch = virtual_wrench.SoleWrenchSwitch(30.0, 10.0)
    one = np.array([switch.update(c, v) for c, v in zip(contact, virtual, strict=True)])
    check("sole_wrenches as SoleWrenchSwitch", block, (frames != one).any(axis=1))
    check("sole_wrenches: no NaN", block, np.where(np.isfinite(frames), 0.0, np.nan).max(axis=1))
    stop = virtual_wrench.early_stop(virtual, 1.0)
    length = np.sqrt((virtual[:, :3].astype(np.longdouble) ** 2).sum(axis=1))
    clear = np.abs(length - 1.0) > 1e-12
    check("early_stop", block, clear & (np.asarray(stop) != (length > 1.0)))


def _heat(block: Block) -> None:
    """Warm taxels, their footprint and the wrench away from heat."""
    layout, readings, percepts = block.layout, block.temperature, block.percepts
    level, highest = layout.temperature_threshold, 60.0
    fine = np.isfinite(readings)
    warm = np.where(fine, readings, -math.inf) >= level
    check("warm_taxels", block, (temperature.warm_taxels(readings, level) != warm).any(axis=1))
    excess = np.where(warm, np.minimum(np.where(fine, readings, 0.0), highest) - level, 0.0)
    got = temperature.temperature_measure(readings, level, highest)
    check("temperature_measure", block, np.abs(got - excess).max(axis=1) / highest, 1e-15)
    normal = layout.rotations[:, :, 2]
    columns = np.hstack([normal, np.cross(layout.positions, normal)])
    scale = excess @ np.abs(columns) + 1e-300
    wrenches = temperature.temperature_wrench(layout, readings)
    check("temperature_wrench", block, (np.abs(wrenches - excess @ columns) / scale).max(axis=1), 1e-14)
    seen = [i for i in range(len(block)) if i % 16]
    own = np.array([percepts[i].temperature_wrench_in_sole for i in seen])
    check(
        "Percept.temperature_wrench_in_sole",
        block,
        (np.abs(own - wrenches[seen]) / scale[seen]).max(axis=1),
        1e-14,
    )
    found = [percepts[i].temperature_footprint_in_sole for i in seen]
    check("Percept.temperature_footprint_in_sole: convex", block, [not strictly_convex(f) for f in found])
    empty = np.array([len(f) > 0 for f in found]) != warm[seen].any(axis=1)
    check("Percept.temperature_footprint_in_sole: empty", block, empty)
    missing = [percepts[i].temperature_wrench_in_sole is not None for i in range(0, len(block), 16)]
    check("Percept: None where a modality is missing", block, missing)
    turned = [percepts[i].acceleration_in_sole for i in seen]
    wanted = np.einsum("nij,knj->kni", layout.rotations, block.acceleration[seen])
    both = np.array(turned, dtype=float)
    error = np.where(np.isnan(wanted), 0.0, np.abs(np.where(np.isnan(both), math.inf, both) - np.nan_to_num(wanted)))
    check("Percept.acceleration_in_sole", block, error.max(axis=(1, 2)), 1e-12)


def _skin(block: Block) -> None:
    """Pseudo-forces, patch signals and wrenches of skin cells."""
    layout = block.layout
    forces = np.clip(block.force, -1e12, 1e12)
    active = body_skin.active_cells(forces, block.proximity, 1.0, 0.02)
    alive = [np.abs(values) <= 1e100 for values in (forces, block.proximity)]  # 1e300 is no signal either
    one, two = (np.where(is_alive, v, 0.0) for is_alive, v in zip(alive, (forces, block.proximity), strict=True))
    wanted = (alive[0] & (one > 1.0)) | (alive[1] & (two > 0.02))
    check("active_cells", block, (active != wanted).any(axis=1))
    pseudo = body_skin.pseudo_force(forces, block.proximity, 2.0, 0.5, active)
    right = np.where(wanted, 2.0 * one + 0.5 * two, 0.0)
    check("pseudo_force", block, (np.abs(pseudo - right) / (np.abs(right) + 1e-300)).max(axis=1), 1e-15)
    mixed = body_skin.patch_signal(forces, block.proximity, 0.25)
    right = 0.25 * one + 0.75 * two
    size = 0.25 * np.abs(one) + 0.75 * np.abs(two) + 1e-300
    check("patch_signal", block, (np.abs(mixed - right) / size).max(axis=1), 1e-15)
    wrenches = body_skin.skin_wrench(layout.positions, layout.rotations, one)
    normal = layout.rotations[:, :, 2]
    columns = np.hstack([normal, np.cross(layout.positions, normal)])
    scale = np.abs(one) @ np.abs(columns) + 1e-300
    check("skin_wrench", block, (np.abs(wrenches - one @ columns) / scale).max(axis=1), 1e-14)


FIELD_CHECKS = (_near_ground, _plane_of_ground, _switches, _heat, _skin)
"""The checks of this module, each a function of a block."""
