"""Checks of the sums over forces, the activation, the faults, the points of balance, and the batch functions."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from plantar import batch
from plantar.bench import references as exact
from plantar.mechanics import zmp
from plantar.mechanics.lip import divergent_component
from plantar.mechanics.wrench import wrench_at
from plantar.percepts import sole_pose
from plantar.percepts.feet import FeetPercept
from plantar.percepts.foot_tick import walking_tick
from plantar.percepts.percept import Percept
from plantar.percepts.percept_options import PerceptOptions
from plantar.percepts.sole_pose import SolePose
from plantar.sensing import activation, force, health

from .soles import Block, check, differing, not_finite, unit_wrenches

__all__ = ["FORCE_CHECKS"]

Array = NDArray[np.float64]
_SUM = 1e-14
"""Allowed error of a sum of up to 51 terms, over the sum of their absolute values."""


def _error(got: Array, wanted: Array, scale: Array) -> Array:
    return np.asarray((np.abs(got - wanted) / np.where(scale > 0.0, scale, 1.0)).max(axis=-1))


def _points(rows: Array) -> list[Array | None]:
    """The rows (n, 2) as the percepts give them: None for one that is NaN."""
    missing: list[bool] = np.asarray(np.isnan(rows).all(axis=1)).tolist()
    return [None if none else row for row, none in zip(rows, missing, strict=True)]


def _percept_loads(block: Block) -> None:
    """Active taxels, wrench, area and CoP of each percept against sums in extended precision and `math.fsum`."""
    percepts = block.percepts
    active = np.array([p.active for p in percepts])
    check("Percept.active", block, (active != block.active).any(axis=1))
    wanted, scale = block.wrenches
    got = np.array([p.wrench_in_sole for p in percepts])
    check("Percept.wrench_in_sole", block, _error(got, wanted, scale), _SUM)
    rows, columns = range(0, len(block), 100), unit_wrenches(block.layout)
    right = np.array([exact.wrench_exact(columns, np.where(active[i], block.force[i], 0.0)) for i in rows])
    check("Percept.wrench_in_sole: math.fsum", block, _error(got[::100], right, scale[::100]), _SUM)
    vertical = np.array([p.vertical_force for p in percepts])
    check("Percept.vertical_force", block, _error(vertical[:, None], wanted[:, 2:3], scale[:, 2:3]), _SUM)
    areas = np.array([math.fsum(block.layout.areas[row]) for row in active])
    got_area = np.array([p.contact_area for p in percepts])
    check("Percept.contact_area", block, _error(got_area[:, None], areas[:, None], areas[:, None]), _SUM)
    kept = np.array([p.active_force for p in percepts])
    check("Percept.active_force", block, (kept != np.where(block.active, block.force, 0.0)).any(axis=1))
    cops = [p.position_cop_in_sole for p in percepts]
    loaded = wanted[:, 2] > 0.0
    check(
        "Percept.position_cop_in_sole: None without load",
        block,
        [(c is None) == bool(k) for c, k in zip(cops, loaded, strict=True)],
    )
    place = np.array([np.zeros(2) if c is None else c for c in cops])
    weights = (kept * block.layout.rotations[:, 2, 2]).astype(np.longdouble)
    total = np.where(loaded, weights.sum(axis=1), 1.0)
    truth = np.asarray((weights @ block.layout.positions[:, :2]) / total[:, None], dtype=float)
    reach = float(np.abs(block.layout.positions[:, :2]).max()) + 1e-9
    error = np.where(loaded, np.abs(place - truth).max(axis=1) / reach, 0.0)
    check("Percept.position_cop_in_sole", block, error, 1e-13)
    direct = [force.center_of_pressure(block.layout, k, 0.0) for k in kept]
    near = np.array([np.zeros(2) if c is None else c for c in direct])
    check("center_of_pressure", block, np.where(loaded, np.abs(near - truth).max(axis=1) / reach, 0.0), 1e-13)
    whole = force.ground_reaction_wrench(block.layout, kept, 0.0)
    check("ground_reaction_wrench", block, _error(whole, wanted, scale), _SUM)
    one = [force.ground_reaction_wrench(block.layout, k, 0.0) for k in kept[::16]]
    check(
        "ground_reaction_wrench: batch as scalar",
        block,
        _error(whole[::16], np.array(one), scale[::16]),
        _SUM,
    )


def _percept_faults(block: Block) -> None:
    """Faults, filling, and activation with and without memory."""
    percepts, layout, given = block.percepts, block.layout, block.force
    faulty = np.array([p.health.faulty for p in percepts])
    wanted = ~np.isfinite(given) | (np.nan_to_num(given, nan=-1.0, posinf=-1.0) >= layout.force_limit)
    check("Percept.health", block, (faulty != wanted).any(axis=1))
    sound = np.array([p.sound_force for p in percepts])
    check("Percept.sound_force", block, (np.isnan(sound) != wanted).any(axis=1))
    mask = activation.active_taxels(given, layout.force_threshold, layout.force_limit)
    check("active_taxels", block, (mask != block.active).any(axis=1))
    high, limit = layout.force_threshold, layout.force_limit
    flags = activation.hysteresis(given, high, 0.5 * high, saturation=limit)
    memory = activation.TaxelActivation(high, 0.5 * high, limit)
    states = np.array([memory.update(f) for f in given])
    check("hysteresis as TaxelActivation", block, (flags != states).any(axis=1))
    state = np.zeros(len(layout), dtype=bool)
    slow = []
    for row in np.where(np.isfinite(given), given, -math.inf):
        state = (row < limit) & ((row > high) | (state & (row > 0.5 * high)))
        slow.append(state)
    check("TaxelActivation", block, (states != np.array(slow)).any(axis=1))
    times = 0.3 * np.arange(len(block))
    stuck = health.stuck_taxels(times, given, hold=0.5)
    monitor = health.StuckMonitor(hold=0.5)
    live = np.array([monitor.update(float(t), f) for t, f in zip(times, given, strict=True)])
    check("stuck_taxels as StuckMonitor", block, (stuck != live).any(axis=1))
    filled = health.fill_from_neighbours(layout, given, wanted, per_area=True)
    bad = np.isnan(filled) & ~wanted
    with np.errstate(over="ignore"):  # 1e300 N on a tiny cell
        finite = np.where(np.isfinite(given) & ~wanted, given / layout.areas, -math.inf).max(axis=1)
    high_fill = np.where(wanted & np.isfinite(filled), filled / layout.areas, -math.inf).max(axis=1)
    check(
        "fill_from_neighbours",
        block,
        bad.any(axis=1) | (high_fill > np.where(finite < 0.0, finite * (1.0 - 1e-12), finite * (1.0 + 1e-12))),
    )
    one = [
        health.fill_from_neighbours(layout, *pair, per_area=True)
        for pair in zip(given[::25], wanted[::25], strict=True)
    ]
    wrong = differing(one, list(filled[::25]), equal_nan=True)
    check("fill_from_neighbours: batch as scalar", block, wrong)
    options = PerceptOptions(fill=True)
    sums = np.array([Percept(layout, reading, options=options).wrench_in_sole for reading in block.readings])
    check("Percept(fill=True).wrench_in_sole", block, np.where(np.isfinite(sums), 0.0, np.nan).max(axis=1))


def _batch_functions(block: Block) -> None:
    """The batch functions against the percepts, reading by reading."""
    layout, percepts = block.layout, block.percepts
    wanted, scale = block.wrenches
    check("batch.wrenches", block, _error(batch.wrenches(layout, block.force), wanted, scale), _SUM)
    strided = np.repeat(block.force, 2, axis=0)[::2][::-1]
    check("batch.wrenches: strided", block, _error(batch.wrenches(layout, strided)[::-1], wanted, scale), _SUM)
    sums = batch.loads(layout, block.force)
    check("batch.loads: wrench", block, _error(sums.wrench, wanted, scale), _SUM)
    area = np.array([p.contact_area for p in percepts])
    check("batch.loads: area", block, sums.contact_area != area)
    check(
        "batch.loads: CoP",
        block,
        differing(_points(sums.center_of_pressure), [p.position_cop_in_sole for p in percepts], equal_nan=True),
    )
    hulls = batch.support_polygons(layout, block.force, vertices=True)
    check("batch.support_polygons: area", block, hulls.area != np.array([p.support_area for p in percepts]))
    check(
        "batch.support_polygons: centroid",
        block,
        differing(_points(hulls.centroid), [p.centroid_in_sole for p in percepts], equal_nan=True),
    )
    assert hulls.vertices is not None
    ends = np.cumsum(hulls.size)
    parts = np.split(hulls.vertices, ends[:-1])
    wrong = differing(parts, [p.support_polygon_in_sole for p in percepts])
    check("batch.support_polygons: vertices", block, wrong)
    ground = batch.ground_planes(layout, block.proximity)
    fitted = zip(ground.directions.tolist(), ground.height.tolist(), ground.slope.tolist(), strict=True)
    wrong = [
        i % 16 > 0 and (directions != -1 if plane is None else [plane.height, *plane.slope] != [height, *slope])
        for i, (plane, (directions, height, slope)) in enumerate(
            zip((p.ground_plane_in_sole for p in percepts), fitted, strict=True)
        )
    ]
    check("batch.ground_planes", block, wrong)
    bare = batch.support_polygons(layout, block.force)
    check("batch.support_polygons: without vertices", block, bare.area != hulls.area)


def _walking_tick(block: Block) -> None:
    """What a tick makes of a reading in one call, against the percept's members, to the last bit."""
    layout = block.layout
    offsets = block.rng.choice([0.0, 1e-6, 0.005, 0.02, 1.0], len(block)).tolist()
    middle = layout.positions[:, :2].mean(axis=0)
    ticks = [walking_tick(layout, row, middle, offset) for row, offset in zip(block.force, offsets, strict=True)]
    percepts = block.percepts
    wrong = np.array(
        [
            (t.contact_area, t.support_area) != (p.contact_area, p.support_area)
            for t, p in zip(ticks, percepts, strict=True)
        ]
    )
    wrong |= differing([t.support_polygon for t in ticks], [p.support_polygon_in_sole for p in percepts])
    wrong |= differing([t.wrench for t in ticks], [p.wrench_in_sole for p in percepts])
    wrong |= differing([t.active for t in ticks], [p.active for p in percepts])
    wrong |= differing([t.position_cop for t in ticks], [p.position_cop_in_sole for p in percepts], equal_nan=True)
    wrong |= differing([t.centroid for t in ticks], [p.centroid_in_sole for p in percepts], equal_nan=True)
    check("walking_tick", block, wrong)
    lost = np.array(
        [(t.clamped is None) != (len(p.support_polygon_in_sole) == 0) for t, p in zip(ticks, percepts, strict=True)]
    )
    lost |= not_finite([(t.safe_polygon, t.clamped) for t in ticks])
    check("walking_tick: no NaN", block, lost)


