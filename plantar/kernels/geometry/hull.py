"""Convex hull of points (n, 2), exactly convex: every turn is decided exactly."""

import numpy as np

__all__ = ["convex_hull", "gather", "hull_of_cloud", "hull_ring", "hull_tolerance", "turn_is_left"]

# nature: coordinates in m beyond this count as not finite: their products would overflow; floating point
_LARGEST = 1e100
# nature: points within a box of this size in m are one: the products of their distances would underflow; floating point
_SMALLEST = 1e-100
# nature: coordinates in m up to this count as 0: exact turns are made of products, which must not underflow; floating
# point
_TINY = 1e-120
_SHORT = 64  # points up to this number are sorted by insertion; chosen: a speed alone depends on it
_INFINITE = float("inf")


def hull_tolerance(largest, extent):
    """Least distance in m of a corner from its neighbours' line: 4 ulp of `largest`, at most 1e-13 of `extent`.

    `largest`: largest absolute coordinate in m; `extent`: larger side of points' box in m.
    """
    # nature: floating point, four roundings of the coordinates; no more than 1e-13 of what they span
    return min(8.9e-16 * largest, 1e-13 * extent)


def _product_tail(a, b, product):
    """Rounding error of `product` = a * b, exact (Dekker; Veltkamp's split)."""
    t = 134217729.0 * a  # nature: floating point, 2^27 + 1 (Veltkamp)
    a_high = t - (t - a)
    a_low = a - a_high
    t = 134217729.0 * b  # nature: floating point, 2^27 + 1 (Veltkamp)
    b_high = t - (t - b)
    b_low = b - b_high
    return a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)


def _sum_tail(a, b, total):
    """Rounding error of `total` = a + b, exact (Knuth)."""
    b_part = total - a
    a_part = total - b_part
    return (a - a_part) + (b - b_part)


def turn_is_left(ax, ay, bx, by, cx, cy):
    """Whether a, b, c turn left, exactly up to 1e100 m (Shewchuk 1997: the determinant as an expansion of doubles)."""
    terms = [0.0] * 16
    pairs = [bx - ax, 0.0, cy - ay, 0.0, ay - by, 0.0, cx - ax, 0.0]
    pairs[1] = _sum_tail(bx, -ax, pairs[0])
    pairs[3] = _sum_tail(cy, -ay, pairs[2])
    pairs[5] = _sum_tail(ay, -by, pairs[4])
    pairs[7] = _sum_tail(cx, -ax, pairs[6])
    size = 0
    for k in range(0, 8, 4):
        for i in range(2):
            for j in range(2):
                product = pairs[k + i] * pairs[k + 2 + j]
                tail = _product_tail(pairs[k + i], pairs[k + 2 + j], product)
                for m in range(size):
                    total = tail + terms[m]
                    terms[m] = _sum_tail(tail, terms[m], total)
                    tail = total
                terms[size] = tail
                size += 1
                for m in range(size):
                    total = product + terms[m]
                    terms[m] = _sum_tail(product, terms[m], total)
                    product = total
                terms[size] = product
                size += 1
    for m in range(size - 1, -1, -1):  # the largest term that is not 0 has the sign of the sum
        if terms[m] != 0.0:
            return terms[m] > 0.0
    return False


def _is_corner(ax, ay, bx, by, cx, cy, tolerance):
    """Whether b is a corner left of a and c: by more than rounding unless a tip."""
    dx = bx - ax
    dy = by - ay
    lx = cx - ax
    ly = cy - ay
    one = dx * ly
    two = dy * lx
    turn = one - two
    bound = 3.330669073875472e-16 * (abs(one) + abs(two))  # nature: Shewchuk's bound A of this difference
    if turn > bound + tolerance * (abs(lx) + abs(ly)):
        return True
    if turn < -bound or dx * (cx - bx) + dy * (cy - by) >= 0.0:
        return False
    return turn_is_left(ax, ay, bx, by, cx, cy)


def _is_straight(ax, ay, bx, by, cx, cy, tolerance):
    """Whether b lies between a and c, on their line to rounding."""
    dx = bx - ax
    dy = by - ay
    lx = cx - ax
    ly = cy - ay
    one = dx * ly
    two = dy * lx
    # nature: Shewchuk's bound A again
    limit = 3.330669073875472e-16 * (abs(one) + abs(two)) + tolerance * (abs(lx) + abs(ly))
    return abs(one - two) <= limit and dx * (cx - bx) + dy * (cy - by) >= 0.0


