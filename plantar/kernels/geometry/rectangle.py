# cython: infer_types=True
"""Largest rectangle in a convex ring, at a given angle."""

import math

__all__ = ["largest_rectangle", "write_corners"]


class _Gap:
    """Gap between a rotated ring's chains, for a rectangle's width.

    `height`: min(top(x), top(x + w)) - max(bottom(x), bottom(x + w)); `slope`: slope of largest height in width, by the
    last cut (tangent).
    """

    def start(self, work, upper, tops, lower, bottoms):
        """Begin with the chains in work (x, y, slope): where each begins, its length."""
        self.work = work
        self.upper = upper
        self.tops = tops
        self.lower = lower
        self.bottoms = bottoms
        self.first = max(work[lower], work[upper])
        self.last = min(work[lower + 3 * bottoms - 3], work[upper + 3 * tops - 3])
        self.size = self.last - self.first + abs(work[lower + 1]) + abs(work[upper + 1])
        self.over = 0  # the chains' edges over and under x and x + w, walked from where they stood
        self.over_end = 0
        self.under = 0
        self.under_end = 0
        self.x = 0.0
        self.height = 0.0
        self.slope = 0.0
        self.top = 0.0
        self.bottom = 0.0
        self.in_x = 0.0
        self.in_w = 0.0

    def edge_at(self, at, count, edge, x):
        """Chain's edge at an x, walked from one of its edges."""
        while edge > 0 and self.work[at + 3 * edge] > x:
            edge -= 1
        while edge < count - 2 and self.work[at + 3 * edge + 3] < x:
            edge += 1
        return edge

    def measure(self, x, w):
        """Gap's height at x, and its slopes in x and w."""
        y = x + w
        self.over = self.edge_at(self.upper, self.tops, self.over, x)
        self.over_end = self.edge_at(self.upper, self.tops, self.over_end, y)
        self.under = self.edge_at(self.lower, self.bottoms, self.under, x)
        self.under_end = self.edge_at(self.lower, self.bottoms, self.under_end, y)
        a = self.upper + 3 * self.over
        b = self.upper + 3 * self.over_end
        c = self.lower + 3 * self.under
        d = self.lower + 3 * self.under_end
        self.x = x
        self.top = self.work[a + 1] + (x - self.work[a]) * self.work[a + 2]
        p = self.work[b + 1] + (y - self.work[b]) * self.work[b + 2]
        self.in_x = self.work[a + 2]
        self.in_w = 0.0
        if p < self.top:
            self.top = p
            self.in_x = self.work[b + 2]
            self.in_w = self.in_x
        self.bottom = self.work[c + 1] + (x - self.work[c]) * self.work[c + 2]
        p = self.work[d + 1] + (y - self.work[d]) * self.work[d + 2]
        if p > self.bottom:
            self.bottom = p
            self.in_x -= self.work[d + 2]
            self.in_w -= self.work[d + 2]
        else:
            self.in_x -= self.work[c + 2]
        self.height = self.top - self.bottom

    def find_highest(self, w):
        """Move to a width's highest gap, from the current x, and cut there."""
        # slopes in x of the two cuts
        rise = 0.0
        fall = 0.0
        # and in w
        rise_w = 0.0
        fall_w = 0.0
        rise_x = self.first
        fall_x = max(self.last - w, self.first)
        rise_height = 0.0
        fall_height = 0.0
        rise_top = 0.0
        fall_top = 0.0
        rise_bottom = 0.0
        fall_bottom = 0.0
        has_rise = False
        has_fall = False
        mixed = 0.0
        expected = 0.0
        x = min(max(self.x, rise_x), fall_x)
        for _ in range(60):
            self.measure(x, w)
            self.slope = self.in_w
            if self.in_x == 0.0:
                return
            # nature: floating point, five roundings
            if has_rise and has_fall and self.height >= expected - 1e-15 * self.size:
                self.slope = mixed  # on both cuts: the optimum
                return
            if self.in_x > 0.0:
                rise_x = x
                rise_height = self.height
                rise = self.in_x
                rise_w = self.in_w
                rise_top = self.top
                rise_bottom = self.bottom
                has_rise = True
                if not has_fall:
                    if x >= self.last - w:
                        self.slope = self.in_w - self.in_x
                        return
                    x = self.last - w
                    continue
            else:
                fall_x = x
                fall_height = self.height
                fall = self.in_x
                fall_w = self.in_w
                fall_top = self.top
                fall_bottom = self.bottom
                has_fall = True
                if not has_rise:
                    if x <= self.first:
                        return
                    x = self.first
                    continue
            mixed = (rise * fall_w - fall * rise_w) / (rise - fall)
            x = rise_x + (fall_height - rise_height + fall * (rise_x - fall_x)) / (rise - fall)
            expected = rise_height + rise * (x - rise_x)
            if not rise_x < x < fall_x:
                self.slope = mixed  # the cuts meet where one was taken
                if rise_height >= fall_height:
                    self.keep(rise_x, rise_height, rise_top, rise_bottom)
                else:
                    self.keep(fall_x, fall_height, fall_top, fall_bottom)
                return

    def keep(self, x, height, top, bottom):
        self.x = x
        self.height = height
        self.top = top
        self.bottom = bottom


