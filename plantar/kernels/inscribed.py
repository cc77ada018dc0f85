# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernels on a convex ring: clean ring, largest inscribed triangle, parallelogram and circle.

A ring is a flat sequence x0, y0, x1, y1, ... of n vertices. Every kernel but `clean_ring` takes a clean ring: convex,
counter-clockwise, without repeated vertices, in coordinates near the origin, with an area. `plantar.inscribed` holds
the functions to call.
"""

from __future__ import annotations

import math

__all__ = ["clean_ring", "largest_circle", "largest_parallelogram", "largest_triangle"]

_LARGEST = 1e100  # coordinates in m beyond this are taken for not finite: their products would overflow
_SMALLEST = 1e-100  # vertices no farther apart than this in m are one: products of distances would underflow


def clean_ring(ring, n):
    """Clean a ring in place: counter-clockwise, without repeated or non-finite vertices.

    Args:
        ring: The n vertices, flat, the first one at the origin.
        n: Number of vertices.

    Returns:
        Number of vertices left: 0, 1, 2 (the ends of a ring without area: at most 1e-14 of its size squared), or more.
    """
    count = 0
    size = 0.0
    for i in range(n):
        x = ring[2 * i]
        y = ring[2 * i + 1]
        if not (abs(x) <= _LARGEST and abs(y) <= _LARGEST):
            continue
        if count > 0 and abs(x - ring[2 * count - 2]) <= _SMALLEST and abs(y - ring[2 * count - 1]) <= _SMALLEST:
            continue
        ring[2 * count] = x
        ring[2 * count + 1] = y
        count += 1
        size = max(size, abs(x), abs(y))
    while count > 1 and abs(ring[2 * count - 2]) <= _SMALLEST and abs(ring[2 * count - 1]) <= _SMALLEST:
        count -= 1
    if count < 3:
        return count
    twice = 0.0
    for i in range(1, count - 1):
        twice += ring[2 * i] * ring[2 * i + 3] - ring[2 * i + 2] * ring[2 * i + 1]
    if not abs(twice) > 2e-14 * size * size:
        # On one line: the ends are the extremes along the direction to the vertex farthest from the first.
        far = 0
        for i in range(1, count):
            if max(abs(ring[2 * i]), abs(ring[2 * i + 1])) > max(abs(ring[2 * far]), abs(ring[2 * far + 1])):
                far = i
        dx = ring[2 * far]
        dy = ring[2 * far + 1]
        low = 0
        high = 0
        for i in range(1, count):
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
    if twice < 0.0:
        for i in range(1, (count + 1) // 2):
            j = count - i
            x = ring[2 * i]
            y = ring[2 * i + 1]
            ring[2 * i] = ring[2 * j]
            ring[2 * i + 1] = ring[2 * j + 1]
            ring[2 * j] = x
            ring[2 * j + 1] = y
    return count


def largest_triangle(ring, n, out):
    """Largest triangle on the vertices of a clean ring: for each first corner, the third one walks with the second.

    Args:
        ring: Clean ring of n vertices.
        n: Number of vertices, 3 or more.
        out: Receives the 3 corners, flat, counter-clockwise.

    Returns:
        Its area.
    """
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


def largest_parallelogram(ring, n, out):
    """Largest parallelogram in a clean ring.

    One corner A of some largest parallelogram A B C D lies on a vertex and the others on the boundary. For each
    vertex A the corner B walks once round the boundary; C and D are the ends of the far chord that is parallel and
    equal to AB. While B, C and D stay on their edges they move linearly and the area is a parabola in the way of B.

    Args:
        ring: Clean ring of n vertices.
        n: Number of vertices, 3 or more.
        out: Receives the 4 corners, flat, counter-clockwise.

    Returns:
        Its area.
    """
    best = -1.0
    best_a = 0
    best_bx = 0.0
    best_by = 0.0
    best_dx = 0.0
    best_dy = 0.0
    size = 0.0
    for i in range(2 * n):
        size = max(size, abs(ring[i]))
    slack = 1e-11 * size * size
    for a in range(n):
        ax = ring[2 * a]
        ay = ring[2 * a + 1]
        # B starts at A on edge a; C = D is the first vertex farthest from this edge. Edges count on from a.
        i = a + 1 if a + 1 < n else 0
        ux = ring[2 * i] - ax
        uy = ring[2 * i + 1] - ay
        far = 1
        height = 0.0
        for k in range(2, n):
            i = a + k if a + k < n else a + k - n
            reach = ux * (ring[2 * i + 1] - ay) - uy * (ring[2 * i] - ax)
            if reach > height * (1.0 + 1e-12):
                height = reach
                far = k
        b = 0
        c = far - 1
        d = far
        t = 0.0
        steps = 8 * n
        while b < n and d < n and c >= b and steps > 0:
            steps -= 1
            i = a + b if a + b < n else a + b - n
            j = i + 1 if i + 1 < n else 0
            b0x = ring[2 * i] - ax
            b0y = ring[2 * i + 1] - ay
            bx = ring[2 * j] - ring[2 * i]
            by = ring[2 * j + 1] - ring[2 * i + 1]
            i = a + c if a + c < n else a + c - n
            j = i + 1 if i + 1 < n else 0
            c0x = ring[2 * i] - ax
            c0y = ring[2 * i + 1] - ay
            cx = ring[2 * j] - ring[2 * i]
            cy = ring[2 * j + 1] - ring[2 * i + 1]
            i = a + d if a + d < n else a + d - n
            j = i + 1 if i + 1 < n else 0
            d0x = ring[2 * i] - ax
            d0y = ring[2 * i + 1] - ay
            dx = ring[2 * j] - ring[2 * i]
            dy = ring[2 * j + 1] - ring[2 * i + 1]
            turn = cx * dy - cy * dx
            if c >= d or turn <= 1e-13 * (abs(cx) + abs(cy)) * (abs(dx) + abs(dy)):
                # The chord slides between parallel edges: C goes back or D goes on, whichever meets a vertex first.
                if c >= d:  # the chord lies on one edge: slide along it, D to the next
                    d = c + 1
                    continue
                # B - A + D = C: the share of each edge that is left, from where the chord stands.
                ux = b0x + t * bx
                uy = b0y + t * by
                # With D at the end of its edge, C would stand at D1 + u; is that still on C's edge?
                ex = d0x + dx + ux - c0x
                ey = d0y + dy + uy - c0y
                if ex * cx + ey * cy >= 0.0:
                    d += 1
                else:
                    c -= 1
                continue
            # C0 + g c = D0 + e d + B(t): g = g0 + g1 t, e = e0 + e1 t.
            wx = d0x - c0x + b0x
            wy = d0y - c0y + b0y
            g0 = (wx * dy - wy * dx) / turn
            g1 = (bx * dy - by * dx) / turn
            e0 = (wx * cy - wy * cx) / turn
            e1 = (bx * cy - by * cx) / turn
            end = 1.0
            event = 0
            if e1 > 0.0:
                s = (1.0 - e0) / e1
                if s < end:
                    end = s
                    event = 1
            if g1 > 0.0:
                s = (1.0 - g0) / g1
                if s < end:
                    end = s
                    event = 2
            elif g1 < 0.0:
                s = -g0 / g1
                if s < end:
                    end = s
                    event = 3
            if end < t:
                end = t
            # Area AB x AD with B = B0 + t b, D = D0 + (e0 + e1 t) d, but for a constant: q1 t + q2 t^2.
            px = d0x + e0 * dx
            py = d0y + e0 * dy
            q1 = bx * py - by * px + e1 * (b0x * dy - b0y * dx)
            q2 = e1 * (bx * dy - by * dx)
            # No place is looked at where the parabola stays below the best by more than rounding moves it.
            here = t * (q1 + q2 * t)
            there = end * (q1 + q2 * end)
            if there > here:
                here = there
            if q2 < 0.0 and t < -0.5 * q1 / q2 < end:
                here = -0.25 * q1 * q1 / q2
            if here + b0x * py - b0y * px + slack > best or turn <= 1e-3 * (abs(cx) + abs(cy)) * (abs(dx) + abs(dy)):
                # At both ends and at the summit; D from its edge, then C from its own: where C's and D's edges are
                # almost parallel, rounding moves one of them off, and only what stays on the boundary counts.
                for trial in range(6):
                    s = t
                    if trial >= 4:
                        if q2 >= 0.0:
                            break
                        s = -0.5 * q1 / q2
                        if not t < s < end:
                            break
                    elif trial >= 2:
                        s = end
                    ux = b0x + s * bx
                    uy = b0y + s * by
                    if trial % 2 == 0:
                        e = min(1.0, max(0.0, e0 + e1 * s))
                        if trial == 2 and event == 1:
                            e = 1.0
                        vx = d0x + e * dx
                        vy = d0y + e * dy
                        value = ux * vy - uy * vx
                        if value <= best:
                            continue
                        wx = vx + ux - c0x
                        wy = vy + uy - c0y
                        off = wx * cy - wy * cx
                        along = (wx * cx + wy * cy) / (cx * cx + cy * cy)
                        limit = 1e-14 * size * (abs(cx) + abs(cy))
                    else:
                        g = min(1.0, max(0.0, g0 + g1 * s))
                        if trial == 3 and event == 2:
                            g = 1.0
                        elif trial == 3 and event == 3:
                            g = 0.0
                        vx = c0x + g * cx - ux
                        vy = c0y + g * cy - uy
                        value = ux * vy - uy * vx
                        if value <= best:
                            continue
                        wx = vx - d0x
                        wy = vy - d0y
                        off = wx * dy - wy * dx
                        along = (wx * dx + wy * dy) / (dx * dx + dy * dy)
                        limit = 1e-14 * size * (abs(dx) + abs(dy))
                    if abs(off) <= limit and -1e-13 <= along <= 1.0 + 1e-13:
                        best = value
                        best_a = a
                        best_bx = ux
                        best_by = uy
                        best_dx = vx
                        best_dy = vy
            t = end
            if event == 0:
                b += 1
                t = 0.0
            elif event == 1:
                d += 1
            elif event == 2:
                c += 1
            else:
                c -= 1
    ax = ring[2 * best_a]
    ay = ring[2 * best_a + 1]
    out[0] = ax
    out[1] = ay
    out[2] = ax + best_bx
    out[3] = ay + best_by
    out[4] = ax + best_bx + best_dx
    out[5] = ay + best_by + best_dy
    out[6] = ax + best_dx
    out[7] = ay + best_dy
    return best


def largest_circle(ring, n, work, out):
    """Largest circle in a clean ring.

    The depth, the least distance to an edge's line, is concave. So is the greatest depth over y at an x; both maxima
    are found with cuts (tangents), which end on the exact optimum after a few. Two cuts meet at slopes of opposite
    sign: where they are almost parallel they are almost level, and the depth is as exact as elsewhere.

    Args:
        ring: Clean ring of n vertices.
        n: Number of vertices, 3 or more.
        work: Room for 3 n + 2 numbers.
        out: Receives the centre x, y.

    Returns:
        The radius: the least distance of the centre to an edge line.
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
        depth = _deepest(work, n, x, y, y_low, y_high, 1e-16 * size)
        y = work[3 * n]
        slope = work[3 * n + 1]
        if depth > best:
            best = depth
            best_x = x
            best_y = y
        expected = left_depth + left_slope * (x - left)
        if slope == 0.0 or (step > 0 and depth >= expected - 1e-16 * size):
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
    """Greatest depth over y at an x; leaves y, and how the depth rises with x, behind the lines."""
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
