"""`plantar bench kernels`: the kernels of perception next to shapely and numpy."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar import batch
from plantar.bench.comparison import Reference, Route, compare
from plantar.bench.kind import BenchOptions, Case, Finding, Kind, PageTable, Row
from plantar.bench.tables import Mark, draw_errors
from plantar.geometry import enclosing, polygon
from plantar.geometry.outline import concave_outline
from plantar.layouts.hex_lattice import HexLattice
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout
from plantar.percepts.feet import FeetPercept
from plantar.percepts.foot_tick import walking_tick
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import SolePose
from plantar.plotting import new_figure, save_figure
from plantar.sensing.reading import Reading

Array = NDArray[np.float64]

_OFFSET = 0.01  # m, of the inner offset
_AIM = np.array([0.09, 0.06])  # point in m that a tick clamps to the offset polygon
_PATCHES = 12  # contacts of each size
_FRAMES = 20_000  # of a recording
_OUTLINE = ((-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1))  # m: around all cells
_SIZES = {"5 active": (691e-6, 5), "20 active": (691e-6, 20), "51 active": (691e-6, 51), "1000 cells": (35e-6, 850)}
"""Area of a cell in m^2, and how many cells are active."""


class _Contact(NamedTuple):
    """A sole with a patch of active taxels, and the patch's corner points (v, 2) and cells in m."""

    layout: SoleLayout
    active: NDArray[np.bool_]
    force: Array
    points: Array
    cells: list[Array]


@cache
def _sole(cell_area: float) -> SoleLayout:
    """Whole hexagons on a sole of about 260 x 155 mm, rounded."""
    lattice = HexLattice(cell_area)
    cells = lattice.cells_near(np.array([-0.15, -0.1]), np.array([0.15, 0.1]))
    centres = np.abs(lattice.centres(cells)) / (0.135, 0.081)
    return hex_layout(_OUTLINE, cell_area=cell_area, cells=cells[(centres**2.8).sum(axis=1) < 1.0])


def _contacts(size: str, seed: int = 0) -> list[_Contact]:
    cell_area, count = _SIZES[size]
    layout = _sole(cell_area)
    rng = np.random.default_rng(seed)
    return [_contact(layout, count, rng) for _ in range(_PATCHES)]


def _contact(layout: SoleLayout, count: int, rng: np.random.Generator) -> _Contact:
    centre = layout.positions[rng.integers(len(layout)), :2]
    distance = np.hypot(*(layout.positions[:, :2] - centre).T)
    active = np.isin(np.arange(len(layout)), np.argsort(distance, kind="stable")[:count])
    force = np.where(active, rng.uniform(3.0, 60.0, len(layout)), 0.0)
    used = np.unique(layout.corner_vertex[np.repeat(active, np.diff(layout.corner_start))])
    cells = [layout.cell_polygon(int(i)) for i in np.flatnonzero(active)]
    return _Contact(layout, active, force, np.ascontiguousarray(layout.vertices[used, :2]), cells)


def _pair(ours: Route, other: Route) -> tuple[list[Route], Reference]:
    """Two routes to one value, ours first, and the other's values as the reference."""
    values = [np.asarray(other.value(other.call(case)), dtype=float) for case in other.cases]
    return [ours, other], Reference(values, [float(np.abs(v).max()) or 1.0 for v in values])


def _hull(size: str) -> tuple[list[Route], Reference]:
    found = _contacts(size)
    layout = found[0].layout
    ours = Route("plantar, from active taxels", layout.kernel.hull, [c.active for c in found], lambda r: r[1], True)
    return _pair(ours, Route("shapely convex_hull", _hull_of_points, [c.points for c in found]))


def _hull_of_points(points: Array) -> float:
    return float(shapely.area(shapely.convex_hull(shapely.multipoints(points))))


