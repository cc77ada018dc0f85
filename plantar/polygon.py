"""Convex polygons in a plane: hull, area, centroid, closest point, signed margin, inner offset.

A polygon is an array (k, 2) of vertices in m, counter-clockwise, without a repeated last point; an empty polygon has
k = 0. Points that coincide or lie on one line give a polygon of 1 or 2 vertices and area 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["area", "centroid", "closest_point", "convex_hull", "inner_offset", "signed_margin"]


def convex_hull(points: ArrayLike) -> NDArray[np.float64]:
    """Convex hull by Andrew's monotone chain, without vertices on straight edges.

    The chain runs on integers, coordinates rounded to 1e-9 of the extent, so that its turns are exact. A vertex that
    stands out of the line of its neighbours by no more than this rounding (2e-9 of the extent) is then left out: on a
    hexagonal lattice whole rows of corners are collinear up to their last bits.

    Args:
        points: Points (n, 2) in m.

    Returns:
        Hull (k, 2), counter-clockwise from the lowest x (to 2e-9 of the extent); vertices are input points.

    Example:
        >>> convex_hull([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]]).tolist()
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    """
    cloud = np.asarray(points, dtype=float).reshape(-1, 2)
    if len(cloud) == 0:
        return np.empty((0, 2))
    low = cloud.min(axis=0)
    cell = 1e-9 * float((cloud.max(axis=0) - low).max())
    if cell == 0.0:
        return cloud[:1].copy()
    grid = np.rint((cloud - low) / cell).astype(np.int64)
    _, first = np.unique(grid, axis=0, return_index=True)  # sorted by x, then y
    keys = [(int(x), int(y), int(i)) for (x, y), i in zip(grid[first], first, strict=True)]

    def chain(sequence: list[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
        out: list[tuple[int, int, int]] = []
        for p in sequence:
            while len(out) >= 2:
                (ax, ay, _), (bx, by, _) = out[-2], out[-1]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0:
                    break
                out.pop()
            out.append(p)
        return out

    if len(keys) <= 2:
        return cloud[[k[2] for k in keys]]
    ring: list[tuple[int, int, int]] = []
    for p in chain(keys)[:-1] + chain(keys[::-1])[:-1]:
        while len(ring) >= 2 and _is_straight(ring[-2], ring[-1], p):
            ring.pop()
        ring.append(p)
    while len(ring) > 2 and _is_straight(ring[-2], ring[-1], ring[0]):
        ring.pop()
    while len(ring) > 2 and _is_straight(ring[-1], ring[0], ring[1]):
        ring.pop(0)
    return np.asarray(cloud[[k[2] for k in ring]])


def _is_straight(a: tuple[int, int, int], b: tuple[int, int, int], c: tuple[int, int, int]) -> bool:
    """Whether b lies between a and c, no more than 2 grid units off their line."""
    lx, ly = c[0] - a[0], c[1] - a[1]
    dx, dy = b[0] - a[0], b[1] - a[1]
    between = dx * (c[0] - b[0]) + dy * (c[1] - b[1]) >= 0
    return between and (lx * dy - ly * dx) ** 2 <= 4 * (lx * lx + ly * ly)


def area(polygon: NDArray[np.float64]) -> float:
    """Signed area in m^2 (shoelace about the first vertex): positive for counter-clockwise.

    Example:
        >>> area(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]))
        2.0
    """
    if len(polygon) < 3:
        return 0.0
    x, y = (polygon - polygon[0]).T
    return 0.5 * float(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1]))


def centroid(polygon: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Centroid (2,) in m of the polygon's area; the mean of its vertices where the area is 0; None when empty.

    Example:
        >>> centroid(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])).tolist()
        [1.0, 0.5]
    """
    if len(polygon) == 0:
        return None
    local = polygon - polygon[0]
    x, y = local.T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    total = float(cross.sum())
    size = float(np.abs(local).max()) if len(polygon) > 1 else 0.0
    if abs(total) <= 1e-12 * size * size:
        return np.asarray(polygon.mean(axis=0))
    inner = (local + np.roll(local, -1, axis=0)) * cross[:, None]
    return np.asarray(polygon[0] + inner.sum(axis=0) / (3.0 * total))


