"""The other routes: what scipy, shapely, cv2 and plain loops do for the same results, and published approximations.

Each route takes what suits it best (points ready, polygons as arrays) and returns what is compared: an area, a point or
a wrench. Libraries are imported inside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout

__all__ = [
    "Corners",
    "alpha_shape_area",
    "box_cv2",
    "box_shapely",
    "circle_shapely",
    "closest_in_loops",
    "closest_numpy",
    "closest_shapely",
    "closest_shapely_ready",
    "concave_hull_area",
    "coverage_ready",
    "histogram_any_angle",
    "histogram_rectangle",
    "hull_cv2",
    "hull_in_loops",
    "hull_scipy",
    "hull_shapely",
    "interior_rectangle",
    "offset_shapely",
    "outline_coverage",
    "outline_union",
    "parallelogram_around_numpy",
    "rectangle_slsqp",
    "rectangle_slsqp_any_angle",
    "triangle_numpy",
    "turned",
]

Array = NDArray[np.float64]


class Corners:
    """Corners of the active cells of a sole, the way numpy finds them fast: the table of corners is made once.

    Args:
        layout: The sole, n taxels.
    """

    def __init__(self, layout: SoleLayout) -> None:
        most = max(len(c) for c in layout.corners)
        self.table = np.array([[*c, *[c[-1]] * (most - len(c))] for c in layout.corners])
        self.vertices = layout.vertices[:, :2]

    def of(self, active: NDArray[np.bool_]) -> Array:
        """Corners (v, 2) in m, each once, of the active cells (n,)."""
        return np.asarray(self.vertices[np.unique(self.table[active])])


def hull_scipy(points: Array) -> float:
    """Area in m^2 of the hull of points (n, 2): Qhull."""
    from scipy.spatial import ConvexHull

    return float(ConvexHull(points).volume)


def hull_shapely(points: Array) -> float:
    """Area in m^2 of the hull of points (n, 2): GEOS."""
    import shapely

    return float(shapely.area(shapely.convex_hull(shapely.multipoints(points))))


def hull_cv2(points: NDArray[np.float32]) -> float:
    """Area in m^2 of the hull of points (n, 2) in float32: OpenCV."""
    import cv2

    return float(cv2.contourArea(cv2.convexHull(points)))


def hull_in_loops(points: Sequence[tuple[float, float]]) -> float:
    """Area in m^2 of the hull of points: the monotone chain as textbooks print it, in plain Python."""
    ordered = sorted(set(points))
    chains = []
    for sequence in (ordered, ordered[::-1]):
        chain: list[tuple[float, float]] = []
        for p in sequence:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2], chain[-1]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0.0:
                    break
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    ring = chains[0] + chains[1]
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1], strict=True))


def coverage_ready(polygons: Any) -> float:
    """Area in m^2 of the union of GEOS polygons with shared corners."""
    import shapely

    return float(shapely.area(shapely.coverage_union_all(polygons)))


def outline_coverage(cells: Sequence[Array]) -> float:
    """Area in m^2 of the union of cells with shared corners: GEOS coverage union."""
    import shapely

    return float(shapely.area(shapely.coverage_union_all(shapely.polygons(cells))))


def outline_union(cells: Sequence[Array]) -> float:
    """Area in m^2 of the union of cells: GEOS overlay."""
    import shapely

    return float(shapely.area(shapely.union_all(shapely.polygons(cells))))


def concave_hull_area(points: Array) -> float:
    """Area in m^2 of GEOS's concave hull of points (n, 2), ratio 0.3: an approximation of the outline."""
    import shapely

    return float(shapely.area(shapely.concave_hull(shapely.multipoints(points), ratio=0.3)))


def alpha_shape_area(points: Array, radius: float) -> float:
    """Area in m^2 of the alpha shape: Delaunay triangles of a circumradius below one, an approximation of the outline.

    Args:
        points: Points (n, 2) in m.
        radius: Circumradius in m.

    Returns:
        Sum of the areas of the triangles that are kept.
    """
    from scipy.spatial import Delaunay

    a, b, c = (points[Delaunay(points).simplices[:, k]] for k in range(3))
    area = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    sides = np.hypot(*(b - a).T) * np.hypot(*(c - b).T) * np.hypot(*(a - c).T)
    return float(area[sides < 4.0 * radius * np.maximum(area, 1e-300)].sum())


