"""Kernels on one convex polygon (n, 2) without repeated last point."""

from __future__ import annotations

import math

import numpy as np

from ..base import memory, vectors
from . import clean

__all__ = [
    "OffsetRoom",
    "area",
    "area_and_centroid",
    "area_of",
    "closest_point",
    "inner_offset",
    "margin_of_clean",
    "nearest",
    "offset",
    "seen_from_above",
    "signed_margin",
]

# coordinates in m beyond this count as not finite: their products would overflow; nature: floating point
_LARGEST = 1e100
_INFINITE = float("inf")
_NONE = float("nan")
# nature: of a polygon's extent: corners of its inner offset that are nearer to each other are one; five roundings of
# floating point
_NOISE = 1e-15
# vertices: room for polygons of up to so many is kept; chosen: a speed alone depends on it; footprints have up to 40
# corners
_FEW = 64


def area(polygon):
    """Signed area in m^2 of a simple polygon (k, 2) (shoelace about the first vertex); 0 below 3 vertices.

    Error below 1e-15 times vertices times extent^2.
    """
    total = 0.0
    k = polygon.shape[0]
    if k < 3:
        return 0.0
    x0 = polygon[0, 0]
    y0 = polygon[0, 1]
    ax = polygon[1, 0] - x0
    ay = polygon[1, 1] - y0
    for i in range(2, k):
        bx = polygon[i, 0] - x0
        by = polygon[i, 1] - y0
        total += ax * by - bx * ay
        ax = bx
        ay = by
    return 0.5 * total


def area_of(polygon):
    """`area` of a polygon from Python."""
    room = _borrow(0)
    total = area(_entered(polygon, room))
    _FREE.append(room)
    return total


def area_and_centroid(polygon):
    """Signed area in m^2, and centroid x, y in m of a simple polygon (k, 2), k above 0.

    The vertices' mean without area; its error is below 1e-15 times the extent; for thin polygons over their width per
    length.
    """
    k = polygon.shape[0]
    x0 = polygon[0, 0]
    y0 = polygon[0, 1]
    total = 0.0
    cx = 0.0
    cy = 0.0
    mx = 0.0
    my = 0.0
    size = 0.0
    ax = 0.0
    ay = 0.0
    for i in range(1, k):
        bx = polygon[i, 0] - x0
        by = polygon[i, 1] - y0
        cross = ax * by - bx * ay
        total += cross
        cx += (ax + bx) * cross
        cy += (ay + by) * cross
        mx += bx
        my += by
        size = max(size, max(abs(bx), abs(by)))
        ax = bx
        ay = by
    if abs(total) <= 1e-14 * size * size:  # nature: floating point, fifty roundings of the area's terms
        return 0.5 * total, x0 + mx / k, y0 + my / k
    # nature: the centroid of a triangle is a third of its corners
    return 0.5 * total, x0 + cx / (3.0 * total), y0 + cy / (3.0 * total)


def _nearest(polygon, turn, x, y):
    """Signed margin and closest point (T Algorithm 1), as three numbers.

    `polygon`: ring (k, 2) in m: clean, or of 1 or 2 vertices; `turn`: 1.0 for counter-clockwise, else -1.0; `x`: point
    in m; likewise y.
    """
    k = polygon.shape[0]
    if not (abs(x) <= _LARGEST and abs(y) <= _LARGEST):
        return _NONE, _NONE, _NONE
    inside = k > 2
    deepest = _INFINITE
    best = _INFINITE
    span = 0.0
    ax = polygon[k - 1, 0]
    ay = polygon[k - 1, 1]
    for i in range(k):
        bx = polygon[i, 0]
        by = polygon[i, 1]
        lx = bx - ax
        ly = by - ay
        length2 = lx * lx + ly * ly
        across = turn * ((x - ax) * ly - (y - ay) * lx)  # (d x l)_z, above 0 outside
        if across > 0.0:
            inside = False
            break
        span += length2
        if length2 > 0.0:
            deepest = min(deepest, -across / math.sqrt(length2))
        ax = bx
        ay = by
    # nature: floating point, the square of a hundred roundings (3e-14), and 1e-14 those of an area
    if inside and (deepest * deepest > 1e-27 * k * span or abs(area(polygon)) > 1e-14 * span):
        return deepest, x, y  # else it has no area, and nothing is inside
    # Every edge counts: where several are on one line, rounding decides which of them a point lies outside of.
    qx = polygon[0, 0]
    qy = polygon[0, 1]
    ax = polygon[k - 1, 0]
    ay = polygon[k - 1, 1]
    for i in range(k):
        bx = polygon[i, 0]
        by = polygon[i, 1]
        lx = bx - ax
        ly = by - ay
        along = (x - ax) * lx + (y - ay) * ly
        length2 = lx * lx + ly * ly
        if along <= 0.0:
            px = ax
            py = ay
        elif along >= length2:
            px = bx
            py = by
        else:
            t = along / length2
            px = ax + t * lx
            py = ay + t * ly
        distance2 = (x - px) * (x - px) + (y - py) * (y - py)
        if distance2 < best:
            best = distance2
            qx = px
            qy = py
        ax = bx
        ay = by
    return -math.sqrt((x - qx) * (x - qx) + (y - qy) * (y - qy)), qx, qy