def closest_point(polygon: NDArray[np.float64], point: ArrayLike) -> NDArray[np.float64] | None:
    """Point of a convex polygon that is closest to a given one (T Algorithm 1, corrected).

    The printed test "outside if (d x l)_z > 0" holds for counter-clockwise vertices, which is what is used here; on
    clockwise vertices, as printed, it moves inside points to the far side.

    Args:
        polygon: Convex polygon (k, 2), counter-clockwise.
        point: Point (2,) in m.

    Returns:
        The point itself when it is inside, else the closest point (2,) on the boundary; None for an empty polygon.

    Example:
        >>> closest_point(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), [2.0, 0.5]).tolist()
        [1.0, 0.5]
    """
    px, py = (float(v) for v in np.asarray(point, dtype=float))
    k = len(polygon)
    if k == 0:
        return None
    ring = polygon.tolist()
    if k == 1:
        return np.array(ring[0])
    inside = k > 2
    best, bx, by = math.inf, px, py
    ax, ay = ring[-1]
    for cx, cy in ring:
        lx, ly = cx - ax, cy - ay
        dx, dy = px - ax, py - ay
        if k == 2 or dx * ly - dy * lx > 0.0:  # (d x l)_z
            inside = False
            length2 = lx * lx + ly * ly
            t = min(1.0, max(0.0, (dx * lx + dy * ly) / length2)) if length2 > 0.0 else 0.0
            qx, qy = ax + t * lx, ay + t * ly
            distance2 = (px - qx) ** 2 + (py - qy) ** 2
            if distance2 < best:
                best, bx, by = distance2, qx, qy
        ax, ay = cx, cy
    return np.array([px, py]) if inside else np.array([bx, by])


def signed_margin(polygon: NDArray[np.float64], point: Sequence[float] | NDArray[np.float64]) -> float:
    """Signed distance in m of a point to the edge of a convex polygon: positive inside, negative outside.

    Args:
        polygon: Convex polygon (k, 2), counter-clockwise.
        point: Point (2,) in m.

    Returns:
        The distance; -inf for an empty polygon.

    Example:
        >>> signed_margin(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), [0.5, 0.25])
        0.25
    """
    nearest = closest_point(polygon, point)
    if nearest is None:
        return -math.inf
    px, py = (float(v) for v in point)
    gap = math.hypot(px - nearest[0], py - nearest[1])
    if gap > 0.0 or len(polygon) < 3:
        return -gap
    margin = math.inf
    ring = polygon.tolist()
    ax, ay = ring[-1]
    for bx, by in ring:
        length = math.hypot(bx - ax, by - ay)
        if length > 0.0:
            margin = min(margin, ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / length)
        ax, ay = bx, by
    return margin


def inner_offset(polygon: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Convex polygon of the points that keep a distance from every edge.

    Args:
        polygon: Convex polygon (k, 2), counter-clockwise.
        distance: Distance in m, 0 or more.

    Returns:
        The smaller polygon (m, 2); where nothing is left, the single point that is deepest inside (1, 2), the middle
        for a polygon of 1 or 2 vertices; an empty polygon for an empty one.

    Example:
        >>> inner_offset(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), 0.25).tolist()
        [[0.25, 0.75], [0.25, 0.25], [0.75, 0.25], [0.75, 0.75]]
    """
    if len(polygon) == 0 or distance <= 0.0:
        return polygon.copy()
    if len(polygon) < 3:
        return np.asarray(polygon.mean(axis=0, keepdims=True))
    ring = _clip_inwards(polygon, distance)
    if len(ring):
        return ring
    low, high = 0.0, distance  # nothing left: bisect for the depth of the deepest point
    for _ in range(60):
        middle = 0.5 * (low + high)
        ring = _clip_inwards(polygon, middle)
        low, high = (middle, high) if len(ring) else (low, middle)
    ring = _clip_inwards(polygon, low)
    return np.asarray(ring.mean(axis=0, keepdims=True)) if len(ring) else polygon.mean(axis=0, keepdims=True)


def _clip_inwards(polygon: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Cut a convex polygon by the half planes of its edges moved inwards."""
    base = polygon[0]
    local = (polygon - base).tolist()
    ring = local
    for (ax, ay), (bx, by) in zip(local, [*local[1:], local[0]], strict=True):
        length = math.hypot(bx - ax, by - ay)
        if length == 0.0:
            continue
        nx, ny = -(by - ay) / length, (bx - ax) / length  # inward normal of a counter-clockwise edge
        level = nx * ax + ny * ay + distance
        out: list[list[float]] = []
        for i, (cx, cy) in enumerate(ring):
            ex, ey = ring[i - 1]
            sc, se = nx * cx + ny * cy - level, nx * ex + ny * ey - level
            if (sc >= 0.0) != (se >= 0.0):
                t = se / (se - sc)
                out.append([ex + t * (cx - ex), ey + t * (cy - ey)])
            if sc >= 0.0:
                out.append([cx, cy])
        ring = out
        if not ring:
            return np.empty((0, 2))
    return np.asarray(np.array(ring) + base)