def rectangle_slsqp(polygon: Array, gradients: bool = False) -> float:
    """Area in m^2 of the largest axis-aligned rectangle in a convex counter-clockwise polygon: scipy's SLSQP.

    Args:
        polygon: Polygon (k, 2) in m.
        gradients: Give SLSQP exact gradients, and of each half plane only the corner that reaches farthest; else the
            four corners of each, and differences.

    Returns:
        The area that it ends at.
    """
    from scipy.optimize import minimize

    edge = np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    centre, size = polygon.mean(axis=0), float(np.ptp(polygon))
    level = (normal * (polygon - centre)).sum(axis=1) / size
    start = np.array([-0.05, -0.05, 0.05, 0.05])  # x0, y0, x1, y1 about the mean vertex, in sizes
    options = {"ftol": 1e-12, "maxiter": 100}
    if gradients:
        rows = np.column_stack([np.minimum(normal, 0.0), np.maximum(normal, 0.0)])
        done = minimize(
            lambda v: -(v[2] - v[0]) * (v[3] - v[1]),
            start,
            jac=lambda v: np.array([v[3] - v[1], v[2] - v[0], v[1] - v[3], v[0] - v[2]]),
            constraints={"type": "ineq", "fun": lambda v: level - rows @ v, "jac": lambda v: -rows},
            method="SLSQP",
            options=options,
        )
    else:
        done = minimize(
            lambda v: -(v[2] - v[0]) * (v[3] - v[1]),
            start,
            constraints={
                "type": "ineq",
                "fun": lambda v: (level[:, None] - normal @ v[[[0, 2, 2, 0], [1, 1, 3, 3]]]).reshape(-1),
            },
            method="SLSQP",
            options=options,
        )
    return float(-done.fun) * size * size


def _raster(rings: Sequence[Array], pixel: float) -> NDArray[np.bool_]:
    """Pixels (rows, columns) whose four corners lie inside rings: crossings of every line of corners, by parity."""
    low = np.min([r.min(axis=0) for r in rings], axis=0) - 0.5 * pixel
    high = np.max([r.max(axis=0) for r in rings], axis=0)
    columns, rows = (np.ceil((high - low) / pixel).astype(int) + 2).tolist()
    tail = (np.concatenate(rings) - low) / pixel
    head = (np.concatenate([np.roll(r, -1, axis=0) for r in rings]) - low) / pixel
    crossings = np.zeros((rows, columns + 1), dtype=np.int32)
    for (ax, ay), (bx, by) in zip(tail.tolist(), head.tolist(), strict=True):
        line = np.arange(math.ceil(min(ay, by)), math.ceil(max(ay, by)))
        if len(line):
            at = np.ceil(ax + (line - ay) * (bx - ax) / (by - ay)).astype(int)
            np.add.at(crossings, (line, at), 1)
    inside = np.cumsum(crossings, axis=1)[:, :columns] % 2 == 1
    whole: NDArray[np.bool_] = inside[1:, 1:] & inside[:-1, 1:] & inside[1:, :-1] & inside[:-1, :-1]
    return whole


def histogram_rectangle(rings: Sequence[Array], pixel: float = 1e-3) -> float:
    """Area in m^2 of the largest axis-aligned rectangle of a raster: the stack over row histograms.

    Args:
        rings: Rims of islands and holes (k, 2) in m.
        pixel: Pixel size in m.

    Returns:
        Area of the best rectangle of pixels; the stack runs in plain Python, the raster in numpy.
    """
    mask = _raster(rings, pixel)
    height = np.zeros(mask.shape[1], dtype=int)
    best = 0
    for row in mask:
        height = (height + 1) * row
        stack: list[tuple[int, int]] = []
        for i, h in enumerate([*height.tolist(), 0]):
            first = i
            while stack and stack[-1][1] >= h:
                first, tall = stack.pop()
                best = max(best, tall * (i - first))
            stack.append((first, h))
    return best * pixel * pixel


def interior_rectangle(rings: Sequence[Array], pixel: float = 1e-3) -> float:
    """Area in m^2 of the largest axis-aligned rectangle by the method of the package largestinteriorrectangle.

    From every pixel, runs to the right are followed downwards; the shortest so far times the depth is what a rectangle
    from there can have (R. Marzeau's HorizontalAdjacency). The package compiles its loops with numba; here all pixels
    take a step down at once, in numpy.

    Args:
        rings: Rims of islands and holes (k, 2) in m.
        pixel: Pixel size in m.

    Returns:
        Area of the best rectangle of pixels.
    """
    mask = _raster(rings, pixel)
    rows, columns = mask.shape
    run = np.zeros((rows, columns + 1), dtype=np.int32)
    for i in range(columns - 1, -1, -1):
        run[:, i] = (run[:, i + 1] + 1) * mask[:, i]
    run = run[:, :columns]
    narrow = run.copy()
    best = int(run.max(initial=0))
    for depth in range(2, rows + 1):
        narrow = np.minimum(narrow[:-1], run[depth - 1 :])
        widest = int(narrow.max(initial=0))
        if widest == 0:
            break
        best = max(best, widest * depth)
    return best * pixel * pixel


def triangle_numpy(polygon: Array) -> float:
    """Area in m^2 of the largest triangle on a convex polygon's vertices: all triples at once, in numpy."""
    x, y = (polygon - polygon[0]).T
    i, j = np.triu_indices(len(polygon), 1)
    cross = x[i] * y[j] - x[j] * y[i]
    table = np.zeros((len(polygon), len(polygon)))
    table[i, j], table[j, i] = cross, -cross
    return float(0.5 * (table[:, :, None] + table[None, :, :] - table[:, None, :]).max())