def _outline(size: str) -> tuple[list[Route], Reference]:
    found = _contacts(size)
    layout = found[0].layout
    ours = Route("plantar", lambda a: concave_outline(layout, a).area, [c.active for c in found], ours=True)
    other = Route(
        "shapely coverage_union_all",
        lambda cells: shapely.coverage_union_all(shapely.polygons(cells)).area,
        [c.cells for c in found],
    )
    return _pair(ours, other)


def _closest(size: str) -> tuple[list[Route], Reference]:
    rng = np.random.default_rng(1)
    hulls = [polygon.convex_hull(c.points) for c in _contacts(size)]
    cases = [(hull, hull.mean(axis=0) + rng.uniform(-0.15, 0.15, 2)) for hull in hulls]
    ours = Route("plantar", lambda case: polygon.closest_point(*case), cases, ours=True)
    return _pair(ours, Route("shapely shortest_line", _closest_by_shapely, cases))


def _closest_by_shapely(case: tuple[Array, Array]) -> Array:
    line = shapely.shortest_line(shapely.Polygon(case[0]), shapely.Point(case[1]))
    return np.asarray(shapely.get_coordinates(line)[0])


_OF_A_HULL: Mapping[str, tuple[Callable[[Array], Any], Callable[[Any], float], str, Callable[[Array], float]]] = {
    "inner offset": (
        lambda h: polygon.inner_offset(h, _OFFSET),
        lambda ring: abs(polygon.area(ring)),
        "shapely buffer, mitred",
        lambda h: shapely.buffer(shapely.Polygon(h), -_OFFSET, join_style="mitre").area,
    ),
    "box around, any angle": (
        enclosing.oriented_box,
        lambda ring: abs(polygon.area(ring)),
        "shapely oriented_envelope",
        lambda h: shapely.oriented_envelope(shapely.Polygon(h)).area,
    ),
}
"""Kernels of a convex polygon: ours, its value, and the library's."""


def _of_a_hull(kernel: str, size: str) -> tuple[list[Route], Reference]:
    call, value, name, library = _OF_A_HULL[kernel]
    hulls = [polygon.convex_hull(c.points) for c in _contacts(size)]
    ours = Route("plantar", call, hulls, value, ours=True)
    return _pair(ours, Route(name, library, hulls))


def _tick(size: str) -> tuple[list[Route], Reference]:
    found = _contacts(size)
    layout = found[0].layout
    forces = [c.force for c in found]
    ours = Route("plantar", lambda f: walking_tick(layout, f, _AIM, _OFFSET), forces, _tick_values, ours=True)
    return _pair(ours, Route("shapely + numpy", partial(_tick_by_shapely, layout), forces))


def _tick_values(tick: Any) -> Array:
    return np.concatenate([tick.position_cop, tick.wrench[2:5], [tick.support_area], tick.centroid, tick.clamped])


def _tick_by_shapely(layout: SoleLayout, force: Array) -> Array:
    active = force > layout.force_threshold
    kept = np.where(active, force, 0.0)
    used = np.unique(layout.corner_vertex[np.repeat(active, np.diff(layout.corner_start))])
    hull = shapely.convex_hull(shapely.multipoints(layout.vertices[used, :2]))
    middle = shapely.get_coordinates(shapely.centroid(hull))[0]
    safe = shapely.buffer(hull, -_OFFSET, join_style="mitre")
    clamped = shapely.get_coordinates(shapely.shortest_line(safe, shapely.Point(_AIM)))[0]
    cop = kept @ layout.positions[:, :2] / kept.sum()
    return np.concatenate([cop, (layout.wrench_map @ kept)[2:5], [hull.area], middle, clamped])