def hull_ring(points, way, forth, count, tolerance, ring):
    """Hull of sorted points by Andrew's monotone chain, without vertices on straight edges; returns its size.

    `points`: points (n, 2) in m, finite; `way`: indices (count,): first `forth` candidates of lower chain, sorted by x,
    then y; then those of upper chain, back to lowest; `ring`: receives indices of corners, counter-clockwise from
    lowest x.
    """
    if count == 0:
        return 0
    size = 1
    base = 1
    ring[0] = way[0]
    for step in range(1, count):
        if step == forth:
            base = size
        p = way[step]
        q = ring[size - 1]
        cx = points[p, 0]
        cy = points[p, 1]
        bx = points[q, 0]
        by = points[q, 1]
        if cx == bx and cy == by:
            continue
        while size > base:
            q = ring[size - 2]
            ax = points[q, 0]
            ay = points[q, 1]
            if _is_corner(ax, ay, bx, by, cx, cy, tolerance):
                break
            size -= 1
            bx = ax
            by = ay
        ring[size] = p
        size += 1
    if size == 1:
        return 1
    size -= 1  # the first point again
    # The two ends of the chains, where no turn was asked for, may lie on straight edges.
    if size == 2 or not (
        _ring_is_straight(points, ring[size - 1], ring[0], ring[1], tolerance)
        or _ring_is_straight(points, ring[base - 2], ring[base - 1], ring[base if base < size else 0], tolerance)
    ):
        return size
    kept = 0
    for i in range(size):
        p = ring[i]
        while kept >= 2 and _ring_is_straight(points, ring[kept - 2], ring[kept - 1], p, tolerance):
            kept -= 1
        ring[kept] = p
        kept += 1
    while kept > 2 and _ring_is_straight(points, ring[kept - 2], ring[kept - 1], ring[0], tolerance):
        kept -= 1
    while kept > 2 and _ring_is_straight(points, ring[kept - 1], ring[0], ring[1], tolerance):
        kept -= 1
        for i in range(kept):
            ring[i] = ring[i + 1]
    return kept


def _ring_is_straight(points, a, b, c, tolerance):
    return _is_straight(points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1], tolerance)


def convex_hull(points):
    """`plantar.geometry.polygon.convex_hull`; points are outside by `hull_tolerance` times those left out at most."""
    n = points.shape[0]
    work = np.empty(4 * n, dtype=np.intp)
    ring = work[2 * n :]
    size = hull_of_cloud(points, work, ring)
    out = np.empty((size, 2))
    gather(points, ring, size, out)
    return out


def hull_of_cloud(points, order, ring):
    """Find the hull of points (n, 2), some perhaps not finite, as indices in `ring`; returns its size."""
    count = 0
    tiny = False
    left = _INFINITE
    bottom = _INFINITE
    right = -_INFINITE
    top = -_INFINITE
    for i in range(points.shape[0]):
        x = points[i, 0]
        y = points[i, 1]
        if (0.0 < abs(x) < _TINY) or (0.0 < abs(y) < _TINY):
            tiny = True
        if abs(x) <= _LARGEST and abs(y) <= _LARGEST:  # false for NaN
            order[count] = i
            count += 1
            left = min(left, x)
            right = max(right, x)
            bottom = min(bottom, y)
            top = max(top, y)
    if tiny:
        return hull_of_cloud(_without_tiny(points), order, ring)
    if count == 0:
        return 0
    extent = max(right - left, top - bottom)
    if extent < _SMALLEST:
        ring[0] = order[0]
        return 1
    if count <= _SHORT:
        for i in range(1, count):
            p = order[i]
            x = points[p, 0]
            y = points[p, 1]
            j = i
            while j > 0 and (
                points[order[j - 1], 0] > x or (points[order[j - 1], 0] == x and points[order[j - 1], 1] > y)
            ):
                order[j] = order[j - 1]
                j -= 1
            order[j] = p
    else:
        _sort_many(points, order, count)
    largest = max(max(abs(left), abs(right)), max(abs(bottom), abs(top)))
    for i in range(count - 1):
        order[count + i] = order[count - 2 - i]
    return hull_ring(points, order, count, 2 * count - 1, hull_tolerance(largest, extent), ring)


def _without_tiny(points):
    cloud = np.array(points)
    cloud[np.abs(cloud) < _TINY] = 0.0
    return cloud


def _sort_many(points, order, count):
    index = np.asarray(order)[:count]
    cloud = np.asarray(points)[index]
    index[:] = index[np.lexsort((cloud[:, 1], cloud[:, 0]))]


def gather(points, ring, size, out):
    """Copy the first `size` points (n, 2) of a `ring` of indices to `out`."""
    for i in range(size):
        out[i, 0] = points[ring[i], 0]
        out[i, 1] = points[ring[i], 1]
