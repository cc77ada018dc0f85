"""Kernels on one convex polygon: hull, area, centroid, closest point, margin, inner offset.

Plain Python that also compiles ahead of time: `convex.pxd` beside it gives the C types. Both forms do the same
operations in the same order and agree to the last bit. `plantar.polygon` is the public face, with units and examples;
here points are float64 arrays (n, 2), strided or not, and polygons have no repeated last point.
"""

from __future__ import annotations

import math

import numpy as np

__all__ = [
    "area",
    "area_and_centroid",
    "closest_point",
    "convex_hull",
    "hull_ring",
    "hull_tolerance",
    "inner_offset",
    "seen_from_above",
    "signed_margin",
    "turn_is_left",
]

_LARGEST = 1e100  # coordinates in m beyond this are taken for not finite: their products would overflow
_SMALLEST = 1e-100  # points within a box of this size in m are one: the products of their distances would underflow
_SHORT = 64  # points up to this number are sorted by insertion
_INFINITE = float("inf")
_NONE = float("nan")


def hull_tolerance(largest, extent):
    """How far a corner has to stand out of its neighbours' line to be one.

    Args:
        largest: Largest absolute coordinate in m: its rounding moves points that were meant to be on one line.
        extent: Larger side of the points' box in m.

    Returns:
        Four units in the last place of the largest coordinate, no more than 1e-13 of the extent, in m.
    """
    return min(8.9e-16 * largest, 1e-13 * extent)


def _product_tail(a, b, product):
    """What `product` = a * b lost by rounding, exactly (Dekker; Veltkamp's split)."""
    t = 134217729.0 * a
    a_high = t - (t - a)
    a_low = a - a_high
    t = 134217729.0 * b
    b_high = t - (t - b)
    b_low = b - b_high
    return a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)


def _sum_tail(a, b, total):
    """What `total` = a + b lost by rounding, exactly (Knuth)."""
    b_part = total - a
    a_part = total - b_part
    return (a - a_part) + (b - b_part)


def turn_is_left(ax, ay, bx, by, cx, cy):
    """Whether a, b, c turn left, decided exactly (Shewchuk 1997: the determinant as an expansion of doubles).

    Args:
        ax: Coordinates in m, up to 1e100; likewise ay, bx, by, cx and cy.

    Returns:
        True for a left turn, False for a right turn or a straight line.
    """
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
    """Whether b is a corner to the left of a and c: it turns left, by more than a rounding unless it is a tip."""
    dx, dy = bx - ax, by - ay
    lx, ly = cx - ax, cy - ay
    one, two = dx * ly, dy * lx
    turn = one - two
    bound = 3.330669073875472e-16 * (abs(one) + abs(two))  # Shewchuk's bound A of this difference
    if turn > bound + tolerance * (abs(lx) + abs(ly)):
        return True
    if turn < -bound or dx * (cx - bx) + dy * (cy - by) >= 0.0:
        return False
    return turn_is_left(ax, ay, bx, by, cx, cy)


def _is_straight(ax, ay, bx, by, cx, cy, tolerance):
    """Whether b lies between a and c, off their line by a rounding at most."""
    dx, dy = bx - ax, by - ay
    lx, ly = cx - ax, cy - ay
    one, two = dx * ly, dy * lx
    limit = 3.330669073875472e-16 * (abs(one) + abs(two)) + tolerance * (abs(lx) + abs(ly))
    return abs(one - two) <= limit and dx * (cx - bx) + dy * (cy - by) >= 0.0


def hull_ring(points, way, forth, count, tolerance, ring):
    """Hull of sorted points by Andrew's monotone chain, without vertices on straight edges.

    Each turn is decided by a filtered determinant with an exact one behind it, so the ring is exactly convex. A vertex
    between its neighbours that stands out of their line by no more than the tolerance is left out; nothing else is.

    Args:
        points: Points (n, 2) in m, finite.
        way: Indices (count,): first the points that may lie on the lower chain, sorted by x, then y, from the lowest
            to the highest of all points; then those that may lie on the upper chain, back to the lowest.
        forth: How many of them lie on the way forth.
        count: How many there are.
        tolerance: See `hull_tolerance`.
        ring: Receives the indices of the corners, counter-clockwise from the lowest x; room for count.

    Returns:
        Number of corners.
    """
    if count == 0:
        return 0
    size = base = 1
    ring[0] = way[0]
    for step in range(1, count):
        if step == forth:
            base = size
        p = way[step]
        q = ring[size - 1]
        cx, cy = points[p, 0], points[p, 1]
        bx, by = points[q, 0], points[q, 1]
        if cx == bx and cy == by:
            continue
        while size > base:
            q = ring[size - 2]
            ax, ay = points[q, 0], points[q, 1]
            if _is_corner(ax, ay, bx, by, cx, cy, tolerance):
                break
            size -= 1
            bx, by = ax, ay
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
    """`_is_straight` of three points by index."""
    return _is_straight(points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1], tolerance)