def _percept(size: str) -> tuple[list[Route], Reference | None]:
    found = _contacts(size)
    layout = found[0].layout
    poses = [SolePose.flat(0.0, 0.1), SolePose.flat(0.05, -0.1, yaw=0.1)]
    of_feet = [name for name in dir(FeetPercept) if not name.startswith("_")]

    def every_member(force: Array) -> None:
        feet = [Percept(layout, Reading(0.0, force)) for _ in poses]
        for foot in feet:
            for member in Percept.members():
                getattr(foot, member)
        both = FeetPercept(feet, poses)
        for member in of_feet:
            getattr(both, member)

    forces = [c.force for c in found]
    none = Route("plantar, no member", lambda f: [Percept(layout, Reading(0.0, f)) for _ in poses], forces, ours=True)
    return [Route("plantar, every member of both feet", every_member, forces, ours=True), none], None


def _recording(size: str) -> tuple[list[Route], Reference]:
    layout = _sole(_SIZES["20 active"][0])
    force = np.random.default_rng(4).gamma(0.6, 12.0, (_FRAMES, len(layout)))
    columns = np.ascontiguousarray(layout.wrench_map.T)
    level = layout.force_threshold
    ours = Route("plantar", lambda f: batch.wrenches(layout, f), [force], ours=True)
    return _pair(ours, Route("numpy where, @", lambda f: np.where(f > level, f, 0.0) @ columns, [force]))


_KERNELS: Mapping[str, tuple[Callable[[str], tuple[list[Route], Reference | None]], tuple[str, ...]]] = {
    "hull + area": (_hull, tuple(_SIZES)),
    "concave outline": (_outline, tuple(_SIZES)),
    "closest point": (_closest, tuple(_SIZES)),
    **{kernel: (partial(_of_a_hull, kernel), tuple(_SIZES)) for kernel in _OF_A_HULL},
    "walking tick": (_tick, ("20 active",)),
    "percept": (_percept, ("20 active",)),
    "wrench of a recording": (_recording, (f"{_FRAMES} frames",)),
}
"""What makes the routes of each kernel, and the sizes that are measured."""


def _cases(options: BenchOptions) -> list[Case]:
    rounds = 3 if options.quick else 9
    return [
        Case((kernel, size), partial(_measure, kernel, size, rounds))
        for kernel, (_, sizes) in _KERNELS.items()
        for size in sizes
    ]


def _measure(kernel: str, size: str, rounds: int) -> list[Row]:
    routes, reference = _KERNELS[kernel][0](size)
    results = compare(kernel, size, routes, reference, rounds)
    # The library's answer is the reference: it has no error of its own here.
    return [asdict(r) if r.ours else asdict(r) | {"error": None} for r in results]


def _find(rows: Sequence[Row], options: BenchOptions) -> Finding:
    lines = [(r["kernel"], r["size"], r["route"], r["median_us"], r["spread"], r["ratio"], r["error"]) for r in rows]
    head = ("kernel", "size", "route", "median [us]", "spread", "ratio", "error")
    return Finding({"results": list(rows)}, [PageTable("Kernels", head, lines)], draw=partial(_draw, rows))


def _draw(rows: Sequence[Row], path: Path) -> None:
    figure, axis = new_figure(8.0, 5.0)
    marks = [Mark(r["median_us"], r["error"], r["kernel"], text=r["size"]) for r in rows if r["error"] is not None]
    labels = ("Kernels of perception: 0 is drawn at 1e-17", "median time of a call [us]", "relative error [-]")
    draw_errors(axis, marks, labels, 1e-17)
    axis.legend(fontsize=7)
    save_figure(figure, path)


KERNELS = Kind(
    page="kernels",
    title="Kernels of perception: run time against error",
    lead=(
        "Each kernel next to the library call that gives the same answer. A time is the median of a call; both routes\n"
        "take turns, so ratios are reliable where times depend on the machine. An error is relative, against the\n"
        "library's answer."
    ),
    table="kernels.csv",
    keys=("kernel", "size"),
    columns=("route", "ours", "approximate", "median_us", "spread", "ratio", "error"),
    cases=_cases,
    find=_find,
    resumes=False,
)
"""`plantar bench kernels`."""