def margin_of_clean(polygon, x, y):
    """`signed_margin` of a counter-clockwise clean ring (k, 2), or of 1 or 2 vertices."""
    margin, _qx, _qy = _nearest(polygon, 1.0, x, y)
    return margin


def _nearest_of_any(polygon, x, y):
    """`_nearest` of any ring, cleaned; -inf and NaN for an empty one."""
    turn = clean.turning(polygon, 0.0, 0.0, 0.0)
    if turn != 0:
        return _nearest(polygon, turn, x, y)
    ring = clean.clean_ring(polygon, 0.0, 0.0, 0.0)
    corners = ring
    if corners.shape[0] == 0:
        return -_INFINITE, _NONE, _NONE
    return _nearest(corners, 1.0, x, y)


def closest_point(polygon, x, y):
    """`plantar.geometry.polygon.closest_point` (2,) to x, y in m; NaN where the point, or no vertex, is finite.

    Error below 1e-15 of the largest distance.
    """
    qx, qy = nearest(polygon, x, y)
    return vectors.vector2(qx, qy)


def nearest(polygon, x, y):
    """`closest_point` as two numbers."""
    room = _borrow(0)  # of a polygon of more than a few vertices its buffer is read
    _margin, qx, qy = _nearest_of_any(_entered(polygon, room), x, y)
    _FREE.append(room)
    return qx, qy


def signed_margin(polygon, x, y):
    """`plantar.geometry.polygon.signed_margin` of x, y in m; NaN for no finite point, -inf for no finite vertex."""
    room = _borrow(0)
    margin, _qx, _qy = _nearest_of_any(_entered(polygon, room), x, y)
    _FREE.append(room)
    return margin


def seen_from_above(polygon, rotation, position):
    """A polygon (k, 2) in m of a frame's x-y plane, seen along another's z axis.

    `rotation`: rotation (3, 3) from its frame to the other; `position`: position (3,) of its frame's origin in the
    other in m.
    """
    out = np.empty((polygon.shape[0], 2))
    _place(polygon, rotation, position, out)
    return out


def _place(polygon, rotation, position, out):
    for i in range(polygon.shape[0]):
        x = polygon[i, 0]
        y = polygon[i, 1]
        out[i, 0] = rotation[0, 0] * x + rotation[0, 1] * y + position[0]
        out[i, 1] = rotation[1, 0] * x + rotation[1, 1] * y + position[1]


class OffsetRoom:
    """Work arrays of one inner offset, up to `corners` vertices."""

    def __init__(self, corners):
        room = 2 * corners + 8
        self.given = np.zeros((corners, 2))
        self.lines = np.zeros((corners, 3))
        self.rings = np.zeros((3, room, 3))
        self.result = np.zeros((room, 2))

    def copied(self, size):
        """The `size` vertices of `result` as a new array."""
        return vectors.points_of(self.result, size)


_FREE: list = []  # type: ignore[type-arg]  # rooms for `_FEW` vertices that no call has borrowed


def _borrow(corners):
    """Room for so many vertices; a small one returns to `_FREE`."""
    if corners > _FEW:
        return OffsetRoom(corners)
    try:
        return _FREE.pop()
    except IndexError:
        return OffsetRoom(_FEW)


def _entered(polygon, room):
    """Polygon (k, 2) copied into a room."""
    k = memory.rows(polygon, 2)
    if not 0 <= k <= room.given.shape[0]:
        return polygon
    given = room.given
    values = memory.values(polygon)
    for i in range(k):
        given[i, 0] = values[2 * i]
        given[i, 1] = values[2 * i + 1]
    return given[:k]


def inner_offset(polygon, distance):
    """`plantar.geometry.polygon.inner_offset` by a distance above 0 in m of a polygon with a vertex.

    Each edge's half plane, moved inwards, cuts the polygon (Sutherland and Hodgman); if all is cut away, the deepest
    point is found by bisection. (0, 2) where no vertex is finite.
    """
    room = _borrow(len(polygon))
    found = room.copied(offset(_entered(polygon, room), distance, room))
    if len(polygon) <= _FEW:
        _FREE.append(room)
    return found