def convex_hull(points):
    """Convex hull of any points.

    Reference: gift wrapping in exact fractions. Vertices are input points; no input point lies outside by more than
    the tolerance of `hull_tolerance` times the number of points left out as straight, in practice a few 1e-16 of the
    largest coordinate.

    Args:
        points: Points (n, 2) in m; those that are not finite are left out.

    Returns:
        Hull (k, 2), counter-clockwise.
    """
    n = points.shape[0]
    work = np.empty(4 * n, dtype=np.intp)
    ring = work[2 * n :]
    size = _hull_of_cloud(points, work, ring)
    out = np.empty((size, 2))
    _gather(points, ring, size, out)
    return out


def _hull_of_cloud(points, order, ring):
    """Sort the finite points, walk them, and return the number of corners in `ring`."""
    count = 0
    left = bottom = _INFINITE
    right = top = -_INFINITE
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        if abs(x) <= _LARGEST and abs(y) <= _LARGEST:  # false for NaN
            order[count] = i
            count += 1
            left, right = min(left, x), max(right, x)
            bottom, top = min(bottom, y), max(top, y)
    if count == 0:
        return 0
    extent = max(right - left, top - bottom)
    if extent < _SMALLEST:
        ring[0] = order[0]
        return 1
    if count <= _SHORT:
        for i in range(1, count):
            p = order[i]
            x, y = points[p, 0], points[p, 1]
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


def _sort_many(points, order, count):
    """Sort the first `count` indices by x, then y."""
    index = np.asarray(order)[:count]
    cloud = np.asarray(points)[index]
    index[:] = index[np.lexsort((cloud[:, 1], cloud[:, 0]))]


def _gather(points, ring, size, out):
    """Copy the points of a ring."""
    for i in range(size):
        out[i, 0] = points[ring[i], 0]
        out[i, 1] = points[ring[i], 1]


def area(polygon):
    """Signed area by the shoelace formula about the first vertex.

    Reference: exact fractions. The error is below 1e-15 times the number of vertices times the square of the extent,
    whatever the distance from the origin.

    Args:
        polygon: Polygon (k, 2) in m, simple.

    Returns:
        Area in m^2, positive for counter-clockwise; 0 for fewer than 3 vertices.
    """
    total = 0.0
    k = polygon.shape[0]
    if k < 3:
        return 0.0
    x0, y0 = polygon[0, 0], polygon[0, 1]
    ax, ay = polygon[1, 0] - x0, polygon[1, 1] - y0
    for i in range(2, k):
        bx, by = polygon[i, 0] - x0, polygon[i, 1] - y0
        total += ax * by - bx * ay
        ax, ay = bx, by
    return 0.5 * total


def area_and_centroid(polygon):
    """Signed area, and the centroid of the area.

    Reference: exact fractions; the centroid's error is below 1e-15 times the extent, for thin polygons divided by
    their width over length.

    Args:
        polygon: Polygon (k, 2) in m, simple, k 1 or more.

    Returns:
        Area in m^2 as `area` gives it, and x and y of the centroid in m: the mean of the vertices where the area is 0.
    """
    k = polygon.shape[0]
    x0, y0 = polygon[0, 0], polygon[0, 1]
    total = cx = cy = mx = my = size = ax = ay = 0.0
    for i in range(1, k):
        bx, by = polygon[i, 0] - x0, polygon[i, 1] - y0
        cross = ax * by - bx * ay
        total += cross
        cx += (ax + bx) * cross
        cy += (ay + by) * cross
        mx += bx
        my += by
        size = max(size, max(abs(bx), abs(by)))
        ax, ay = bx, by
    if abs(total) <= 1e-14 * size * size:
        return 0.5 * total, x0 + mx / k, y0 + my / k
    return 0.5 * total, x0 + cx / (3.0 * total), y0 + cy / (3.0 * total)


