"""Run time against error of the perception's kernels and other routes."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import kernel_rivals as rivals
import numpy as np
import references as exact
import shapely
from numpy.typing import NDArray
from sample_soles import Contact, contacts

from plantar.bench.comparison import Reference, Result, Route, compare
from plantar.geometry import enclosing, inscribed, polygon
from plantar.geometry.outline import Outline, concave_outline
from plantar.percepts.percept import Percept
from plantar.sensing.reading import Reading

Array = NDArray[np.float64]
Compared = tuple[list[Route], Reference]

OFFSET = 0.01
"""Distance in m of the inner offset that is measured."""


def compare_shapes(size: str, rounds: int = 9) -> Iterator[tuple[str, list[Result]]]:
    """Yields each shape kernel's name and its routes' results.

    `size` is one of `sample_soles.SIZES`; `rounds` are those of the median.
    """
    found = contacts(size)
    few = found[:4] if size == "dense" else found[:6]
    hulls = [polygon.convex_hull(c.points) for c in few]
    measures: tuple[tuple[str, Callable[[], Compared]], ...] = (
        ("hull + area", lambda: _hull(found if size != "dense" else few)),
        ("concave outline", lambda: _outline(few)),
        ("closest point", lambda: _closest(hulls)),
        *((name, partial(_of_hulls, kernel, hulls)) for name, kernel in _INSIDE.items()),
        ("rectangle in the outline", lambda: _outline_rectangle(few[:3])),
        *((name, partial(_of_hulls, kernel, hulls)) for name, kernel in _AROUND.items()),
    )
    for name, make in measures:
        routes, reference = make()
        yield name, compare(name, size, routes, reference, rounds)


def _size(ring: Array) -> float:
    return abs(polygon.area(ring))


def _hull(found: Sequence[Contact]) -> Compared:
    layout, corners = found[0].layout, rivals.Corners(found[0].layout)
    masks = [c.active for c in found]
    points = [c.points for c in found]
    routes = [
        Route("plantar, from active taxels", layout.kernel.hull, masks, lambda r: r[1], ours=True),
        Route(
            "plantar, through a Percept",
            lambda f: Percept(layout, Reading(0.0, f)).support_area,
            [c.force for c in found],
            ours=True,
        ),
        Route("plantar, from points", lambda p: polygon.area(polygon.convex_hull(p)), points, ours=True),
        Route("scipy ConvexHull, from active taxels", lambda m: rivals.hull_scipy(corners.of(m)), masks),
        Route("scipy ConvexHull, points ready", rivals.hull_scipy, points),
        Route("shapely convex_hull, from active taxels", lambda m: rivals.hull_shapely(corners.of(m)), masks),
        Route("shapely convex_hull, points ready", rivals.hull_shapely, points),
        Route("cv2 convexHull (float32)", rivals.hull_cv2, [p.astype(np.float32) for p in points]),
    ]
    return routes, Reference([exact.hull_area_exact(p) for p in points])


def _outline(found: Sequence[Contact]) -> Compared:
    layout = found[0].layout
    cells = [c.cells for c in found]
    points = [c.points for c in found]
    radius = 1.1 * float(np.sqrt(layout.cell_area * 2.0 / (3.0 * np.sqrt(3.0))))
    routes = [
        Route("plantar", lambda mask: concave_outline(layout, mask).area, [c.active for c in found], ours=True),
        Route("shapely coverage_union_all", lambda c: shapely.coverage_union_all(shapely.polygons(c)).area, cells),
        Route("shapely union_all", lambda c: shapely.union_all(shapely.polygons(c)).area, cells),
        Route(
            "shapely concave_hull",
            lambda p: shapely.concave_hull(shapely.multipoints(p), ratio=0.3).area,
            points,
            approximate=True,
        ),
        Route("alpha shape (scipy Delaunay)", lambda p: rivals.alpha_shape_area(p, radius), points, approximate=True),
    ]
    return routes, Reference([exact.area_exact(c) for c in cells])


def _closest(hulls: Sequence[Array]) -> Compared:
    rng = np.random.default_rng(1)
    cases = [(h, h.mean(axis=0) + rng.uniform(-0.15, 0.15, 2)) for h in hulls for _ in range(3)]
    routes = [
        Route("plantar", lambda case: polygon.closest_point(*case), cases, ours=True),
        Route("shapely nearest_points, with construction", rivals.closest_shapely, cases),
    ]
    return routes, Reference([exact.closest_point_exact(*case) for case in cases], [float(np.ptp(h)) for h, _ in cases])


class _HullKernel(NamedTuple):
    """A kernel of convex polygons (k, 2): its exact value, routes still without cases, and which ones are measured."""

    exact: Callable[[Array], float]
    routes: tuple[Route, ...]
    measured: slice = slice(None)


def _of_hulls(kernel: _HullKernel, hulls: Sequence[Array]) -> Compared:
    cases = hulls[kernel.measured]
    return [route._replace(cases=cases) for route in kernel.routes], Reference([kernel.exact(h) for h in cases])


_INSIDE: Mapping[str, _HullKernel] = {
    "inner offset": _HullKernel(
        lambda h: exact.inner_offset_area(h, OFFSET),
        (
            Route("plantar", lambda h: polygon.inner_offset(h, OFFSET), value=_size, ours=True),
            Route(
                "shapely buffer, mitred",
                lambda h: shapely.buffer(shapely.Polygon(h), -OFFSET, join_style="mitre").area,
            ),
        ),
    ),
    "triangle inside": _HullKernel(
        exact.triangle_area_exact,
        (
            Route("plantar", inscribed.inscribed_triangle, value=_size, ours=True),
            Route("numpy, all triples", rivals.triangle),
        ),
    ),
    "parallelogram inside": _HullKernel(
        exact.parallelogram_area,
        (
            Route("plantar", inscribed.inscribed_parallelogram, value=_size, ours=True),
            Route("numpy, 48 directions", partial(exact.parallelogram_area, samples=48, finest=1.0), approximate=True),
            Route("numpy, nested search", exact.parallelogram_area),
        ),
        slice(2),
    ),
    "circle inside": _HullKernel(
        exact.circle_radius,
        (
            Route("plantar", inscribed.inscribed_circle, value=lambda circle: circle.radius, ours=True),
            Route(
                "shapely maximum_inscribed_circle, default tolerance",
                lambda h: shapely.maximum_inscribed_circle(shapely.Polygon(h)).length,
                approximate=True,
            ),
        ),
    ),
    "rectangle inside, axis-aligned": _HullKernel(
        exact.rectangle_area,
        (
            Route("plantar", inscribed.inscribed_rectangle, value=_size, ours=True),
            Route("scipy SLSQP, exact gradients", rivals.rectangle_slsqp),
        ),
        slice(4),
    ),
    "rectangle inside, any angle": _HullKernel(
        exact.rectangle_area_any_angle,
        (
            Route("plantar", inscribed.inscribed_rectangle_any_angle, value=_size, ours=True),
            Route(
                "scipy SLSQP at 32 angles",
                lambda h: max(map(rivals.rectangle_slsqp, rivals.turned(h, 32))),
                approximate=True,
            ),
        ),
        slice(1, 2),
    ),
}

_AROUND: Mapping[str, _HullKernel] = {
    "parallelogram around": _HullKernel(
        exact.least_parallelogram_area,
        (
            Route("plantar", enclosing.enclosing_parallelogram, value=_size, ours=True),
            Route("numpy, all pairs of edges", rivals.parallelogram_around),
        ),
    ),
    "box around, any angle": _HullKernel(
        exact.least_box_area,
        (
            Route("plantar", enclosing.oriented_box, value=_size, ours=True),
            Route("shapely oriented_envelope", lambda h: shapely.oriented_envelope(shapely.Polygon(h)).area),
        ),
    ),
}


def _outline_rectangle(found: Sequence[Contact]) -> Compared:
    outlines = [concave_outline(c.layout, c.active) for c in found]
    rings = [list(o.rings) for o in outlines]
    routes = [
        Route("plantar", inscribed.rectangle_in_outline, outlines, _size, ours=True),
        Route("largestinteriorrectangle's method, 1 mm", rivals.interior_rectangle, rings, approximate=True),
    ]
    return routes, Reference([_best_known(o, 0.0) for o in outlines])


def _best_known(outline: Outline, angle: float) -> float:
    """Best known rectangle's area in m^2 at an angle: ours if valid, or the reference's."""
    ours = _area_inside(outline, inscribed.rectangle_in_outline(outline, angle))
    return ours if angle else max(ours, exact.outline_rectangle_area(outline.rings))


def _area_inside(outline: Outline, corners: Array) -> float:
    parts = [shapely.Polygon(i[0], i[1:]) for i in outline.islands]
    outside = shapely.area(shapely.difference(shapely.Polygon(corners), shapely.union_all(parts)))
    return _size(corners) if outside < 1e-9 * _size(corners) else 0.0
