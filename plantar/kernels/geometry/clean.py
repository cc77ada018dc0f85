"""Cleans a convex ring of near-duplicates and turns the wrong way.

A ring that is exactly convex, goes round once and has no two neighbours within `_NEAR` of its size stays. Of any other
the hull is taken, with every turn decided exactly.
"""

import numpy as np

from . import hull

__all__ = ["anchor", "clean_ring", "extent", "turning"]

_BOUND = 3.3306690738754716e-16  # nature: Shewchuk's bound A of a turn's rounding, relative to its two products
# m^2: products up to this are rounding; nature: floating point, whose subnormal products are below 1e-308
_UNDERFLOW = 1e-280
_NEAR = 4.4e-16  # of the ring's size: neighbours within it are one vertex; nature: floating point, two roundings
_LARGEST = 1e100  # coordinates in m beyond this count as not finite, as by `hull`; nature: floating point
# m: products of the edges of a smaller ring may underflow; nature: floating point, the fourth root of the smallest
# number is 1e-77 and four lengths are multiplied by pairs
_SMALLEST = 1e-100


def turning(polygon, x0, y0, near):
    """Which way a ring (k, 2) about x0, y0 in m goes: 1 counter-clockwise, -1 clockwise.

    Returns 0 unless it turns one way at every vertex beyond rounding, goes round once, with no neighbours within `near`
    in m.
    """
    k = polygon.shape[0]
    if k < 3:
        return 0
    ax = polygon[k - 2, 0] - x0
    ay = polygon[k - 2, 1] - y0
    bx = polygon[k - 1, 0] - x0
    by = polygon[k - 1, 1] - y0
    ux = bx - ax
    uy = by - ay
    was_up = uy > 0.0 or (uy == 0.0 and ux > 0.0)
    left = 0
    rounds = 0
    size = 0.0
    least = abs(ux) + abs(uy)
    for i in range(k):
        cx = polygon[i, 0] - x0
        cy = polygon[i, 1] - y0
        wx = cx - bx
        wy = cy - by
        one = ux * wy
        two = uy * wx
        turn = one - two
        if not abs(turn) > _BOUND * (abs(one) + abs(two)) + _UNDERFLOW:  # nor for NaN
            return 0
        if turn > 0.0:
            left += 1
        up = wy > 0.0 or (wy == 0.0 and wx > 0.0)
        if up and not was_up:
            rounds += 1
        was_up = up
        length = abs(wx) + abs(wy)
        size += length
        least = min(least, length)
        bx = cx
        by = cy
        ux = wx
        uy = wy
    if not (size > _SMALLEST and least > _NEAR * size and least > near) or rounds != 1:
        return 0
    return 1 if left == k else -1 if left == 0 else 0


def anchor(polygon):
    """Index of a ring's first finite vertex; 0 without one."""
    for i in range(polygon.shape[0]):
        if abs(polygon[i, 0]) <= _LARGEST and abs(polygon[i, 1]) <= _LARGEST:  # false for NaN
            return i
    return 0


def extent(polygon):
    """Larger side in m of the box around finite vertices; 0 for none."""
    k = polygon.shape[0]
    if k == 0:
        return 0.0
    low_x = polygon[0, 0]
    high_x = low_x
    low_y = polygon[0, 1]
    high_y = low_y
    for i in range(1, k):
        x = polygon[i, 0]
        y = polygon[i, 1]
        low_x = min(low_x, x)
        high_x = max(high_x, x)
        low_y = min(low_y, y)
        high_y = max(high_y, y)
    return max(high_x - low_x, high_y - low_y)


def clean_ring(polygon, x0, y0, near):
    """Convex hull (m, 2) of a `polygon`'s finite vertices about x0, y0 in m, without near-duplicates (`near` as in
    `turning`), counter-clockwise.
    """
    k = polygon.shape[0]
    local = np.empty((k, 2))
    work = np.empty(4 * k, dtype=np.intp)
    ring = work[2 * k :]
    size = _clean(polygon, x0, y0, near, local, work, ring)
    out = np.empty((size, 2))
    hull.gather(local, ring, size, out)
    return out


def _clean(polygon, x0, y0, near, local, order, ring):
    for i in range(polygon.shape[0]):
        local[i, 0] = polygon[i, 0] - x0
        local[i, 1] = polygon[i, 1] - y0
    size = hull.hull_of_cloud(local, order, ring)
    if size < 2:
        return size
    # From the first vertex given, so that a ring with little to clean keeps its order.
    first = 0
    for i in range(1, size):
        if ring[i] < ring[first]:
            first = i
    span = 0.0
    a = ring[size - 1]
    for i in range(size):
        b = ring[i]
        span += abs(local[b, 0] - local[a, 0]) + abs(local[b, 1] - local[a, 1])
        a = b
    near = max(near, _NEAR * span)
    for i in range(size):
        order[i] = ring[first + i if first + i < size else first + i - size]
    kept = 1
    a = order[0]
    ring[0] = a
    for i in range(1, size):
        b = order[i]
        if abs(local[b, 0] - local[a, 0]) + abs(local[b, 1] - local[a, 1]) > near:
            ring[kept] = b
            a = b
            kept += 1
    a = ring[0]
    while kept > 1:
        b = ring[kept - 1]
        if abs(local[b, 0] - local[a, 0]) + abs(local[b, 1] - local[a, 1]) > near:
            break
        kept -= 1
    return kept