def offset(polygon, distance, room):
    """`inner_offset` of a polygon by a distance into a room's `result`; returns its size."""
    i = clean.anchor(polygon)
    x0 = polygon[i, 0]
    y0 = polygon[i, 1]
    turn = clean.turning(polygon, x0, y0, 0.0)
    if turn != 0:
        near = _NOISE * clean.extent(polygon)
        size = _inner_offset(polygon, x0, y0, turn < 0, distance, room.lines, room.rings)
    else:
        ring = clean.clean_ring(polygon, x0, y0, 0.0)
        corners = ring
        near = _NOISE * clean.extent(corners)
        size = corners.shape[0]
        if size > 2:
            size = _inner_offset(corners, 0.0, 0.0, False, distance, room.lines, room.rings)
        elif size > 0:
            room.rings[0, 0, 0] = 0.5 * (corners[0, 0] + corners[size - 1, 0])
            room.rings[0, 0, 1] = 0.5 * (corners[0, 1] + corners[size - 1, 1])
            size = 1
    return _shifted(room, size, x0, y0, near)


def _shifted(room, size, x0, y0, near):
    """Ring 0, moved back to its place and cleaned of near-duplicates and slivers."""
    rings = room.rings
    result = room.result
    for i in range(size):
        result[i, 0] = rings[0, i, 0] + x0
        result[i, 1] = rings[0, i, 1] + y0
    if size < 2 or clean.turning(result[:size], 0.0, 0.0, near) > 0:
        return size
    ring = clean.clean_ring(result[:size], 0.0, 0.0, near)
    corners = ring
    for i in range(corners.shape[0]):
        result[i, 0] = corners[i, 0]
        result[i, 1] = corners[i, 1]
    return corners.shape[0]


def _inner_offset(polygon, x0, y0, backwards, distance, lines, rings):
    """Offset a clean polygon into ring 0, about a point; the third column is the edge's line."""
    k = polygon.shape[0]
    reach = 0.0
    for i in range(k):
        j = k - 1 - i if backwards else i
        x = polygon[j, 0] - x0
        y = polygon[j, 1] - y0
        rings[0, i, 0] = x
        rings[0, i, 1] = y
        rings[0, i, 2] = i
        reach = max(reach, max(abs(x), abs(y)))
    used = 0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        ax = rings[0, i, 0]
        ay = rings[0, i, 1]
        lx = rings[0, j, 0] - ax
        ly = rings[0, j, 1] - ay
        length = math.sqrt(lx * lx + ly * ly)
        if length > 0.0:
            lines[used, 0] = -ly / length
            lines[used, 1] = lx / length
            lines[used, 2] = (lx * ay - ly * ax) / length
            rings[0, i, 2] = used
            used += 1
        else:
            rings[0, i, 2] = 0.0
    size = k
    left = _cut(lines, used, distance, rings, size)
    if left == 0:  # nothing is left: bisect for the depth of the deepest point
        low = 0.0
        high = distance if distance < reach else reach
        while high - low > 2e-16 * reach:  # nature: floating point, one rounding: the bisection ends at the last bit
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
        x = 0.0
        y = 0.0
        for i in range(size):
            x += rings[0, i, 0] / size
            y += rings[0, i, 1] / size
        rings[0, 0, 0] = x
        rings[0, 0, 1] = y
        return 1
    return left


def _keep_lines(lines, used, rings, size):
    """Keep lines that still bound ring 0: vanished edges stay so."""
    kept = 0
    for line in range(used):
        found = False
        for i in range(size):
            if rings[0, i, 2] == line:
                rings[0, i, 2] = kept
                found = True
        if found:
            lines[kept, 0] = lines[line, 0]
            lines[kept, 1] = lines[line, 1]
            lines[kept, 2] = lines[line, 2]
            kept += 1
    return kept


def _cut(lines, used, depth, rings, size):
    """Cut ring 0 by the lines moved inwards, unless empty."""
    room = rings.shape[1]
    source = 0
    for line in range(used):
        target = 2 if source == 1 else 1
        nx = lines[line, 0]
        ny = lines[line, 1]
        level = lines[line, 2] + depth
        ex = rings[source, size - 1, 0]
        ey = rings[source, size - 1, 1]
        tag = rings[source, size - 1, 2]
        before = nx * ex + ny * ey - level
        count = 0
        for i in range(size):
            cx = rings[source, i, 0]
            cy = rings[source, i, 1]
            here = nx * cx + ny * cy - level
            if (here >= 0.0) != (before >= 0.0) and count < room:
                t = before / (before - here)
                rings[target, count, 0] = ex + t * (cx - ex)
                rings[target, count, 1] = ey + t * (cy - ey)
                rings[target, count, 2] = line if before >= 0.0 else tag
                count += 1
            tag = rings[source, i, 2]
            if here >= 0.0 and count < room:
                rings[target, count, 0] = cx
                rings[target, count, 1] = cy
                rings[target, count, 2] = tag
                count += 1
            ex = cx
            ey = cy
            before = here
        source = target
        size = count
        if size == 0:
            return 0
    for i in range(size):
        for j in range(3):
            rings[0, i, j] = rings[source, i, j]
    return size
