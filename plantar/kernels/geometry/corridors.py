# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that bounds the long rectangles of an outline over an interval of angles, and tells where they may stand.

Plain Python that also compiles ahead of time (`corridors.pxd` gives the C types). `outline_search` searches with it.
"""

from __future__ import annotations

import math

from ..base import signals, work_arrays

__all__ = ["Corridors"]

_MOST = 1500.0  # columns across an outline
_MERGE = 1.3  # times the larger of two boxes' areas that the one around both may have
_LEAST = 0.8  # share of the largest bound so far below which a search for it alone does not look
_ROUNDING = 1e-12  # of the outline's extent: gaps as narrow let rectangles through
_INF = math.inf  # typed: an attribute of the module is looked up at each use
_ASK = 1 << 19  # units of work between two looks for signals


class Corridors:
    """Boxes around all rectangles of an outline that may have more than some area, over an interval of angles.

    Columns stand across the outline at some pitch g, its middle angle turned to 0. A rectangle w x h, w >= h, whose
    first side stands at an angle t, |t| <= d, cuts the columns between its middle corners in chords h / cos t long.
    They do on a length of w cos t - h |sin t| along x: if that holds k columns it is at most (k + 1) g, so

        w <= min(((k + 1) g + h sin d) / cos d, (k + 1) g / (cos d - sin d)),

    the second one since h <= w. From one column to the next one a chord moves by g tan d at most. So what is free along
    a column, cut with what was free along the one before, widened by that, holds the chord: the least of these lengths
    bounds h. All ways along free intervals are walked, as long as the outline goes on far enough for more than the area
    looked for. What cuts no column in a whole chord has less than (g / (cos d - sin d))^2.

    The outline counts between columns not at all, which only raises the bound, and needs far fewer of them than it has
    vertices.

    Attributes:
        boxes: Number of boxes found.
        box: x from and to, y from and to, seen at the middle angle, and the bound in m^2 of each box.
        spent: Units of work so far.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.spent = 0
        self.next_look = _ASK
        self.limit = _INF
        self.points = 0
        self.columns = 0
        self.many = 0
        self.boxes = 0
        self.box = work_arrays.numbers(5 * 64, self.lists)
        self.stack = work_arrays.numbers(5 * 256, self.lists)
        self.path = work_arrays.places(2 * 256, self.lists)
        self.least_x = 0.0
        self.pitch = 0.0
        self.shift = 0.0
        self.cosine = 1.0
        self.sine = 0.0
        self.floor = 0.0
        self.peak = False

    def restart(self):
        """Count the work from 0."""
        self.spent = 0
        self.next_look = _ASK
        self.limit = _INF

    def allow(self, work):
        """Allow so many units of work from now on; who needs more gets one box around the whole outline."""
        self.limit = self.spent + work

    def _make_room(self, points, columns):
        """Work arrays for so many vertices and columns."""
        if points > self.points:
            self.points = 2 * points
            self.xs = work_arrays.numbers(self.points, self.lists)
            self.ys = work_arrays.numbers(self.points, self.lists)
        if columns > self.columns:
            self.columns = 2 * columns
            self.first = work_arrays.places(self.columns + 2, self.lists)
            self.filled = work_arrays.places(self.columns + 2, self.lists)

    def sweep(self, points, start, rings, angle, half, pitch, floor, peak):
        """Find boxes around all that may have more than some area.

        Args:
            points: Vertices of the outline, flat.
            start: Offsets (rings + 1) of the rings; rings their number.
            angle: Middle angle in rad of the long side; half how far it turns to either side.
            pitch: Distance in m of the columns.
            floor: The area.
            peak: Find the one box of the largest bound, or of one as large but for a fifth, alone.
        """
        m = start[rings]
        self._make_room(m, 1)
        xs = self.xs
        ys = self.ys
        cosine = math.cos(angle)
        sine = math.sin(angle)
        low = _INF
        high = -_INF
        for i in range(m):
            xs[i] = cosine * points[2 * i] + sine * points[2 * i + 1]
            ys[i] = cosine * points[2 * i + 1] - sine * points[2 * i]
            low = min(low, xs[i])
            high = max(high, xs[i])
        self.boxes = 0
        if not high > low:
            return
        self.pitch = max(pitch, (high - low) / _MOST)
        self.least_x = low
        columns = self._column(high) + 1
        self._make_room(m, columns)
        self.cosine = math.cos(half)
        self.sine = math.sin(half)
        self.shift = self.pitch * self.sine / self.cosine
        self.floor = floor
        self.peak = peak
        width = self.pitch / (self.cosine - self.sine)
        if not (peak or width * width <= floor):
            self._add_all(start[rings], low, high)
            return
        self._cut(start, rings, columns)
        self._free(columns, _ROUNDING * (high - low))
        self._reach(columns)
        for k in range(columns):
            for t in range(self.first[k], self.first[k + 1]):
                if self.spent > self.limit:
                    self._add_all(start[rings], low, high)
                    return
                self._walk(k, t, columns)

    def _add_all(self, m, low, high):
        """Keep one box around the whole outline, of no bound."""
        self.boxes = 1
        self.box[0] = low
        self.box[1] = high
        self.box[2] = _INF
        self.box[3] = -_INF
        for i in range(m):
            self.box[2] = min(self.box[2], self.ys[i])
            self.box[3] = max(self.box[3], self.ys[i])
        self.box[4] = _INF

    def _column(self, x):
        """The first column at or right of an x."""
        return int((x - self.least_x) / self.pitch + 0.5)

    def _place(self, column):
        """X of a column."""
        return self.least_x + (column + 0.5) * self.pitch

    def _cut(self, start, rings, columns):
        """Cut every column with the edges: y, and +1 where the area begins there or -1 where it ends, from the lowest.

        Each column has its own as `first` says.
        """
        xs = self.xs
        ys = self.ys
        first = self.first
        filled = self.filled
        for k in range(columns + 2):
            first[k] = 0
        for r in range(rings):
            i = start[r + 1] - 1
            for j in range(start[r], start[r + 1]):
                first[self._column(min(xs[i], xs[j]))] += 1
                first[self._column(max(xs[i], xs[j]))] -= 1
                i = j
        total = 0
        across = 0
        for k in range(columns + 1):
            across += first[k]
            first[k] = total
            filled[k] = total
            total += across
        self.spent += 8 * total + 4 * start[rings]
        if total > self.many:
            self._make_many(2 * total)
        crossing = self.crossing
        for r in range(rings):
            i = start[r + 1] - 1
            for j in range(start[r], start[r + 1]):
                a = i
                b = j
                side = 1.0
                if xs[i] > xs[j]:
                    a = j
                    b = i
                    side = -1.0
                low = self._column(xs[a])
                high = self._column(xs[b])
                i = j
                if low == high:
                    continue
                slope = (ys[b] - ys[a]) / (xs[b] - xs[a])
                y = ys[a] + slope * (self._place(low) - xs[a])
                for k in range(low, high):
                    p = filled[k]
                    while p > first[k] and crossing[2 * p - 2] > y:
                        crossing[2 * p] = crossing[2 * p - 2]
                        crossing[2 * p + 1] = crossing[2 * p - 1]
                        p -= 1
                    crossing[2 * p] = y
                    crossing[2 * p + 1] = side
                    filled[k] += 1
                    y += slope * self.pitch

    def _make_many(self, total):
        """Work arrays for so many cuts of columns with edges."""
        self.many = total
        self.crossing = work_arrays.numbers(2 * total + 2, self.lists)
        self.low = work_arrays.numbers(total + 2, self.lists)
        self.high = work_arrays.numbers(total + 2, self.lists)
        self.far = work_arrays.places(total + 2, self.lists)

    def _free(self, columns, rounding):
        """Find what is free along each column: its intervals, those that almost meet joined."""
        first = self.first
        crossing = self.crossing
        low = self.low
        high = self.high
        count = 0
        p = 0
        for k in range(columns):
            q = first[k + 1]
            first[k] = count
            depth = 0.0
            bottom = 0.0
            while p < q:
                before = depth
                depth += crossing[2 * p + 1]
                if before <= 0.0 and depth > 0.0:
                    bottom = crossing[2 * p] - rounding
                elif before > 0.0 and depth <= 0.0:
                    top = crossing[2 * p] + rounding
                    if count > first[k] and bottom <= high[count - 1]:
                        high[count - 1] = max(top, high[count - 1])
                    else:
                        low[count] = bottom
                        high[count] = top
                        count += 1
                p += 1
        first[columns] = count

    def _reach(self, columns):
        """Find how far the free intervals go on to the right where they are high enough for more than the floor."""
        first = self.first
        low = self.low
        high = self.high
        far = self.far
        least = self.floor * (self.cosine - self.sine) / ((columns + 1) * self.pitch) * (1.0 - 1e-9)
        shift = self.shift
        for k in range(columns - 1, -1, -1):
            u = first[k + 1]
            for t in range(first[k], first[k + 1]):
                far[t] = k
                if k + 1 == columns:
                    continue
                while u < first[k + 2] and high[u] <= low[t] - shift:
                    u += 1
                v = u
                while v < first[k + 2] and low[v] < high[t] + shift:
                    if min(high[v], high[t] + shift) - max(low[v], low[t] - shift) > least:
                        far[t] = max(far[t], far[v])
                    v += 1

    def _bound(self, columns, height):
        """Largest area in m^2 of a rectangle that has so many whole chords up to a height."""
        reach = (columns + 1) * self.pitch
        width = min((reach + height * self.sine) / self.cosine, reach / (self.cosine - self.sine))
        return width * min(width, height)

    def _walk(self, begin, t, columns):
        """Walk all ways to the right that begin at a free interval of a column.

        What came whole through a free interval of the column before is left out: the ways from there hold it.
        """
        first = self.first
        low = self.low
        high = self.high
        far = self.far
        shift = self.shift
        way_low = _INF
        way_high = -_INF
        if begin > 0:
            for u in range(first[begin - 1], first[begin]):
                bottom = max(low[t], low[u])
                top = min(high[t], high[u])
                if top > bottom and top - bottom > way_high - way_low:
                    way_low = bottom
                    way_high = top
        if (way_low <= low[t] and high[t] <= way_high) or not self._bound(
            far[t] - begin + 1, high[t] - low[t]
        ) > self.floor:
            return
        self._put(0, begin, low[t], high[t], high[t] - low[t], low[t], high[t])
        top_of = 1
        while top_of > 0 and self.spent <= self.limit:
            top_of -= 1
            k = self.path[top_of]
            bottom_y = self.stack[5 * top_of]
            top_y = self.stack[5 * top_of + 1]
            height = self.stack[5 * top_of + 2]
            least_y = self.stack[5 * top_of + 3]
            most_y = self.stack[5 * top_of + 4]
            bound = self._bound(k - begin + 1, height)
            if bound > self.floor:
                self._add(begin, k, least_y, most_y, height, bound)
            if k + 1 >= columns:
                continue
            back = (k + 1 - begin) * shift
            u = self._first_above(first[k + 1], first[k + 2], bottom_y - shift)
            while u < first[k + 2] and low[u] < top_y + shift:
                bottom = max(bottom_y - shift, low[u])
                top = min(top_y + shift, high[u])
                self.spent += 4
                if (
                    top > bottom
                    and self._bound(far[u] - begin + 1, min(height, top - bottom)) > self.floor
                    and not (max(low[t], bottom - back) >= way_low and min(high[t], top + back) <= way_high)
                ):
                    self._put(
                        top_of,
                        k + 1,
                        bottom,
                        top,
                        min(height, top - bottom),
                        min(least_y, bottom),
                        max(most_y, top),
                    )
                    top_of += 1
                u += 1
            if self.spent > self.next_look:
                self.next_look = self.spent + _ASK
                signals.PyErr_CheckSignals()

    def _first_above(self, low, high, y):
        """The first of a column's free intervals, from one on, that ends above a y."""
        while low < high:
            middle = (low + high) // 2
            if self.high[middle] > y:
                high = middle
            else:
                low = middle + 1
        return low

    def _put(self, at, k, bottom, top, height, least_y, most_y):
        """Write a step of a way: its column, what is left of it there, the least height and the extent so far."""
        if 2 * at + 2 > len(self.path):
            self._widen()
        self.path[at] = k
        self.stack[5 * at] = bottom
        self.stack[5 * at + 1] = top
        self.stack[5 * at + 2] = height
        self.stack[5 * at + 3] = least_y
        self.stack[5 * at + 4] = most_y

    def _widen(self):
        """Make room for more steps."""
        path = work_arrays.places(2 * len(self.path), self.lists)
        stack = work_arrays.numbers(2 * len(self.stack), self.lists)
        for i in range(len(self.path)):
            path[i] = self.path[i]
        for i in range(len(self.stack)):
            stack[i] = self.stack[i]
        self.path = path
        self.stack = stack

    def _add(self, begin, k, least_y, most_y, height, bound):
        """Keep the box around the rectangles of a way, with one that it goes well with or by itself.

        Beyond the whole chords a rectangle goes on by a pitch and by h sin d, its long sides leaning by d at most.
        """
        aside = self.pitch + height * self.sine
        x1 = self._place(begin) - aside
        x2 = self._place(k) + aside
        lean = aside * self.sine / self.cosine
        y1 = least_y - lean
        y2 = most_y + lean
        box = self.box
        if self.peak:
            self.floor = max(self.floor, _LEAST * bound)
            if self.boxes > 0 and bound <= box[4]:
                return
            self.boxes = 0
        area = (x2 - x1) * (y2 - y1)
        for i in range(self.boxes - 1, -1, -1):
            a = min(x1, box[5 * i])
            b = max(x2, box[5 * i + 1])
            c = min(y1, box[5 * i + 2])
            d = max(y2, box[5 * i + 3])
            mine = (box[5 * i + 1] - box[5 * i]) * (box[5 * i + 3] - box[5 * i + 2])
            if (b - a) * (d - c) <= _MERGE * max(area, mine):
                box[5 * i] = a
                box[5 * i + 1] = b
                box[5 * i + 2] = c
                box[5 * i + 3] = d
                box[5 * i + 4] = max(bound, box[5 * i + 4])
                return
        self.spent += self.boxes
        if 5 * self.boxes + 5 > len(box):
            self.box = work_arrays.numbers(2 * len(box), self.lists)
            for i in range(len(box)):
                self.box[i] = box[i]
            box = self.box
        i = 5 * self.boxes
        box[i] = x1
        box[i + 1] = x2
        box[i + 2] = y1
        box[i + 3] = y2
        box[i + 4] = bound
        self.boxes += 1
