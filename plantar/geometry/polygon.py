"""Convex polygons: hull, area, centroid, closest point, margin, inner offset.

Vertices (k, 2) in m without repeated last point, counter-clockwise where returned; 1 or 2, of area 0, for points on one
line.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.arguments import number
from plantar.errors import InputError
from plantar.kernels.geometry import convex as _kernel
from plantar.kernels.geometry import hull as _hull
from plantar.kernels.geometry.clean import clean_ring, extent, turning
from plantar.kernels.geometry.cut_cells import part_below
from plantar.plane_points import plane_point, plane_points

__all__ = [
    "area",
    "centroid",
    "closest_point",
    "convex_hull",
    "convex_ring",
    "inner_offset",
    "part_inside",
    "signed_margin",
]

_DENT = 1e-6  # of its hull: a polygon that lacks less than this is convex
_NOISE = 1e-15  # of a polygon's extent: corners that a cut leaves nearer to each other are one


def convex_hull(points: ArrayLike) -> NDArray[np.float64]:
    """Convex hull by Andrew's monotone chain, without vertices on straight edges.

    Every turn is decided exactly; a vertex within rounding of its neighbours' line (4 units in the last place, at most
    1e-13 of the extent) is left out.

    Args:
        points: Points (n, 2) in m; those not finite, or beyond 1e100 m, are left out.

    Returns:
        Hull (k, 2), counter-clockwise from lowest x; vertices are input points.

    Raises:
        InputError: Not (n, 2).

    Example:
        >>> convex_hull([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]]).tolist()
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        >>> convex_hull([]).shape
        (0, 2)
    """
    hull: NDArray[np.float64] = _hull.convex_hull(plane_points(points, "points", finite=False))
    return hull


def convex_ring(polygon: ArrayLike) -> NDArray[np.float64]:
    """Caller's convex polygon; repeated and collinear vertices are allowed.

    Args:
        polygon: Polygon (k, 2) in m, either orientation.

    Returns:
        Vertices (k, 2) in m, not copied if float64.

    Raises:
        InputError: Not finite (k, 2).
    """
    ring = plane_points(polygon)
    if len(ring) > 3 and turning(ring, 0.0, 0.0, 0.0) == 0:
        hull = float(_kernel.area_of(_hull.convex_hull(ring)))
        share = abs(float(_kernel.area_of(ring))) / hull if hull > 0.0 else 1.0
        size = extent(ring)
        step = 1e-15 * float(np.abs(ring).max())  # of the coordinates
        if (1.0 - share) * hull > _DENT * (hull + 0.01 * size * size) + step * size:
            raise InputError(
                f"polygon is not convex: {100.0 * share:.0f} % of its hull; allowed: a convex one, as of convex_hull"
            )
    return ring


def area(polygon: ArrayLike) -> float:
    """Signed area in m^2 (shoelace): positive for counter-clockwise.

    Args:
        polygon: Simple polygon (k, 2) in m.

    Returns:
        Area; 0 below 3 vertices.

    Raises:
        InputError: Not finite (k, 2).
    """
    return float(_kernel.area_of(plane_points(polygon)))


def centroid(polygon: ArrayLike) -> NDArray[np.float64] | None:
    """Centroid of the polygon's area.

    Args:
        polygon: Simple polygon (k, 2) in m.

    Returns:
        Position (2,) in m; mean of vertices where area is 0; None if empty.

    Raises:
        InputError: Not finite (k, 2).

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
    """Closest point of a convex polygon (T Algorithm 1, corrected).

    Printed (d x l)_z > 0 holds for counter-clockwise vertices alone; here its sign follows the polygon's.

    Args:
        polygon: Convex polygon (k, 2), either orientation.
        point: Point (2,) in m.

    Returns:
        Point itself inside, else closest point (2,) on boundary; None if empty, NaN for no finite point.

    Raises:
        InputError: Polygon not convex.

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
    """Signed distance in m of a point to a convex polygon's edge: positive inside.

    Args:
        polygon: Convex polygon (k, 2), either orientation.
        point: Point (2,) in m.

    Returns:
        Distance; -inf if empty, NaN for no finite point.

    Raises:
        InputError: Polygon not convex.

    Example:
        >>> signed_margin(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), [0.5, 0.25])
        0.25
    """
    ring = convex_ring(polygon)
    x, y = plane_point(point)
    if len(ring) == 0:
        return -math.inf
    return float(_kernel.signed_margin(ring, x, y))


def inner_offset(polygon: ArrayLike, distance: float) -> NDArray[np.float64]:
    """Convex polygon of the points that keep a distance from every edge.

    Args:
        polygon: Convex polygon (k, 2), either orientation.
        distance: Distance in m, 0 or more.

    Returns:
        Smaller polygon (m, 2), counter-clockwise; if none, or NaN, deepest point (1, 2); empty for empty, a copy for 0.

    Raises:
        InputError: Polygon not convex, distance negative.

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
    """Part of a convex polygon where n . x <= h, without near-duplicates.

    Args:
        polygon: Convex polygon (k, 2) in m, counter-clockwise.
        nx: Line's normal n, along x.
        ny: Same along y.
        h: Distance in m of line from origin, along normal.

    Returns:
        Convex polygon (k, 2) in m, counter-clockwise; may be empty.
    """
    left = part_below(np.ascontiguousarray(polygon, dtype=np.float64), nx, ny, h)
    near = _NOISE * extent(polygon)
    return left if turning(left, 0.0, 0.0, near) > 0 else np.asarray(clean_ring(left, 0.0, 0.0, near))
