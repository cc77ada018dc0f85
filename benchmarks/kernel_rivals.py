"""Other routes to the kernels' results: scipy, shapely, cv2, published approximations.

Each takes its best input and returns an area, a radius or a point.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout

Array = NDArray[np.float64]


class Corners:
    """Corners of the active cells of a sole, by a table."""

    def __init__(self, layout: SoleLayout) -> None:
        most = max(len(c) for c in layout.corners)
        self.table = np.array([[*c, *[c[-1]] * (most - len(c))] for c in layout.corners])
        self.vertices = layout.vertices[:, :2]

    def of(self, active: NDArray[np.bool_]) -> Array:
        """Corners (v, 2) in m, each once, of active cells (n,)."""
        return np.asarray(self.vertices[np.unique(self.table[active])])


def hull_scipy(points: Array) -> float:
    """Area in m^2 of the hull of points (n, 2): Qhull."""
    from scipy.spatial import ConvexHull

    return float(ConvexHull(points).volume)


def hull_shapely(points: Array) -> float:
    """Area in m^2 of the hull of points (n, 2): GEOS."""
    return float(shapely.area(shapely.convex_hull(shapely.multipoints(points))))


def hull_cv2(points: NDArray[np.float32]) -> float:
    """Hull area in m^2 of points (n, 2) in float32: OpenCV."""
    import cv2

    return float(cv2.contourArea(cv2.convexHull(points)))


def alpha_shape_area(points: Array, radius: float) -> float:
    """Returns the alpha shape's area in m^2 of `points` (n, 2) in m: Delaunay circumradii below `radius` in m."""
    from scipy.spatial import Delaunay

    a, b, c = (points[Delaunay(points).simplices[:, k]] for k in range(3))
    area = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    sides = np.hypot(*(b - a).T) * np.hypot(*(c - b).T) * np.hypot(*(a - c).T)
    return float(area[sides < 4.0 * radius * np.maximum(area, 1e-300)].sum())


def closest_shapely(case: tuple[Array, Array]) -> tuple[float, float]:
    """Closest point in m of a polygon (k, 2) to a point (2,): GEOS."""
    nearest = shapely.get_point(shapely.shortest_line(shapely.Polygon(case[0]), shapely.Point(case[1])), 0)
    return float(shapely.get_x(nearest)), float(shapely.get_y(nearest))


def rectangle_slsqp(polygon: Array) -> float:
    """Largest axis-aligned rectangle's area in m^2 in a convex counter-clockwise polygon (k, 2): scipy's SLSQP."""
    from scipy.optimize import minimize

    edge = np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    centre = polygon.mean(axis=0)
    size = float(np.ptp(polygon))
    level = (normal * (polygon - centre)).sum(axis=1) / size
    rows = np.column_stack([np.minimum(normal, 0.0), np.maximum(normal, 0.0)])
    done = minimize(
        lambda v: -(v[2] - v[0]) * (v[3] - v[1]),
        np.array([-0.05, -0.05, 0.05, 0.05]),  # x0, y0, x1, y1 about the mean vertex, in sizes
        jac=lambda v: np.array([v[3] - v[1], v[2] - v[0], v[1] - v[3], v[0] - v[2]]),
        constraints={"type": "ineq", "fun": lambda v: level - rows @ v, "jac": lambda v: -rows},
        method="SLSQP",
        options={"ftol": 1e-12, "maxiter": 100},
    )
    return float(-done.fun) * size * size


def interior_rectangle(rings: Sequence[Array], pixel: float = 1e-3) -> float:
    """Returns the best axis-aligned rectangle's area in m^2, of pixels `pixel` in m, in `rings` (k, 2) in m of islands
    and holes.

    After largestinteriorrectangle (R. Marzeau's HorizontalAdjacency): from every pixel, runs to the right are followed
    downwards, all at once.
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


def _raster(rings: Sequence[Array], pixel: float) -> NDArray[np.bool_]:
    """Pixels (rows, columns) with four corners inside rings, by parity of crossings."""
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


def triangle(polygon: Array) -> float:
    """Largest vertex triangle's area in m^2 of a convex polygon (k, 2), at once."""
    x, y = (polygon - polygon[0]).T
    i, j = np.triu_indices(len(polygon), 1)
    cross = x[i] * y[j] - x[j] * y[i]
    table = np.zeros((len(polygon), len(polygon)))
    table[i, j] = cross
    table[j, i] = -cross
    return float(0.5 * (table[:, :, None] + table[None, :, :] - table[:, None, :]).max())


def parallelogram_around(polygon: Array) -> float:
    """Least surrounding parallelogram's area in m^2 of a convex polygon (k, 2), at once."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    edge = edge / np.hypot(*edge.T)[:, None]
    across = np.column_stack([-edge[:, 1], edge[:, 0]]) @ polygon.T
    width = np.ptp(across, axis=1)
    turn = np.abs(edge[:, :1] * edge[:, 1] - edge[:, 1:] * edge[:, 0])
    np.fill_diagonal(turn, 0.0)
    with np.errstate(divide="ignore"):
        return float(np.where(turn > 1e-12, width[:, None] * width / turn, math.inf).min())


def turned(points: Any, angles: int) -> list[Any]:
    """Returns `points` (n, 2) turned by `angles` even angles of a quarter turn."""
    c = np.cos(a := 0.5 * math.pi * np.arange(angles) / angles)
    s = np.sin(a)
    return [points @ np.array([[x, -y], [y, x]]) for x, y in zip(c, s, strict=True)]
