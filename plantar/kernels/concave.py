# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel for the largest rectangle in an outline with islands and holes, exact.

Plain Python that also compiles ahead of time (`concave.pxd` gives the C types). `plantar.inscribed` is the public face.
"""

from __future__ import annotations

import math

import numpy as np

from . import rectangle

__all__ = ["largest_rectangle_in_outline"]


def largest_rectangle_in_outline(points, starts, angle, floor, out):
    """Largest rectangle in an outline whose first side stands at an angle.

    Lines across through every vertex cut the area into trapezoids in slabs. A rectangle starts in one trapezoid, ends
    in another one and crosses those between; what it may then use is convex: a window in y, and the slants of the
    first and the last trapezoid. Branch and bound over the pairs: the box of the window bounds what a pair can give,
    and the pairs that are left are solved as convex polygons.

    Args:
        points: Vertices, flat (2 m,), near the origin, the area on the left of each ring.
        starts: Offsets (r + 1,) of the rings.
        angle: Angle of the first side in rad.
        floor: Look for more than this area only; 0 to find the largest.
        out: Receives the 4 corners, flat, counter-clockwise; untouched unless the area is above the floor.

    Returns:
        Its area; the floor where there is none above it.
    """
    m = len(points) // 2
    cosine = math.cos(angle)
    sine = math.sin(angle)
    across = np.empty(m)
    upward = np.empty(m)
    xs = across
    ys = upward
    for i in range(m):
        xs[i] = cosine * points[2 * i] + sine * points[2 * i + 1]
        ys[i] = cosine * points[2 * i + 1] - sine * points[2 * i]
    order = np.argsort(across)
    rank = np.empty(m, dtype=np.intp)
    line = np.empty(m)
    lines = 0
    tolerance = 1e-14 * (xs[order[m - 1]] - xs[order[0]])
    for k in range(m):
        i = order[k]
        if k == 0 or xs[i] - line[lines - 1] > tolerance:
            line[lines] = xs[i]
            lines += 1
        rank[i] = lines - 1
    slabs = lines - 1
    if slabs < 1:
        return floor
    # Of each slab the edges across it, from the lowest: y on its left and right, and +1 below or -1 above the area.
    first = np.zeros(slabs + 1, dtype=np.intp)
    total = 0
    for r in range(len(starts) - 1):
        i = starts[r + 1] - 1
        for j in range(starts[r], starts[r + 1]):
            low = min(rank[i], rank[j])
            high = max(rank[i], rank[j])
            for k in range(low, high):
                first[k + 1] += 1
            total += high - low
            i = j
    for k in range(slabs):
        first[k + 1] += first[k]
    filled = np.zeros(slabs, dtype=np.intp)
    edge = np.empty(3 * total)
    for r in range(len(starts) - 1):
        i = starts[r + 1] - 1
        for j in range(starts[r], starts[r + 1]):
            a = i
            b = j
            side = 1.0
            if rank[i] > rank[j]:
                a = j
                b = i
                side = -1.0
            low = rank[a]
            high = rank[b]
            left = ys[a]
            for k in range(low, high):
                right = ys[b]
                if k + 1 < high:
                    right = ys[a] + (ys[b] - ys[a]) * ((line[k + 1] - line[low]) / (line[high] - line[low]))
                p = first[k] + filled[k]
                while p > first[k] and edge[3 * p - 3] + edge[3 * p - 2] > left + right:
                    edge[3 * p] = edge[3 * p - 3]
                    edge[3 * p + 1] = edge[3 * p - 2]
                    edge[3 * p + 2] = edge[3 * p - 1]
                    p -= 1
                edge[3 * p] = left
                edge[3 * p + 1] = right
                edge[3 * p + 2] = side
                filled[k] += 1
                left = right
            i = j
    # Trapezoids: bottom and top on the left, bottom and top on the right.
    trapezoid = np.empty(2 * total)
    slab = np.empty(total // 2 + 1, dtype=np.intp)
    count = 0
    for k in range(slabs):
        depth = 0.0
        p = first[k]
        q = first[k + 1]
        first[k] = count
        bottom = p
        while p < q:
            if depth <= 0.0 and depth + edge[3 * p + 2] > 0.0:
                bottom = p
            elif depth > 0.0 and depth + edge[3 * p + 2] <= 0.0:
                trapezoid[4 * count] = edge[3 * bottom]
                trapezoid[4 * count + 1] = edge[3 * p]
                trapezoid[4 * count + 2] = edge[3 * bottom + 1]
                trapezoid[4 * count + 3] = edge[3 * p + 1]
                slab[count] = k
                count += 1
            depth += edge[3 * p + 2]
            p += 1
    first[slabs] = count
    best = floor
    x1 = 0.0
    x2 = 0.0
    y1 = 0.0
    y2 = 0.0
    found = False
    stack = np.empty(3 * count + 3)
    ring = np.empty(18)
    work = np.empty(80)
    corner = np.empty(8)
    # First pass: rectangles between lines, a good start. Second pass: whatever a pair of trapezoids may still give.
    for exact in range(2):
        for start in range(count):
            i = slab[start]
            below = trapezoid[4 * start]
            above = trapezoid[4 * start + 1]
            low_right = trapezoid[4 * start + 2]
            high_right = trapezoid[4 * start + 3]
            box = (line[i + 1] - line[i]) * (max(above, high_right) - min(below, low_right))
            if box > best:
                if exact:
                    n = _octagon(
                        line[i],
                        line[i + 1],
                        line[i],
                        line[i + 1],
                        min(below, low_right),
                        max(above, high_right),
                        trapezoid,
                        start,
                        start,
                        ring,
                    )
                    if n >= 3:
                        area = rectangle.largest_rectangle(ring, n, 0.0, best, work, corner)
                        if area > best:
                            best = area
                            x1 = corner[0]
                            y1 = corner[1]
                            x2 = corner[4]
                            y2 = corner[5]
                            found = True
                else:
                    area = (line[i + 1] - line[i]) * (min(above, high_right) - max(below, low_right))
                    if area > best:
                        best = area
                        x1 = line[i]
                        x2 = line[i + 1]
                        y1 = max(below, low_right)
                        y2 = min(above, high_right)
                        found = True
            top = 0
            if (line[slabs] - line[i]) * (high_right - low_right) > best:
                stack[0] = start
                stack[1] = low_right
                stack[2] = high_right
                top = 1
            while top > 0:
                top -= 1
                t = int(stack[3 * top])
                low_y = stack[3 * top + 1]
                high_y = stack[3 * top + 2]
                if (line[slabs] - line[i]) * (high_y - low_y) <= best:
                    continue
                k = slab[t] + 1
                if k >= slabs:
                    continue
                for t in range(first[k], first[k + 1]):
                    bottom_y = max(low_y, trapezoid[4 * t])
                    top_y = min(high_y, trapezoid[4 * t + 1])
                    if top_y <= bottom_y:
                        continue
                    if (line[k + 1] - line[i]) * (top_y - bottom_y) > best:
                        if exact:
                            n = _octagon(
                                line[i], line[i + 1], line[k], line[k + 1], bottom_y, top_y, trapezoid, start, t, ring
                            )
                            if n >= 3:
                                area = rectangle.largest_rectangle(ring, n, 0.0, best, work, corner)
                                if area > best:
                                    best = area
                                    x1 = corner[0]
                                    y1 = corner[1]
                                    x2 = corner[4]
                                    y2 = corner[5]
                                    found = True
                        else:
                            inner_low = max(bottom_y, below)
                            inner_high = min(top_y, above)
                            area = (line[k] - line[i]) * (inner_high - inner_low)
                            if area > best:
                                best = area
                                x1 = line[i]
                                x2 = line[k]
                                y1 = inner_low
                                y2 = inner_high
                                found = True
                    bottom_y = max(bottom_y, trapezoid[4 * t + 2])
                    top_y = min(top_y, trapezoid[4 * t + 3])
                    if top_y <= bottom_y:
                        continue
                    if not exact:
                        area = (line[k + 1] - line[i + 1]) * (top_y - bottom_y)
                        if area > best:
                            best = area
                            x1 = line[i + 1]
                            x2 = line[k + 1]
                            y1 = bottom_y
                            y2 = top_y
                            found = True
                        inner_low = max(bottom_y, below)
                        inner_high = min(top_y, above)
                        area = (line[k + 1] - line[i]) * (inner_high - inner_low)
                        if area > best:
                            best = area
                            x1 = line[i]
                            x2 = line[k + 1]
                            y1 = inner_low
                            y2 = inner_high
                            found = True
                    if (line[slabs] - line[i]) * (top_y - bottom_y) > best:
                        stack[3 * top] = t
                        stack[3 * top + 1] = bottom_y
                        stack[3 * top + 2] = top_y
                        top += 1
    if found:
        out[0] = cosine * x1 - sine * y1
        out[1] = sine * x1 + cosine * y1
        out[2] = cosine * x2 - sine * y1
        out[3] = sine * x2 + cosine * y1
        out[4] = cosine * x2 - sine * y2
        out[5] = sine * x2 + cosine * y2
        out[6] = cosine * x1 - sine * y2
        out[7] = sine * x1 + cosine * y2
    return best


def _octagon(xa, xb, xc, xd, low, high, trapezoid, start, end, ring):
    """What a rectangle may use that starts in one trapezoid and ends in another: a window, cut by their slants.

    Args:
        xa: Left side of the first trapezoid in m; xb its right side, xc and xd those of the last one.
        low: Bottom of the window in m, at or above the bottoms at xb and xc; likewise high.
        trapezoid: Bottom and top on the left, bottom and top on the right, of each trapezoid.
        start: Index of the first trapezoid; end of the last one.
        ring: Receives the vertices, counter-clockwise.

    Returns:
        Number of vertices, up to 8; 0 where nothing is left.
    """
    n = 0
    # Lower left, lower right, upper right, upper left: y of the slant on the outer and on the inner side.
    for corner in range(4):
        outer_x = xa
        inner_x = xb
        t = 4 * start
        if corner == 1 or corner == 2:
            outer_x = xd
            inner_x = xc
            t = 4 * end + 2
        inner_t = t + 2 if corner == 0 or corner == 3 else t - 2
        if corner < 2:
            mine = trapezoid[t]
            inner = trapezoid[inner_t]
            other = trapezoid[t + 1]
            other_inner = trapezoid[inner_t + 1]
            level = low
            far = high
            cut = mine > low
            gone = mine > high
            other_gone = other < low
        else:
            mine = trapezoid[t + 1]
            inner = trapezoid[inner_t + 1]
            other = trapezoid[t]
            other_inner = trapezoid[inner_t]
            level = high
            far = low
            cut = mine < high
            gone = mine < low
            other_gone = other > high
        # Where the slant meets the window's side, and the point on the outer side.
        bx = outer_x
        by = level
        ax = outer_x
        ay = level
        has_two = False
        if cut:
            share = (level - mine) / (inner - mine)
            bx = outer_x + (inner_x - outer_x) * share
            if gone:  # the outer side is all cut off: the slant ends at the window's other side
                share = (far - mine) / (inner - mine)
                ax = outer_x + (inner_x - outer_x) * share
                ay = far
            else:
                ay = mine
            has_two = True
        elif other_gone:  # cut off by the other slant, which meets this side
            share = (level - other) / (other_inner - other)
            bx = outer_x + (inner_x - outer_x) * share
        # Counter-clockwise: lower left goes down to the bottom, lower right leaves it, and so on round.
        if corner == 0 or corner == 2:
            if has_two:
                n = _add(ring, n, ax, ay)
            n = _add(ring, n, bx, by)
        else:
            n = _add(ring, n, bx, by)
            if has_two:
                n = _add(ring, n, ax, ay)
    while n > 1 and ring[2 * n - 2] == ring[0] and ring[2 * n - 1] == ring[1]:
        n -= 1
    return n


def _add(ring, n, x, y):
    """Add a vertex to a ring of n unless it repeats the last one; the new number of vertices."""
    if n > 0 and ring[2 * n - 2] == x and ring[2 * n - 1] == y:
        return n
    ring[2 * n] = x
    ring[2 * n + 1] = y
    return n + 1