def _balance_points(block: Block) -> None:
    """Zero moment, pivots and the wrench of two feet, also with the soles 1e6 m away."""
    percepts = block.percepts
    wrenches = np.array([p.wrench_in_sole for p in percepts])
    at = block.pose.position_in_world
    turn = block.pose.rotation_sole_to_world
    zero = [p.zero_moment_wrench_in_sole for p in percepts]
    loaded = np.array([z is not None for z in zero])
    check("Percept.zero_moment_wrench_in_sole: None without load", block, loaded != (wrenches[:, 2] > 0.0))
    place = np.array([np.zeros(3) if z is None else z[0] for z in zero])
    about = np.array([np.zeros(6) if z is None else z[1] for z in zero])
    back = about + np.hstack([np.zeros((len(block), 3)), np.cross(place, about[:, :3])])
    size = np.abs(wrenches).max(axis=1, keepdims=True) + 1e-300
    moments = np.where(loaded[:, None], np.abs(back - wrenches) / size, 0.0).max(axis=1)
    check("Percept.zero_moment_wrench_in_sole", block, moments, 1e-12)
    there = wrench_at(wrench_at(wrenches, at), -at)
    far = size * (1.0 + float(np.abs(at).max()))
    check("wrench_at: there and back", block, _error(there, wrenches, far), 1e-14)
    points = [zmp.zmp_in_plane(w, float(at[2])) for w in wrenches]
    check("zmp_in_plane", block, not_finite(points))
    flat_points = [zmp.zmp_of_wrench(w) for w in wrenches]
    check("zmp_of_wrench", block, not_finite(flat_points))
    pressed = np.array([p.pressure_driven_wrench_in_sole for p in percepts])
    area = np.array([p.contact_area for p in percepts])[:, None]
    right = np.where(area > 0.0, wrenches * block.layout.cell_area / np.where(area > 0.0, area, 1.0), 0.0)
    check(
        "Percept.pressure_driven_wrench_in_sole",
        block,
        _error(pressed, right, np.abs(right).max(axis=1, keepdims=True)),
        1e-12,
    )
    frames = force.pressure_driven_wrench(block.layout, block.force, block.layout.cell_area)
    check("pressure_driven_wrench", block, _error(frames, right, np.abs(right).max(axis=1, keepdims=True) * 1e2), _SUM)
    world = block.pose.wrench_to_world(wrenches)
    moved = np.cross(at, wrenches[:, :3] @ turn.T)
    scale = np.abs(wrenches).max(axis=1, keepdims=True) * (1.0 + float(np.abs(at).max())) + 1e-300
    truth = np.hstack([wrenches[:, :3] @ turn.T, wrenches[:, 3:] @ turn.T + moved])
    check("SolePose.wrench_to_world", block, _error(world, truth, scale), 1e-14)
    other = SolePose.flat(at[0] + 0.02, at[1] + 0.2, at[2])
    total = sole_pose.wrench_of_feet([wrenches, wrenches], [block.pose, other])
    check("wrench_of_feet", block, _error(total, world + other.wrench_to_world(wrenches), scale), 1e-14)
    pairs = range(0, len(block) - 1, 2)  # a reading each foot
    both = [sole_pose.zmp_of_soles(list(wrenches[i : i + 2]), [block.pose, other], float(at[2]), 0.0) for i in pairs]
    cops = [p.position_cop_in_sole for p in percepts]
    place = np.array([np.zeros(3) if c is None else [*c, 0.0] for c in cops])
    weight = np.where(wrenches[:, 2] > 0.0, wrenches[:, 2], 0.0)[:, None]
    here = weight[pairs.start : pairs.stop : 2] * block.pose.to_world(place[pairs.start : pairs.stop : 2])
    there = weight[1::2] * other.to_world(place[1::2])
    total = weight[pairs.start : pairs.stop : 2] + weight[1::2]
    middle = ((here + there) / np.where(total > 0.0, total, 1.0))[:, :2]
    found = np.array([np.zeros(2) if z is None else z for z in both]).reshape(-1, 2)
    missing = np.array([z is None for z in both]) != (total[:, 0] <= 0.0)
    flat = np.abs(block.layout.positions[:, 2]).max() == 0.0
    gap = np.abs(found - middle).max(axis=1) if flat else np.zeros(len(found))
    error = np.where(missing, np.inf, gap / (1.0 + float(np.abs(at).max())))
    check("zmp_of_soles", block, error, 1e-9)
    com = at + np.array([0.0, 0.0, 0.8])
    pivot = [zmp.centroidal_moment_pivot(w, com, float(at[2])) for w in world]
    check("centroidal_moment_pivot", block, not_finite(pivot))
    dcm = divergent_component(np.broadcast_to(com, (len(block), 3)), world[:, :3] * 0.0 + 0.5, 3.5)
    check("divergent_component", block, np.abs(dcm - com - 0.5 / 3.5).max(axis=1) / float(np.abs(com).max()), 1e-15)
    composite = [zmp.zmp_of_feet([c, c], [0.0, 0.0] if c is None else [1.0, 2.0]) for c in cops]
    there_is = np.array([a is not None and b is not None for a, b in zip(composite, cops, strict=True)])
    found = np.array([np.zeros(2) if c is None else c for c in composite])
    off = np.where(there_is, np.abs(found - place[:, :2]).max(axis=1), 0.0)
    check("zmp_of_feet", block, off / (1.0 + np.abs(block.layout.positions).max()), 1e-14)
    turns = block.rng.normal(size=(6, 5))
    torque = force.joint_torque(turns, turn, wrenches)
    loads = np.hstack([wrenches[:, :3] @ turn.T, wrenches[:, 3:] @ turn.T])
    check("joint_torque", block, _error(torque, loads @ turns, np.abs(loads) @ np.abs(turns) + 1e-300), 1e-14)