class _Widths:
    """Bracket of the largest width: a cut h <= height + slope (w' - w) on each side."""

    def start(self, reach):
        """Begin with all widths from 0."""
        self.left = 0.0
        self.left_height = 0.0
        self.left_slope = 0.0
        self.has_left = False
        self.right = reach
        self.right_height = 0.0
        self.right_slope = 0.0
        self.has_right = False

    def cut(self, w, height, slope):
        """Add a cut at a width; False where the area has its maximum there."""
        rate = height + slope * w  # of the area
        if rate > 0.0:
            self.left = w
            self.left_height = height
            self.left_slope = slope
            self.has_left = True
        elif rate < 0.0:
            self.right = w
            self.right_height = height
            self.right_slope = slope
            self.has_right = True
        else:
            return False
        return True

    def under_left(self, w):
        return self.left_height + self.left_slope * (w - self.left)

    def under_right(self, w):
        return self.right_height + self.right_slope * (w - self.right)

    def next_width(self, best):
        """Width of the largest area under the cuts; below 0 if no better."""
        w = 0.0
        bound = -1.0
        if self.has_left:
            w = self.right
            if self.left_slope < 0.0:
                w = min(w, 0.5 * (self.left - self.left_height / self.left_slope))
            bound = w * self.under_left(w)
            if self.has_right and self.under_right(w) < self.under_left(w):
                w = 0.5 * (self.right - self.right_height / self.right_slope) if self.right_slope < 0.0 else self.left
                w = max(w, self.left)
                if self.left_slope > self.right_slope and self.under_left(w) < self.under_right(w):
                    w = (
                        self.right_height
                        - self.left_height
                        + self.left_slope * self.left
                        - self.right_slope * self.right
                    ) / (self.left_slope - self.right_slope)
                bound = w * self.under_right(w)
        else:
            if self.right_slope >= 0.0:  # only where the ring is not convex
                return -1.0
            w = 0.5 * (self.right - self.right_height / self.right_slope)
            bound = w * self.under_right(w)
        # nature: floating point, five roundings
        if bound <= best * (1.0 + 1e-15) or not (self.left < w <= self.right) or (w == self.right and self.has_right):
            return -1.0
        return w


def largest_rectangle(ring, n, angle, floor, work, out):
    """Largest rectangle at an angle in a clean ring of n vertices, 3 or more; returns its area.

    Height h(w) = max over x of min(top(x), top(x + w)) - max(bottom(x), bottom(x + w)), concave and piecewise linear;
    cuts (tangents) find both maxima.

    `angle`: angle of first side in rad; `floor`: give up where no rectangle above this area is left; 0 to find largest;
    `work`: room for 8 n + 16 numbers; `out`: receives the 4 corners, flat, counter-clockwise; untouched unless area is
    above floor.
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
    tolerance = 1e-14 * (work[2 * high] - work[2 * low])  # nature: floating point, fifty roundings of the ring's width
    lower = 2 * n
    bottoms = _chain(work, n, low, high, 1, tolerance, lower)
    upper = lower + 3 * bottoms
    tops = _chain(work, n, low, high, -1, tolerance, upper)
    gap = _Gap()
    gap.start(work, upper, tops, lower, bottoms)
    widths = _Widths()
    widths.start(gap.last - gap.first)
    best = floor
    best_x = 0.0
    best_w = -1.0
    best_b = 0.0
    best_t = 0.0
    w = 0.5 * widths.right
    gap.x = 0.5 * (gap.first + gap.last) - 0.5 * w
    for _ in range(60):
        gap.find_highest(w)
        area = w * gap.height
        if area > best:
            best = area
            best_x = gap.x
            best_w = w
            best_b = gap.bottom
            best_t = gap.top
        if not widths.cut(w, gap.height, gap.slope):
            break
        w = widths.next_width(best)
        if w < 0.0:
            break
    if best_w < 0.0:
        return best
    x = max(work[2 * low], _edge_out(work, n, best_b, best_t, work[2 * low], -1.0))
    y = min(work[2 * high], _edge_out(work, n, best_b, best_t, work[2 * high], 1.0))
    x = min(x, best_x)
    y = max(y, best_x + best_w)
    best = (y - x) * (best_t - best_b)
    write_corners(out, cosine, sine, x, y, best_b, best_t)
    return best


def _edge_out(work, n, bottom, top, x, way):
    """How far a side may move left (way -1) or right (1) within the ring."""
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx = work[2 * j] - work[2 * i]
        dy = work[2 * j + 1] - work[2 * i + 1]
        if way * dy > 0.0:
            low = work[2 * i] + (bottom - work[2 * i + 1]) * dx / dy
            high = work[2 * i] + (top - work[2 * i + 1]) * dx / dy
            x = min(x, low, high) if way > 0.0 else max(x, low, high)
    return x


def write_corners(out, cosine, sine, x1, x2, y1, y2):
    """Write a rectangle's corners, turned about the origin, flat, counter-clockwise.

    `out`: receives the 4 corners; `x1`: first x in turned frame in m, up to x2; likewise y1 and y2.
    """
    out[0] = cosine * x1 - sine * y1
    out[1] = sine * x1 + cosine * y1
    out[2] = cosine * x2 - sine * y1
    out[3] = sine * x2 + cosine * y1
    out[4] = cosine * x2 - sine * y2
    out[5] = sine * x2 + cosine * y2
    out[6] = cosine * x1 - sine * y2
    out[7] = sine * x1 + cosine * y2


def _chain(work, n, low, high, step, tolerance, at):
    """Lower (step 1) or upper (step -1) chain: x, y, finite slope each, at work[at:], without upright sides."""
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
    """Width up to which an edge counts as upright: rounding drowns its slope."""
    # nature: floating point, the root of a rounding, and ten of it of the width
    return max(tolerance, min(1e-8 * abs(work[2 * j + 1] - work[2 * i + 1]), 1e-7 * width))
