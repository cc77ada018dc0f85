# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel for the largest rectangle in a convex ring, at a given angle.

Rings are as in `plantar.kernels.inscribed`: flat, clean, counter-clockwise, n vertices.
"""

from __future__ import annotations

import math

__all__ = ["largest_rectangle", "lean", "write_corners"]


def largest_rectangle(ring, n, angle, floor, work, out):
    """Largest rectangle in a clean ring whose first side stands at an angle.

    The height h(w) = max over x of min(top(x), top(x + w)) - max(bottom(x), bottom(x + w)) is concave and piecewise
    linear; both maximisations run on its cuts (tangents), which end on the exact optimum after finitely many.

    Args:
        ring: Clean ring of n vertices.
        n: Number of vertices, 3 or more.
        angle: Angle of the first side in rad.
        floor: Give up where no rectangle of more than this area is left to find; 0 to find the largest.
        work: Room for 8 n + 16 numbers.
        out: Receives the 4 corners, flat, counter-clockwise; untouched unless the area is above the floor.

    Returns:
        Its area; at most the floor where the search gave up.
    """
    cosine = math.cos(angle)
    sine = math.sin(angle)
    # Rotated vertices stand at work[0 : 2 n]; the chains behind: x, y, slope of each, lower first.
    low = 0
    high = 0
    for i in range(n):
        work[2 * i] = cosine * ring[2 * i] + sine * ring[2 * i + 1]
        work[2 * i + 1] = cosine * ring[2 * i + 1] - sine * ring[2 * i]
        if work[2 * i] < work[2 * low]:
            low = i
        if work[2 * i] > work[2 * high]:
            high = i
    tolerance = 1e-14 * (work[2 * high] - work[2 * low])
    lower = 2 * n
    bottom = _chain(work, n, low, high, 1, tolerance, lower)
    upper = lower + 3 * bottom
    top = _chain(work, n, low, high, -1, tolerance, upper)
    x_first = max(work[lower], work[upper])
    x_last = min(work[lower + 3 * bottom - 3], work[upper + 3 * top - 3])
    reach = x_last - x_first
    best = floor
    best_x = 0.0
    best_w = -1.0
    best_b = 0.0
    best_t = 0.0
    # Bracket of w: cuts h <= height + slope (w' - w) on its left and right.
    w_left = 0.0
    h_left = 0.0
    s_left = 0.0
    has_left = False
    w_right = reach
    h_right = 0.0
    s_right = 0.0
    has_right = False
    w = 0.5 * reach
    x = 0.5 * (x_first + x_last) - 0.5 * w
    size = reach + abs(work[lower + 1]) + abs(work[upper + 1])
    u1 = 0  # the chains' edges under x and x + w, walked from where they stood
    u2 = 0
    l1 = 0
    l2 = 0
    for _ in range(60):
        # Highest gap of this width, and a cut through it.
        xa = x_first
        xb = x_last - w
        if xb < xa:
            xb = xa
        has_a = False
        has_b = False
        va = 0.0
        ga = 0.0
        da = 0.0
        top_a = 0.0
        bottom_a = 0.0
        vb = 0.0
        gb = 0.0
        db = 0.0
        top_b = 0.0
        bottom_b = 0.0
        if x < xa:
            x = xa
        elif x > xb:
            x = xb
        height = 0.0
        slope = 0.0
        mixed = 0.0
        expected = 0.0
        t = 0.0
        b = 0.0
        for _ in range(60):
            y = x + w
            while u1 > 0 and work[upper + 3 * u1] > x:
                u1 -= 1
            while u1 < top - 2 and work[upper + 3 * u1 + 3] < x:
                u1 += 1
            while u2 > 0 and work[upper + 3 * u2] > y:
                u2 -= 1
            while u2 < top - 2 and work[upper + 3 * u2 + 3] < y:
                u2 += 1
            while l1 > 0 and work[lower + 3 * l1] > x:
                l1 -= 1
            while l1 < bottom - 2 and work[lower + 3 * l1 + 3] < x:
                l1 += 1
            while l2 > 0 and work[lower + 3 * l2] > y:
                l2 -= 1
            while l2 < bottom - 2 and work[lower + 3 * l2 + 3] < y:
                l2 += 1
            t = work[upper + 3 * u1 + 1] + (x - work[upper + 3 * u1]) * work[upper + 3 * u1 + 2]
            p = work[upper + 3 * u2 + 1] + (y - work[upper + 3 * u2]) * work[upper + 3 * u2 + 2]
            gx = work[upper + 3 * u1 + 2]  # slope of the gap in x, and in w
            gw = 0.0
            if p < t:
                t = p
                gx = work[upper + 3 * u2 + 2]
                gw = gx
            b = work[lower + 3 * l1 + 1] + (x - work[lower + 3 * l1]) * work[lower + 3 * l1 + 2]
            p = work[lower + 3 * l2 + 1] + (y - work[lower + 3 * l2]) * work[lower + 3 * l2 + 2]
            if p > b:
                b = p
                gx -= work[lower + 3 * l2 + 2]
                gw -= work[lower + 3 * l2 + 2]
            else:
                gx -= work[lower + 3 * l1 + 2]
            height = t - b
            slope = gw
            if gx == 0.0:
                break
            if has_a and has_b and height >= expected - 1e-15 * size:
                slope = mixed  # on both cuts: the optimum
                break
            if gx > 0.0:
                xa = x
                va = height
                ga = gx
                da = gw
                top_a = t
                bottom_a = b
                has_a = True
                if not has_b:
                    if x >= x_last - w:
                        slope = gw - gx
                        break
                    x = x_last - w
                    continue
            else:
                xb = x
                vb = height
                gb = gx
                db = gw
                top_b = t
                bottom_b = b
                has_b = True
                if not has_a:
                    if x <= x_first:
                        break
                    x = x_first
                    continue
            mixed = (ga * db - gb * da) / (ga - gb)
            x = xa + (vb - va + gb * (xa - xb)) / (ga - gb)
            expected = va + ga * (x - xa)
            if not xa < x < xb:
                slope = mixed  # the cuts meet where one was taken
                if va >= vb:
                    x = xa
                    height = va
                    t = top_a
                    b = bottom_a
                else:
                    x = xb
                    height = vb
                    t = top_b
                    b = bottom_b
                break
        area = w * height
        if area > best:
            best = area
            best_x = x
            best_w = w
            best_b = b
            best_t = t
        if height + slope * w > 0.0:
            w_left = w
            h_left = height
            s_left = slope
            has_left = True
        elif height + slope * w < 0.0:
            w_right = w
            h_right = height
            s_right = slope
            has_right = True
        else:
            break
        # Best product that the cuts leave.
        w = 0.0
        bound = -1.0
        if has_left:
            w = w_right
            if s_left < 0.0:
                p = 0.5 * (w_left - h_left / s_left)
                if p < w:
                    w = p
            bound = w * (h_left + s_left * (w - w_left))
            if has_right and h_right + s_right * (w - w_right) < h_left + s_left * (w - w_left):
                w = 0.5 * (w_right - h_right / s_right) if s_right < 0.0 else w_left
                if w < w_left:
                    w = w_left
                if s_left > s_right and h_left + s_left * (w - w_left) < h_right + s_right * (w - w_right):
                    w = (h_right - h_left + s_left * w_left - s_right * w_right) / (s_left - s_right)
                bound = w * (h_right + s_right * (w - w_right))
        else:
            if s_right >= 0.0:  # only where the ring is not convex
                break
            w = 0.5 * (w_right - h_right / s_right)
            bound = w * (h_right + s_right * (w - w_right))
        if bound <= best * (1.0 + 1e-15) or not (w_left < w <= w_right) or (w == w_right and has_right):
            break
    if best_w < 0.0:
        return best
    # What the sides left out at upright edges: each side goes out to the edges' lines at the height of its corners.
    x = work[2 * low]
    y = work[2 * high]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx = work[2 * j] - work[2 * i]
        dy = work[2 * j + 1] - work[2 * i + 1]
        if dy < 0.0:
            x = max(x, work[2 * i] + (best_b - work[2 * i + 1]) * dx / dy)
            x = max(x, work[2 * i] + (best_t - work[2 * i + 1]) * dx / dy)
        elif dy > 0.0:
            y = min(y, work[2 * i] + (best_b - work[2 * i + 1]) * dx / dy)
            y = min(y, work[2 * i] + (best_t - work[2 * i + 1]) * dx / dy)
    x = min(x, best_x)
    y = max(y, best_x + best_w)
    best = (y - x) * (best_t - best_b)
    write_corners(out, cosine, sine, x, y, best_b, best_t)
    return best


def write_corners(out, cosine, sine, x1, x2, y1, y2):
    """Write the corners of a rectangle, turned about the origin.

    Args:
        out: Receives the 4 corners, flat, counter-clockwise.
        cosine: Cosine of the angle; sine its sine.
        x1: First x in the turned frame in m, up to x2; likewise y1 and y2.
    """
    out[0] = cosine * x1 - sine * y1
    out[1] = sine * x1 + cosine * y1
    out[2] = cosine * x2 - sine * y1
    out[3] = sine * x2 + cosine * y1
    out[4] = cosine * x2 - sine * y2
    out[5] = sine * x2 + cosine * y2
    out[6] = cosine * x1 - sine * y2
    out[7] = sine * x1 + cosine * y2


def lean(corners):
    """Angle between the diagonal and the longer side of a rectangle in rad, whose corners `write_corners` wrote."""
    along = math.hypot(corners[2] - corners[0], corners[3] - corners[1])
    across = math.hypot(corners[4] - corners[2], corners[5] - corners[3])
    return math.atan2(min(along, across), max(along, across))


def _chain(work, n, low, high, step, tolerance, at):
    """Lower (step 1) or upper (step -1) chain of rotated vertices from low to high: x, y, slope each, at work[at:].

    Sides that stand upright, or almost, are left out, so that every slope is finite and says something.
    """
    width = work[2 * high] - work[2 * low]
    i = low
    while True:  # up to the last vertex of an upright left side
        j = i + step
        j = j - n if j >= n else j + n if j < 0 else j
        if j == low or work[2 * j] - work[2 * i] > _upright(work, i, j, width, tolerance):
            break
        i = j
    count = 1
    work[at] = work[2 * i]
    work[at + 1] = work[2 * i + 1]
    work[at + 2] = 0.0
    k = i
    while i != high:
        i = i + step
        i = i - n if i >= n else i + n if i < 0 else i
        x = work[2 * i]
        y = work[2 * i + 1]
        last = at + 3 * (count - 1)
        if x - work[last] <= _upright(work, k, i, width, tolerance):
            continue
        work[last + 2] = (y - work[last + 1]) / (x - work[last])
        work[last + 3] = x
        work[last + 4] = y
        work[last + 5] = 0.0
        count += 1
        k = i
    return count


def _upright(work, i, j, width, tolerance):
    """Width up to which the edge between two rotated vertices counts as upright: its slope would drown in rounding."""
    return max(tolerance, min(1e-8 * abs(work[2 * j + 1] - work[2 * i + 1]), 1e-7 * width))
