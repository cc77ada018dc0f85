"""Shapes around points: bounding box, oriented box and parallelogram of least area (T 4.2.5).

Each takes the vertices of a convex polygon, in either direction and with repeated or collinear vertices, and returns
corners (4, 2) in m, counter-clockwise; no corners (0, 2) for an empty polygon. Vertices that are not finite are left
out.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.clean_ring import CleanRing
from plantar.kernels import enclosing as _kernel

__all__ = ["bounding_box", "enclosing_parallelogram", "oriented_box"]


def bounding_box(points: ArrayLike) -> NDArray[np.float64]:
    """Axis-aligned box of any points (T 4.4.4); exact.

    Args:
        points: Points (k, 2) in m.

    Returns:
        Corners (4, 2) in m from the lower left one; (0, 2) without points.

    Example:
        >>> bounding_box([[0.0, 0.0], [2.0, 1.0], [1.0, 3.0]]).tolist()
        [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]]
        >>> bounding_box([]).shape
        (0, 2)
    """
    cloud = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    if len(cloud) == 0:
        return np.empty((0, 2))
    (x1, y1), (x2, y2) = cloud.min(axis=0).tolist(), cloud.max(axis=0).tolist()
    if not abs(x1 + y1 + x2 + y2) < np.inf:  # something is not finite
        return bounding_box(cloud[np.isfinite(cloud).all(axis=1)]) if not np.isfinite(cloud).all() else _box(cloud)
    return np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]])


def _box(cloud: NDArray[np.float64]) -> NDArray[np.float64]:
    """Box of finite points whose sum overflows."""
    (x1, y1), (x2, y2) = cloud.min(axis=0), cloud.max(axis=0)
    return np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]])


def oriented_box(polygon: ArrayLike) -> NDArray[np.float64]:
    """Rectangle of least area around a convex polygon, at any angle, by rotating calipers.

    Args:
        polygon: Convex polygon (k, 2) in m.

    Returns:
        Corners (4, 2) in m, the first side along an edge of the polygon; its area is exact to 1e-12 of it. A polygon
        without area gives the box without area around it.

    Example:
        >>> box = oriented_box([[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [-1.0, 1.0]])
        >>> round(float(np.linalg.norm(box[1] - box[0]) * np.linalg.norm(box[2] - box[1])), 12)
        2.0
    """
    ring = CleanRing(polygon)
    if ring.n < 3:
        return ring.flat_shape()
    _kernel.least_box(ring.xy, ring.n, ring.out)
    return ring.corners(4)


def enclosing_parallelogram(polygon: ArrayLike) -> NDArray[np.float64]:
    """Parallelogram of least area around a convex polygon (T 4.2.5, [175]).

    Both pairs of its sides lie along an edge of the polygon (Schwarz et al. 1995), so that trying all pairs of edges,
    the strips around the polygon found by rotating calipers, is exact.

    Args:
        polygon: Convex polygon (k, 2) in m.

    Returns:
        Corners (4, 2) in m; its area is exact to 1e-12 of it. A polygon without area gives the parallelogram without
        area around it.

    Example:
        >>> corners = enclosing_parallelogram([[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [1.0, 1.0]])
        >>> sorted(np.round(corners, 12).tolist())
        [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0]]
    """
    ring = CleanRing(polygon)
    if ring.n < 3:
        return ring.flat_shape()
    _kernel.least_parallelogram(ring.xy, ring.n, ring.work(4 * ring.n), ring.out)
    return ring.corners(4)