def _nearest(polygon, x, y):
    """Signed margin and closest point (T Algorithm 1) of a polygon with 1 vertex or more, as three numbers."""
    k = polygon.shape[0]
    if not (abs(x) <= _LARGEST and abs(y) <= _LARGEST):
        return _NONE, _NONE, _NONE
    total = area(polygon)
    turn = -1.0 if total < 0.0 else 1.0
    inside = k > 2
    deepest = best = _INFINITE
    span = 0.0
    ax, ay = polygon[k - 1, 0], polygon[k - 1, 1]
    for i in range(k):
        bx, by = polygon[i, 0], polygon[i, 1]
        lx, ly = bx - ax, by - ay
        length2 = lx * lx + ly * ly
        across = turn * ((x - ax) * ly - (y - ay) * lx)  # (d x l)_z, above 0 outside
        if across > 0.0:
            inside = False
            break
        span += length2
        if length2 > 0.0:
            deepest = min(deepest, -across / math.sqrt(length2))
        ax, ay = bx, by
    if inside and abs(total) > 1e-14 * span:  # in a polygon without area nothing is inside
        return deepest, x, y
    # Every edge counts: where several are on one line, rounding decides which of them a point lies outside of.
    qx, qy = polygon[0, 0], polygon[0, 1]
    ax, ay = polygon[k - 1, 0], polygon[k - 1, 1]
    for i in range(k):
        bx, by = polygon[i, 0], polygon[i, 1]
        lx, ly = bx - ax, by - ay
        along = (x - ax) * lx + (y - ay) * ly
        length2 = lx * lx + ly * ly
        if along <= 0.0:
            px, py = ax, ay
        elif along >= length2:
            px, py = bx, by
        else:
            t = along / length2
            px, py = ax + t * lx, ay + t * ly
        distance2 = (x - px) * (x - px) + (y - py) * (y - py)
        if distance2 < best:
            best = distance2
            qx, qy = px, py
        ax, ay = bx, by
    return -math.sqrt((x - qx) * (x - qx) + (y - qy) * (y - qy)), qx, qy


def closest_point(polygon, x, y):
    """Point of a convex polygon that is closest to a given one (T Algorithm 1, corrected: either orientation).

    Reference: the smallest of the distances to all edges, in exact fractions. The error is below 1e-15 of the largest
    distance between the point and a vertex, and a rounding of the coordinates.

    Args:
        polygon: Convex polygon (k, 2) in m, k 1 or more.
        x: The point in m.
        y: The same.

    Returns:
        The closest point (2,), the point itself where it is inside; NaN where the point is not finite.
    """
    out = np.empty(2)
    _margin, qx, qy = _nearest(polygon, x, y)
    _pair(out, qx, qy)
    return out


def _pair(out, x, y):
    """Write two numbers."""
    out[0] = x
    out[1] = y


def signed_margin(polygon, x, y):
    """Signed distance of a point to the edge of a convex polygon; reference and error as `closest_point`.

    Args:
        polygon: Convex polygon (k, 2) in m, k 1 or more, either orientation.
        x: The point in m.
        y: The same.

    Returns:
        Distance in m, positive inside, negative outside; NaN where the point is not finite.
    """
    margin, _qx, _qy = _nearest(polygon, x, y)
    return margin


def seen_from_above(polygon, rotation, position):
    """A polygon of one frame's x-y plane, turned, shifted and seen along the other frame's z axis.

    Args:
        polygon: Polygon (k, 2) in m.
        rotation: Rotation (3, 3) from its frame to the other.
        position: Position (3,) of its frame's origin in the other in m.

    Returns:
        Polygon (k, 2) in the other frame in m.
    """
    out = np.empty((polygon.shape[0], 2))
    _place(polygon, rotation, position, out)
    return out


def _place(polygon, rotation, position, out):
    """`seen_from_above` into an array."""
    for i in range(polygon.shape[0]):
        x, y = polygon[i, 0], polygon[i, 1]
        out[i, 0] = rotation[0, 0] * x + rotation[0, 1] * y + position[0]
        out[i, 1] = rotation[1, 0] * x + rotation[1, 1] * y + position[1]


def inner_offset(polygon, distance):
    """Convex polygon of the points that keep a distance from every edge.

    Each edge's half plane, moved inwards, cuts the polygon (Sutherland and Hodgman). Where nothing is left, the depth
    of the deepest point is bisected over the edges that were left last. Reference: the intersection of the half planes
    in exact fractions. Every vertex keeps the distance to 1e-15 of the polygon's size.

    Args:
        polygon: Convex polygon (k, 2) in m, k 3 or more, either orientation.
        distance: Distance in m, above 0.

    Returns:
        Counter-clockwise polygon (m, 2); where nothing is left, the deepest point (1, 2).
    """
    k = polygon.shape[0]
    room = 2 * k + 8
    rings = np.empty((3, room, 3))
    lines = np.empty((k, 3))
    size = _inner_offset(polygon, distance, lines, rings)
    return _shifted(rings, size, polygon)


