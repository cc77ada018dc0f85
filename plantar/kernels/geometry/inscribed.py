# cython: infer_types=True
"""Ends of a flat clean ring, and the largest triangle and circle in one.

A ring is flat, x0, y0, x1, y1, ..., of n vertices, 3 or more, counter-clockwise and near the origin. They write to
`out` and return the size.
"""

import math

__all__ = ["ends_of_flat", "largest_circle", "largest_triangle"]


def ends_of_flat(ring, n):
    """Write the ends of a ring without area (1e-14 of its size squared) into it; its size: 2, else n."""
    x0 = ring[0]
    y0 = ring[1]
    far = 0  # the vertex farthest from the first
    size = 0.0
    twice = 0.0
    ux = 0.0
    uy = 0.0
    for i in range(1, n):
        wx = ring[2 * i] - x0
        wy = ring[2 * i + 1] - y0
        twice += ux * wy - wx * uy
        ux = wx
        uy = wy
        reach = max(abs(wx), abs(wy))
        if reach > size:
            size = reach
            far = i
    if twice > 2e-14 * size * size:  # nature: floating point, a hundred roundings of an area
        return n
    # The ends are the extremes along the direction to it.
    dx = ring[2 * far] - x0
    dy = ring[2 * far + 1] - y0
    low = 0
    high = 0
    for i in range(1, n):
        along = ring[2 * i] * dx + ring[2 * i + 1] * dy
        if along < ring[2 * low] * dx + ring[2 * low + 1] * dy:
            low = i
        if along > ring[2 * high] * dx + ring[2 * high + 1] * dy:
            high = i
    ax = ring[2 * low]
    ay = ring[2 * low + 1]
    bx = ring[2 * high]
    by = ring[2 * high + 1]
    ring[0] = ax
    ring[1] = ay
    ring[2] = bx
    ring[3] = by
    return 2


def largest_triangle(ring, n, out):
    """Largest triangle on a ring's vertices: the third corner walks with the second."""
    best = -1.0
    bi = 0
    bj = 1
    bk = 2
    for i in range(n - 2):
        ax = ring[2 * i]
        ay = ring[2 * i + 1]
        k = i + 2
        for j in range(i + 1, n - 1):
            if k <= j:
                k = j + 1
            ux = ring[2 * j] - ax
            uy = ring[2 * j + 1] - ay
            height = ux * (ring[2 * k + 1] - ay) - uy * (ring[2 * k] - ax)
            while k + 1 < n:
                after = ux * (ring[2 * k + 3] - ay) - uy * (ring[2 * k + 2] - ax)
                if after < height:
                    break
                height = after
                k += 1
            if height > best:
                best = height
                bi = i
                bj = j
                bk = k
    out[0] = ring[2 * bi]
    out[1] = ring[2 * bi + 1]
    out[2] = ring[2 * bj]
    out[3] = ring[2 * bj + 1]
    out[4] = ring[2 * bk]
    out[5] = ring[2 * bk + 1]
    return 0.5 * best


def largest_circle(ring, n, work, out):
    """Center x, y of the largest circle in a ring; returns the radius.

    The least distance to an edge is concave; so is its largest value over y at an x. Cuts (tangents) find both. `work`
    has room for 3 n + 2 numbers.
    """
    x_low = ring[0]
    x_high = x_low
    y_low = ring[1]
    y_high = y_low
    for i in range(n):  # of edge i: unit normal inwards, level of its line
        j = i + 1 if i + 1 < n else 0
        dx = ring[2 * j] - ring[2 * i]
        dy = ring[2 * j + 1] - ring[2 * i + 1]
        length = math.sqrt(dx * dx + dy * dy)
        work[3 * i] = -dy / length
        work[3 * i + 1] = dx / length
        work[3 * i + 2] = (dx * ring[2 * i + 1] - dy * ring[2 * i]) / length
        x_low = min(x_low, ring[2 * i])
        x_high = max(x_high, ring[2 * i])
        y_low = min(y_low, ring[2 * i + 1])
        y_high = max(y_high, ring[2 * i + 1])
    size = x_high - x_low + y_high - y_low
    best = -1.0
    best_x = 0.5 * (x_low + x_high)
    best_y = 0.5 * (y_low + y_high)
    left = x_low  # where the cuts touch, how deep, and how they rise; from the ends, where nothing is deep
    left_depth = 0.0
    left_slope = 1.0
    right = x_high
    right_depth = 0.0
    right_slope = -1.0
    x = best_x
    y = best_y
    for step in range(2 * n + 40):
        depth = _deepest(work, n, x, y, y_low, y_high, 1e-16 * size)  # nature: floating point, half of a rounding
        y = work[3 * n]
        slope = work[3 * n + 1]
        if depth > best:
            best = depth
            best_x = x
            best_y = y
        expected = left_depth + left_slope * (x - left)
        if slope == 0.0 or (step > 0 and depth >= expected - 1e-16 * size):  # nature: half a rounding
            break
        if slope > 0.0:
            left = x
            left_depth = depth
            left_slope = slope
        else:
            right = x
            right_depth = depth
            right_slope = slope
        x = left + (right_depth - left_depth + right_slope * (left - right)) / (left_slope - right_slope)
        if not left < x < right:
            break
    radius = -1.0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx = ring[2 * j] - ring[2 * i]
        dy = ring[2 * j + 1] - ring[2 * i + 1]
        gap = (dx * (best_y - ring[2 * i + 1]) - dy * (best_x - ring[2 * i])) / math.sqrt(dx * dx + dy * dy)
        if radius < 0.0 or gap < radius:
            radius = gap if gap > 0.0 else 0.0
    out[0] = best_x
    out[1] = best_y
    return radius


def _deepest(work, n, x, start, low, high, tolerance):
    """Greatest depth over y at an x; writes y and its slope in x after the lines."""
    rising = -1  # the lines that bound the depth: one that rises with y, one that falls
    falling = -1
    y = start
    expected = 0.0
    depth = 0.0
    slope = 0.0
    for _ in range(n + 8):
        lowest = 0
        depth = work[0] * x + work[1] * y - work[2]
        for i in range(1, n):
            gap = work[3 * i] * x + work[3 * i + 1] * y - work[3 * i + 2]
            if gap < depth:
                depth = gap
                lowest = i
        slope = work[3 * lowest]
        steep = work[3 * lowest + 1]
        if rising >= 0 and falling >= 0:
            share = work[3 * falling + 1] / (work[3 * falling + 1] - work[3 * rising + 1])
            slope = share * work[3 * rising] + (1.0 - share) * work[3 * falling]
            if lowest in (rising, falling) or depth >= expected - tolerance:
                break
        if steep > 0.0:
            rising = lowest
            if falling < 0:
                if y >= high:
                    break
                y = high
                continue
        elif steep < 0.0:
            falling = lowest
            if rising < 0:
                if y <= low:
                    break
                y = low
                continue
        else:
            slope = work[3 * lowest]
            break
        a = work[3 * rising] * x - work[3 * rising + 2]
        y = (work[3 * falling] * x - work[3 * falling + 2] - a) / (work[3 * rising + 1] - work[3 * falling + 1])
        expected = a + work[3 * rising + 1] * y
    work[3 * n] = y
    work[3 * n + 1] = slope
    return depth
