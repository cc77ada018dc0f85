"""Run time of a tick, a whole percept, wrenches and recordings."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import references as exact
import shapely
from kernel_rivals import Corners, hull_shapely
from kernel_shapes import OFFSET
from numpy.typing import NDArray
from sample_soles import contacts, sole_of

from plantar import batch
from plantar.bench.comparison import Reference, Result, Route, compare
from plantar.geometry import polygon
from plantar.kernels import compiled, python_form
from plantar.layouts.layout import SoleLayout
from plantar.percepts.feet import FeetPercept
from plantar.percepts.foot_tick import walking_tick
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import SolePose
from plantar.sensing.reading import Reading

Array = NDArray[np.float64]

FRAMES = 100_000
"""Frames of the recording that is measured."""

TAXELS = 102
"""Taxels of a frame: two soles of 51, side by side."""

_AIM = np.array([0.09, 0.06])  # Point in m that a tick clamps to the offset polygon


def compare_percepts(rounds: int = 9) -> Iterator[tuple[str, list[Result]]]:
    """Yields names of tick, percepts and both feet's wrenches, and routes' results."""
    left = sole_of(51)
    right = sole_of(51, "right")
    pairs = [(a.force, b.force) for a, b in zip(contacts("20", 1), contacts("20", 2), strict=True)]
    feet = (left, right)
    tools = tuple(_Assembled(s) for s in feet)
    poses = [SolePose.flat(0.0, 0.1), SolePose.flat(0.05, -0.1, yaw=0.1)]
    rng = np.random.default_rng(3)
    full = [
        [Reading(0.0, f, rng.uniform(0.0, 0.06, 51), rng.uniform(20.0, 40.0, 51), rng.normal(size=(51, 3))) for f in p]
        for p in pairs
    ]
    ticks = [
        Route("plantar", lambda p: [_tick(s, f) for s, f in zip(feet, p, strict=True)], pairs, _flat, ours=True),
        Route(
            "plantar, percepts",
            lambda p: [_tick_of_percept(s, f) for s, f in zip(feet, p, strict=True)],
            pairs,
            _flat,
            ours=True,
        ),
        Route("shapely + numpy", lambda p: [t.tick(f) for t, f in zip(tools, p, strict=True)], pairs, _flat),
    ]
    yield "walking tick", compare("walking tick", "both feet, 20 active", ticks, _ticks_exact(feet, pairs), rounds)
    forces = [np.concatenate(p) for p in pairs]
    columns = [_columns(s) for s in feet]
    maps = [s.wrench_map for s in feet]
    wrenches = [
        Route("plantar", lambda f: _wrenches(feet, f), forces, ours=True),
        Route("numpy, M @ f", lambda f: [maps[0] @ f[:51], maps[1] @ f[51:]], forces),
    ]
    truth = [
        np.array([exact.wrench_exact(c, f) for c, f in zip(columns, (g[:51], g[51:]), strict=True)]) for g in forces
    ]
    yield "wrench", compare("wrench", "2 x 51 taxels", wrenches, Reference(truth), rounds)
    members = [
        Route("plantar, every member", partial(_read_all, feet, poses), full, ours=True),
        Route("plantar, members not read", partial(_read_none, feet), full, ours=True),
    ]
    yield "percept", compare("percept", "both feet, 20 active", members, None, rounds)


def _tick(layout: SoleLayout, force: Array) -> tuple[Any, ...]:
    t = walking_tick(layout, force, _AIM, OFFSET)
    return t.active, t.position_cop, t.wrench, t.support_area, t.centroid, abs(polygon.area(t.safe_polygon)), t.clamped


def _tick_of_percept(layout: SoleLayout, force: Array) -> tuple[Any, ...]:
    foot = Percept(layout, Reading(0.0, force))
    safe = polygon.inner_offset(foot.support_polygon_in_sole, OFFSET)
    return (
        foot.active,
        foot.position_cop_in_sole,
        foot.wrench_in_sole,
        foot.support_area,
        foot.centroid_in_sole,
        abs(polygon.area(safe)),
        polygon.closest_point(safe, _AIM),
    )


class _Assembled:
    def __init__(self, layout: SoleLayout) -> None:
        self.threshold = layout.force_threshold
        self.map = layout.wrench_map
        self.positions = layout.positions[:, :2]
        self.corners = Corners(layout)

    def tick(self, force: Array) -> tuple[Any, ...]:
        active = force > self.threshold
        kept = np.where(active, force, 0.0)
        points = self.corners.of(active)
        hull = shapely.convex_hull(shapely.multipoints(points))
        middle = shapely.centroid(hull)
        safe = shapely.buffer(hull, -OFFSET, join_style="mitre")
        clamped = shapely.get_coordinates(shapely.shortest_line(safe, shapely.Point(_AIM)))[0]
        return (
            active,
            kept @ self.positions / kept.sum(),
            self.map @ kept,
            hull.area,
            np.array([middle.x, middle.y]),
            safe.area,
            clamped,
        )


def _flat(results: Any) -> Array:
    return np.concatenate(
        [
            np.atleast_1d(np.asarray(v, dtype=float)) / size
            for foot in results
            for v, size in zip(foot, _SIZES, strict=True)
        ]
    )


# Sizes that errors of a tick's results are measured by: mask, CoP in m, wrench in N and N m, areas in m^2, points
_SIZES = (1.0, 0.1, 1e3, 1e-2, 0.1, 1e-2, 0.1)


def _ticks_exact(feet: tuple[SoleLayout, ...], pairs: list[tuple[Array, Array]]) -> Reference:
    """The same by the references; the clamped point on our offset polygon, whose area is compared too."""
    values = []
    for pair in pairs:
        parts = []
        for layout, force in zip(feet, pair, strict=True):
            active = force > layout.force_threshold
            used = np.unique([v for i in np.flatnonzero(active) for v in layout.corners[i]])
            hull = polygon.convex_hull(layout.vertices[used, :2])
            wrench = exact.wrench_exact(_columns(layout), np.where(active, force, 0.0))
            safe = polygon.inner_offset(hull, OFFSET)
            parts.append(
                (
                    active,
                    [-wrench[4] / wrench[2], wrench[3] / wrench[2]],
                    wrench,
                    exact.hull_area_exact(layout.vertices[used, :2]),
                    exact.centroid_exact(hull),
                    exact.inner_offset_area(hull, OFFSET),
                    exact.closest_point_exact(safe, _AIM) if len(safe) > 2 else safe[0],
                )
            )
        values.append(_flat(parts))
    return Reference(values, [1.0] * len(values))


def _columns(layout: SoleLayout) -> Array:
    normal = layout.rotations[:, :, 2]
    return np.hstack([normal, np.cross(layout.positions, normal)])


def _wrenches(feet: tuple[SoleLayout, ...], force: Array) -> list[Array]:
    return [layout.kernel.loads(part, _EVERY)[:6] for layout, part in zip(feet, (force[:51], force[51:]), strict=True)]


_EVERY = np.ones(51, dtype=bool)


def _read_all(feet: tuple[SoleLayout, ...], poses: list[SolePose], readings: list[Reading]) -> None:
    percepts = [Percept(layout, r) for layout, r in zip(feet, readings, strict=True)]
    for percept in percepts:
        for member in _MEMBERS:
            getattr(percept, member)
    both = FeetPercept(percepts, poses)
    for member in _MEMBERS_OF_FEET:
        getattr(both, member)


_MEMBERS = Percept.members()
_MEMBERS_OF_FEET = tuple(n for n in dir(FeetPercept) if not n.startswith("_"))


def _read_none(feet: tuple[SoleLayout, ...], readings: list[Reading]) -> None:
    for layout, r in zip(feet, readings, strict=True):
        Percept(layout, Reading(r.time, r.force, r.proximity, r.temperature, r.acceleration))


def compare_recordings(frames: int = FRAMES, rounds: int = 5) -> Iterator[tuple[str, list[Result]]]:
    """Yields names and routes' results of wrenches and support polygons of `frames`, next to a memory copy.

    `rounds` are those of the median.
    """
    layout = sole_of(TAXELS)
    rng = np.random.default_rng(4)
    force = rng.gamma(0.6, 12.0, (frames, TAXELS))
    target = np.empty_like(force)
    out = np.empty((frames, 6))
    back = np.ascontiguousarray(layout.wrench_map.T)
    level = layout.force_threshold
    routes = [
        Route("plantar", lambda f: batch.wrenches(layout, f, out=out), [force], _few, ours=True),
        Route("plantar, with area and CoP", lambda f: batch.loads(layout, f).wrench, [force], _few, ours=True),
        Route("np.where @", lambda f: np.where(f > level, f, 0.0) @ back, [force], _few),
        Route("BLAS, no threshold", lambda f: f @ back, [force], _few, approximate=True),
        Route("copy of the forces", lambda f: np.copyto(target, f), [force]),
    ]
    columns = _columns(layout)
    truth = np.array([exact.wrench_exact(columns, np.where(row > level, row, 0.0)) for row in force[:_FEW]])
    results = compare("wrench of a recording", f"{frames} x {TAXELS}", routes, Reference([truth]), rounds, most=2.0)
    yield "wrench of a recording", [*results[:-1], replace(results[-1], error=None)]
    part = force[: min(frames, 2000)] * (rng.random((min(frames, 2000), 1)) < 0.9)
    masks = part > level
    corners = Corners(layout)
    points = [corners.of(m) for m in masks[::10]]
    hulls = [
        Route("plantar", lambda f: batch.support_polygons(layout, f).area, [part], lambda a: a[::10], ours=True),
        Route(
            "shapely, a loop", lambda f: [hull_shapely(corners.of(row > level)) for row in f], [part], lambda a: a[::10]
        ),
    ]
    areas = np.array([exact.hull_area_exact(p) if len(p) else 0.0 for p in points])
    yield (
        "hull + area of a recording",
        compare("hull + area of a recording", f"{len(part)} x {TAXELS}", hulls, Reference([areas]), rounds, most=2.0),
    )


_FEW = 50  # Frames whose wrench is compared with the reference


def _few(wrenches: Array) -> Array:
    return wrenches[:_FEW]


def compare_forms(rounds: int = 5) -> Iterator[tuple[str, list[Result]]]:
    """Yields the sole kernel's compiled form next to the interpreted one."""
    if not compiled:
        return
    found = contacts("20")
    layout = found[0].layout
    slow = python_form("sole").SoleKernel(
        layout.positions,
        layout.rotations[:, :, 2],
        layout.areas,
        layout.vertices[:, :2],
        layout.corner_start,
        layout.corner_vertex,
    )
    masks = [c.active for c in found]
    reference = Reference([exact.hull_area_exact(c.points) for c in found])
    routes = [
        Route("compiled", layout.kernel.hull, masks, lambda r: r[1], ours=True),
        Route("interpreted", slow.hull, masks, lambda r: r[1], ours=True),
    ]
    yield "forms: hull + area", compare("forms: hull + area", "20", routes, reference, rounds)
    loads = [(c.force, c.active) for c in found]
    truth = [exact.wrench_exact(_columns(layout), c.force) for c in found]
    routes = [
        Route("compiled", lambda case: layout.kernel.loads(*case), loads, lambda r: r[:6], ours=True),
        Route("interpreted", lambda case: slow.loads(*case), loads, lambda r: r[:6], ours=True),
    ]
    yield "forms: loads", compare("forms: loads", "20", routes, Reference(truth), rounds)