def _shifted(rings, size, polygon):
    """Ring 0, moved back to the polygon's place; the hull of its corners where rounding far from the origin has turned
    a sliver over."""
    out = np.empty((size, 2))
    ring = out
    for i in range(size):
        ring[i, 0] = rings[0, i, 0] + polygon[0, 0]
        ring[i, 1] = rings[0, i, 1] + polygon[0, 1]
    return convex_hull(ring) if size > 2 and area(ring) < 0.0 else out


def _inner_offset(polygon, distance, lines, rings):
    """Offset a polygon into ring 0, about its first vertex; a ring's third column is the line of the edge that starts
    at the vertex."""
    k = polygon.shape[0]
    backwards = area(polygon) < 0.0
    x0, y0 = polygon[0, 0], polygon[0, 1]
    reach = 0.0
    for i in range(k):
        j = k - 1 - i if backwards else i
        x, y = polygon[j, 0] - x0, polygon[j, 1] - y0
        rings[0, i, 0], rings[0, i, 1], rings[0, i, 2] = x, y, i
        reach = max(reach, max(abs(x), abs(y)))
    used = 0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        ax, ay = rings[0, i, 0], rings[0, i, 1]
        lx, ly = rings[0, j, 0] - ax, rings[0, j, 1] - ay
        length = math.sqrt(lx * lx + ly * ly)
        if length > 0.0:
            lines[used, 0], lines[used, 1] = -ly / length, lx / length
            lines[used, 2] = (lx * ay - ly * ax) / length
            rings[0, i, 2] = used
            used += 1
        else:
            rings[0, i, 2] = 0.0
    size = k
    left = _cut(lines, used, distance, rings, size)
    if left == 0:  # nothing is left: bisect for the depth of the deepest point
        low, high = 0.0, distance if distance < reach else reach
        while high - low > 2e-16 * reach:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            left = _cut(lines, used, middle, rings, size)
            if left == 0:
                high = middle
            else:
                low = middle
                size = left
                used = _keep_lines(lines, used, rings, size)
        x = y = 0.0
        for i in range(size):
            x += rings[0, i, 0] / size
            y += rings[0, i, 1] / size
        rings[0, 0, 0], rings[0, 0, 1] = x, y
        return 1
    size = 0
    for i in range(left):  # without points that coincide
        x, y = rings[0, i, 0], rings[0, i, 1]
        if size == 0 or x != rings[0, size - 1, 0] or y != rings[0, size - 1, 1]:
            rings[0, size, 0], rings[0, size, 1] = x, y
            size += 1
    while size > 1 and rings[0, 0, 0] == rings[0, size - 1, 0] and rings[0, 0, 1] == rings[0, size - 1, 1]:
        size -= 1
    return size


def _keep_lines(lines, used, rings, size):
    """Keep the lines that still bound ring 0: an edge that has vanished stays so at greater depth."""
    kept = 0
    for line in range(used):
        found = False
        for i in range(size):
            if rings[0, i, 2] == line:
                rings[0, i, 2] = kept
                found = True
        if found:
            lines[kept, 0], lines[kept, 1], lines[kept, 2] = lines[line, 0], lines[line, 1], lines[line, 2]
            kept += 1
    return kept


def _cut(lines, used, depth, rings, size):
    """Cut ring 0 by the lines moved inwards; ring 0 becomes the result unless nothing is left."""
    room = rings.shape[1]
    source = 0
    for line in range(used):
        target = 2 if source == 1 else 1
        nx, ny, level = lines[line, 0], lines[line, 1], lines[line, 2] + depth
        ex, ey, tag = rings[source, size - 1, 0], rings[source, size - 1, 1], rings[source, size - 1, 2]
        before = nx * ex + ny * ey - level
        count = 0
        for i in range(size):
            cx, cy = rings[source, i, 0], rings[source, i, 1]
            here = nx * cx + ny * cy - level
            if (here >= 0.0) != (before >= 0.0) and count < room:
                t = before / (before - here)
                rings[target, count, 0], rings[target, count, 1] = ex + t * (cx - ex), ey + t * (cy - ey)
                rings[target, count, 2] = line if before >= 0.0 else tag
                count += 1
            tag = rings[source, i, 2]
            if here >= 0.0 and count < room:
                rings[target, count, 0], rings[target, count, 1], rings[target, count, 2] = cx, cy, tag
                count += 1
            ex, ey, before = cx, cy, here
        source = target
        size = count
        if size == 0:
            return 0
    for i in range(size):
        for j in range(3):
            rings[0, i, j] = rings[source, i, j]
    return size