def _two_feet(block: Block) -> None:
    """Every member of what two feet feel together."""
    at = block.pose.position_in_world
    poses = [block.pose, SolePose.flat(at[0], at[1] + 0.3, at[2])]
    members = [n for n in dir(FeetPercept) if not n.startswith("_")]
    rows = range(0, len(block), 2)  # a reading each foot
    feet = [FeetPercept([block.percepts[i], block.percepts[i - 1]], poses, float(at[2])) for i in rows]
    wrong = [not_finite([getattr(f, m) for f in feet]) for m in members]
    check("FeetPercept: every member", block, np.any(wrong, axis=0))


def _every_member(block: Block) -> None:
    """No member of a percept is NaN, but where the acceleration or the sound force says that a taxel is dead."""
    spared = {"acceleration_in_sole", "sound_force", "outline_rectangle_any_angle_in_sole", "health", "active", "near"}
    for member in Percept.members():
        if member not in spared:
            wrong = not_finite([getattr(p, member) for p in block.percepts])
            check(f"Percept.{member}: no NaN", block, wrong)


FORCE_CHECKS: tuple[Callable[[Block], None], ...] = (
    _percept_loads,
    _percept_faults,
    _batch_functions,
    _walking_tick,
    _balance_points,
    _two_feet,
    _every_member,
)
"""The checks of this module, each a function of a block."""