def parallelogram_around_numpy(polygon: Array) -> float:
    """Area in m^2 of the least parallelogram around a convex polygon: all pairs of edges at once, in numpy."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    edge = edge / np.hypot(*edge.T)[:, None]
    across = np.column_stack([-edge[:, 1], edge[:, 0]]) @ polygon.T
    width = np.ptp(across, axis=1)
    turn = np.abs(edge[:, :1] * edge[:, 1] - edge[:, 1:] * edge[:, 0])
    np.fill_diagonal(turn, 0.0)
    with np.errstate(divide="ignore"):
        return float(np.where(turn > 1e-12, width[:, None] * width / turn, math.inf).min())


def circle_shapely(polygon: Array, tolerance: float | None = None) -> float:
    """Largest circle in a polygon: GEOS.

    Args:
        polygon: Corners (k, 2) in m.
        tolerance: Error that is allowed, as a share of the polygon's size; what GEOS takes by itself where None.

    Returns:
        Radius in m.
    """
    import shapely

    shape: Any = shapely.Polygon(polygon)
    given = None if tolerance is None else tolerance * float(np.ptp(polygon))
    return float(shapely.length(shapely.maximum_inscribed_circle(shape, tolerance=given)))


def closest_shapely(case: tuple[Array, Array]) -> tuple[float, float]:
    """Closest point in m of a polygon (k, 2) to a point (2,): GEOS, the polygon made on the way."""
    import shapely

    return closest_shapely_ready((shapely.Polygon(case[0]), case[1]))


def closest_shapely_ready(case: tuple[Any, Array]) -> tuple[float, float]:
    """Closest point in m of a GEOS polygon to a point (2,)."""
    import shapely

    nearest = shapely.get_point(shapely.shortest_line(case[0], shapely.Point(case[1])), 0)
    return float(shapely.get_x(nearest)), float(shapely.get_y(nearest))


def closest_numpy(case: tuple[Array, Array]) -> Array:
    """Closest point (2,) in m of a convex polygon (k, 2) to a point (2,): all edges at once, in numpy."""
    ring, point = case
    edge = np.roll(ring, -1, axis=0) - ring
    to = point - ring
    if ((to[:, 0] * edge[:, 1] - to[:, 1] * edge[:, 0]) <= 0.0).all():
        return point
    share = np.clip((to * edge).sum(axis=1) / (edge * edge).sum(axis=1), 0.0, 1.0)
    near = ring + share[:, None] * edge
    best: Array = near[np.argmin(((near - point) ** 2).sum(axis=1))]
    return best


def closest_in_loops(case: tuple[list[tuple[float, float]], tuple[float, float]]) -> tuple[float, float]:
    """Closest point in m of a convex polygon to a point: T's Algorithm 1 in plain Python."""
    ring, (x, y) = case
    best, at, inside = math.inf, (x, y), True
    ax, ay = ring[-1]
    for bx, by in ring:
        lx, ly, dx, dy = bx - ax, by - ay, x - ax, y - ay
        if dx * ly - dy * lx > 0.0:
            inside = False
            t = min(1.0, max(0.0, (dx * lx + dy * ly) / (lx * lx + ly * ly)))
            px, py = ax + t * lx, ay + t * ly
            distance = (x - px) ** 2 + (y - py) ** 2
            if distance < best:
                best, at = distance, (px, py)
        ax, ay = bx, by
    return (x, y) if inside else at


def offset_shapely(polygon: Array, distance: float, join: str) -> float:
    """Area in m^2 of a convex polygon (k, 2) moved inwards: GEOS buffer.

    Args:
        polygon: Polygon in m.
        distance: How far in m.
        join: "mitre" or "round".

    Returns:
        The area.
    """
    import shapely

    return float(shapely.area(shapely.buffer(shapely.Polygon(polygon), -distance, join_style=join)))


def box_shapely(polygon: Array) -> float:
    """Area in m^2 of the least rectangle around a polygon (k, 2): GEOS."""
    import shapely

    return float(shapely.area(shapely.oriented_envelope(shapely.Polygon(polygon))))


def box_cv2(polygon: NDArray[np.float32]) -> float:
    """Area in m^2 of the least rectangle around a polygon (k, 2) in float32: OpenCV."""
    import cv2

    (width, height) = cv2.minAreaRect(polygon)[1]
    return float(width) * float(height)


def turned(points: Array, angle: float) -> Array:
    """Turn points (n, 2) about the origin by an angle in rad; returns them."""
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]))


def rectangle_slsqp_any_angle(polygon: Array, angles: int = 32) -> float:
    """Area in m^2 of the best of the rectangles that SLSQP finds at some angles of a quarter turn.

    Args:
        polygon: Convex counter-clockwise polygon (k, 2) in m.
        angles: How many.

    Returns:
        The largest area.
    """
    return max(rectangle_slsqp(turned(polygon, -0.5 * math.pi * i / angles), True) for i in range(angles))


def histogram_any_angle(rings: Sequence[Array], angles: int = 16) -> float:
    """Area in m^2 of the best rectangle of 1 mm rasters at some angles of a quarter turn.

    Args:
        rings: Rims of islands and holes (k, 2) in m.
        angles: How many.

    Returns:
        The largest area.
    """
    return max(histogram_rectangle([turned(r, -0.5 * math.pi * i / angles) for r in rings]) for i in range(angles))
