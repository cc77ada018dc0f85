"""Convex polygons: hull, area, centroid, closest point, margin, inner offset.

Vertices (k, 2) in m without repeated last point, counter-clockwise where returned; 1 or 2, of area 0, for points on one
line.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.common.plane_points import plane_point, plane_points
from plantar.errors import InputError
from plantar.kernels.geometry import convex as _kernel
from plantar.kernels.geometry import hull as _hull
from plantar.kernels.geometry.clean import clean_ring, extent, turning
from plantar.kernels.geometry.cut_cells import part_below

# of its hull: a polygon that lacks less than this is convex; nature: floating point of single precision, in which files
# hold corners
_DENT = 1e-6
# of a polygon's extent: corners that a cut leaves nearer to each other are one; nature: floating point, five roundings
# of 2.2e-16
_NOISE = 1e-15


def convex_hull(points: ArrayLike) -> NDArray[np.float64]:
    """Convex hull (k, 2) of points (n, 2) in m, counter-clockwise from the lowest x, without vertices on
    straight edges: Andrew's monotone chain.

    Vertices are input points; those not finite, or beyond 1e100 m, are left out. Every turn is decided exactly; a
    vertex within rounding of its neighbours' line (4 units in the last place, at most 1e-13 of the extent) is left
    out. An InputError unless (n, 2).

    Example:
        >>> convex_hull([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]]).tolist()
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        >>> convex_hull([]).shape
        (0, 2)
    """
    hull: NDArray[np.float64] = _hull.convex_hull(plane_points(points, "points", finite=False))
    return hull


def convex_ring(polygon: ArrayLike) -> NDArray[np.float64]:
    """Caller's convex polygon (k, 2) in m, either orientation, not copied if float64; an InputError if not convex.

    Repeated and collinear vertices are allowed.
    """
    ring = plane_points(polygon)
    if len(ring) > 3 and turning(ring, 0.0, 0.0, 0.0) == 0:
        hull = float(_kernel.area_of(_hull.convex_hull(ring)))
        share = abs(float(_kernel.area_of(ring))) / hull if hull > 0.0 else 1.0
        size = extent(ring)
        step = 1e-15 * float(np.abs(ring).max())  # of the coordinates; nature: floating point, five roundings
        # derived: a strip is judged by its length as if it were a hundredth as wide
        if (1.0 - share) * hull > _DENT * (hull + 0.01 * size * size) + step * size:
            raise InputError(
                f"polygon is not convex: {100.0 * share:.0f} % of its hull; allowed: a convex one, as of convex_hull"
            )
    return ring


def area(polygon: ArrayLike) -> float:
    """Signed area in m^2 of a simple polygon (k, 2) in m: positive counter-clockwise, 0 below 3 vertices."""
    return float(_kernel.area_of(plane_points(polygon)))


def centroid(polygon: ArrayLike) -> NDArray[np.float64] | None:
    """Centroid (2,) in m of the area of a simple polygon (k, 2) in m; mean of vertices where that is 0, None if empty.

    Example:
        >>> centroid(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])).tolist()
        [1.0, 0.5]
    """
    ring = plane_points(polygon)
    if len(ring) == 0:
        return None
    _area, x, y = _kernel.area_and_centroid(ring)
    return np.array((x, y))


def closest_point(polygon: ArrayLike, point: ArrayLike) -> NDArray[np.float64] | None:
    """Returns the point (2,) in m of a convex `polygon` (k, 2), either orientation, closest to a `point` (2,), itself
    if inside (T Algorithm 1, corrected); None if empty, NaN for no finite point.

    Printed (d x l)_z > 0 holds for counter-clockwise vertices alone; here its sign follows the polygon's. An
    InputError if not convex.

    Example:
        >>> closest_point(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), [2.0, 0.5]).tolist()
        [1.0, 0.5]
    """
    ring = convex_ring(polygon)
    x, y = plane_point(point)
    if len(ring) == 0:
        return None
    nearest: NDArray[np.float64] = _kernel.closest_point(ring, x, y)
    return nearest


def signed_margin(polygon: ArrayLike, point: ArrayLike) -> float:
    """Returns signed distance in m of a `point` (2,) to the edge of a convex `polygon` (k, 2), either orientation:
    positive inside, -inf if empty, NaN for no finite point; an InputError if not convex.

    Example:
        >>> signed_margin(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), [0.5, 0.25])
        0.25
    """
    ring = convex_ring(polygon)
    x, y = plane_point(point)
    return float(_kernel.signed_margin(ring, x, y)) if len(ring) else -math.inf


def inner_offset(polygon: ArrayLike, distance: float) -> NDArray[np.float64]:
    """Returns the convex polygon (m, 2), counter-clockwise, of points that keep a `distance` in m, 0 or more, from
    every edge of a convex `polygon` (k, 2), either orientation.

    If none, or NaN, the deepest point (1, 2); empty for empty, a copy for 0. An InputError if not convex, or
    for a distance below 0.

    Example:
        >>> inner_offset(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), 0.25).tolist()
        [[0.25, 0.75], [0.25, 0.25], [0.75, 0.25], [0.75, 0.75]]
    """
    ring = convex_ring(polygon)
    if type(distance) is not float:  # which control loops hand over, and which may be NaN or inf
        distance = number(distance, "distance", nan=True)
    if distance < 0.0:
        raise InputError(f"distance is {distance} m; allowed: 0 or more")
    if len(ring) == 0 or distance == 0.0:
        return ring[:: -1 if area(ring) < 0.0 else 1].copy()
    if len(ring) < 3:
        return np.asarray(ring.mean(axis=0, keepdims=True))
    smaller: NDArray[np.float64] = _kernel.inner_offset(ring, distance)
    return smaller


def part_inside(polygon: NDArray[np.float64], nx: float, ny: float, h: float) -> NDArray[np.float64]:
    """Returns part (k, 2) in m of a convex counter-clockwise `polygon` (k, 2) where n . x <= h; near points are one.

    n is the line's normal (`nx`, `ny`), `h` its distance in m from the origin along that.
    """
    left = part_below(np.ascontiguousarray(polygon, dtype=np.float64), nx, ny, h)
    near = _NOISE * extent(polygon)
    return left if turning(left, 0.0, 0.0, near) > 0 else np.asarray(clean_ring(left, 0.0, 0.0, near))
