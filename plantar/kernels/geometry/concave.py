# cython: infer_types=True
"""Largest rectangle in an outline with islands and holes, exact."""

import math

from ..base import signals, work_arrays
from . import rectangle

__all__ = ["OutlineRectangles"]


class OutlineRectangles:
    """Largest rectangles of outlines, with their work arrays.

    `lists`: keep lists instead of arrays, faster when interpreted.
    """

    def __init__(self, lists):
        self.lists = lists
        self._make_room(64, 16)
        self._make_many(512)
        self.ring = work_arrays.numbers(24, self.lists)
        self.kept = work_arrays.numbers(24, self.lists)
        self.work = work_arrays.numbers(128, self.lists)
        self.corner = work_arrays.numbers(8, self.lists)

    def _make_room(self, points, rings):
        self.room = points
        self.points = work_arrays.numbers(2 * points, self.lists)
        self.xs = work_arrays.numbers(points, self.lists)
        self.ys = work_arrays.numbers(points, self.lists)
        self.line = work_arrays.numbers(points, self.lists)
        self.order = work_arrays.places(points, self.lists)
        self.rank = work_arrays.places(points, self.lists)
        self.first = work_arrays.places(points + 1, self.lists)
        self.filled = work_arrays.places(points, self.lists)
        self.start = work_arrays.places(rings + 1, self.lists)

    def _make_many(self, total):
        self.many = total
        self.edge = work_arrays.numbers(3 * total, self.lists)
        self.trapezoid = work_arrays.numbers(2 * total + 4, self.lists)
        self.reach = work_arrays.numbers(total // 2 + 1, self.lists)
        self.left = work_arrays.numbers(total + 2, self.lists)
        self.right = work_arrays.numbers(total + 2, self.lists)
        self.stack = work_arrays.numbers(total + 4, self.lists)
        self.path = work_arrays.places(total // 2 + 2, self.lists)
        self.slab = work_arrays.places(total // 2 + 1, self.lists)

    def take(self, points, starts):
        """Copy an outline: vertices (k, 2) in m, area on each ring's left, and ring offsets."""
        m = points.shape[0]
        rings = len(starts) - 1
        if m > self.room or rings + 1 > len(self.start):
            self._make_room(max(2 * m, self.room), max(2 * rings, len(self.start)))
        self.m = m
        self.rings = rings
        for i in range(m):
            self.points[2 * i] = points[i, 0] - points[0, 0]
            self.points[2 * i + 1] = points[i, 1] - points[0, 1]
            self.order[i] = i
        for r in range(rings + 1):
            self.start[r] = starts[r]

    def largest(self, angle, out):
        """Largest rectangle in the last outline at a given angle; returns its area.

        Lines through every vertex cut the area into slabs and these into trapezoids. A rectangle from one trapezoid to
        another may use a convex region: a window in y, cut by the slants of both. Branch and bound over the pairs: the
        window's box bounds a pair, and the remaining pairs are solved as convex polygons.

        `angle`: angle of first side in rad; `out`: receives 4 corners about the first vertex, flat, counter-clockwise;
        untouched without area.
        """
        self.best = 0.0
        slabs = self._cut(angle)
        if slabs < 1:
            return 0.0
        self._find_ways(slabs)
        line = self.line
        slab = self.slab
        reach = self.reach
        left = self.left
        trapezoid = self.trapezoid
        count = self.first[slabs]
        # First pass: rectangles between lines, a good start. Second pass: what two trapezoids may still give.
        for exact in range(2):
            for start in range(count):
                signals.PyErr_CheckSignals()
                i = slab[start]
                below = trapezoid[4 * start]
                above = trapezoid[4 * start + 1]
                low_right = trapezoid[4 * start + 2]
                high_right = trapezoid[4 * start + 3]
                if self._may_hold(line[i + 1] - line[i], max(above, high_right) - min(below, low_right)):
                    if exact:
                        self._solve(i, i, min(below, low_right), max(above, high_right), start, start)
                    else:
                        self._offer(line[i], line[i + 1], max(below, low_right), min(above, high_right))
                if (low_right < left[2 * start] or high_right > left[2 * start + 1]) and self._may_hold(
                    reach[start] - line[i], high_right - low_right
                ):
                    self._walk(start, slabs, exact)
        if self.best > 0.0:
            rectangle.write_corners(out, math.cos(angle), math.sin(angle), self.x1, self.x2, self.y1, self.y2)
        return self.best

    def _find_ways(self, slabs):
        """Find each trapezoid's reach to the right, and the widest ways through."""
        for t in range(self.first[0], self.first[1]):
            self.left[2 * t] = 1.0
            self.left[2 * t + 1] = 0.0
        for k in range(slabs - 1, -1, -1):
            if k + 1 < slabs:
                for t in range(self.first[k + 1], self.first[k + 2]):
                    self.left[2 * t] = 1.0
                    self.left[2 * t + 1] = 0.0
            signals.PyErr_CheckSignals()
            for start in range(self.first[k], self.first[k + 1]):
                far = self.line[k + 1]
                self.right[2 * start] = 1.0
                self.right[2 * start + 1] = 0.0
                if k + 1 < slabs:
                    for t in range(self.first[k + 1], self.first[k + 2]):
                        bottom_y = max(self.trapezoid[4 * t], self.trapezoid[4 * start + 2])
                        top_y = min(self.trapezoid[4 * t + 1], self.trapezoid[4 * start + 3])
                        wide = top_y - bottom_y
                        if wide <= 0.0:
                            continue
                        if self.reach[t] > far:
                            far = self.reach[t]
                        if wide > self.left[2 * t + 1] - self.left[2 * t]:
                            self.left[2 * t] = bottom_y
                            self.left[2 * t + 1] = top_y
                        if wide > self.right[2 * start + 1] - self.right[2 * start]:
                            self.right[2 * start] = bottom_y
                            self.right[2 * start + 1] = top_y
                self.reach[start] = far

    def _walk(self, start, slabs, exact):
        """Walk from a trapezoid to all where its rectangles may end."""
        i = self.slab[start]
        below = self.trapezoid[4 * start]
        above = self.trapezoid[4 * start + 1]
        low_right = self.trapezoid[4 * start + 2]
        high_right = self.trapezoid[4 * start + 3]
        left_low = self.left[2 * start]
        left_high = self.left[2 * start + 1]
        x = self.line[i]
        self.path[0] = start
        self.stack[0] = low_right
        self.stack[1] = high_right
        top = 1
        while top > 0:
            top -= 1
            k = self.slab[self.path[top]] + 1
            low_y = self.stack[2 * top]
            high_y = self.stack[2 * top + 1]
            if k >= slabs:
                continue
            width = self.line[k + 1] - x
            for t in range(self.first[k], self.first[k + 1]):
                bottom_y = max(low_y, self.trapezoid[4 * t])
                top_y = min(high_y, self.trapezoid[4 * t + 1])
                height = top_y - bottom_y
                if height <= 0.0:
                    continue
                if bottom_y >= left_low and top_y <= left_high:
                    continue
                if self._may_hold(width, height):
                    if exact:
                        if bottom_y < self.right[2 * t] or top_y > self.right[2 * t + 1]:
                            self._solve(i, k, bottom_y, top_y, start, t)
                    else:
                        self._offer(x, self.line[k], max(bottom_y, below), min(top_y, above))
                bottom_y = max(bottom_y, self.trapezoid[4 * t + 2])
                top_y = min(top_y, self.trapezoid[4 * t + 3])
                height = top_y - bottom_y
                if height <= 0.0:
                    continue
                if not exact:
                    self._offer(self.line[i + 1], self.line[k + 1], bottom_y, top_y)
                    self._offer(x, self.line[k + 1], max(bottom_y, below), min(top_y, above))
                if self._may_hold(self.reach[t] - x, height):
                    self.path[top] = t
                    self.stack[2 * top] = bottom_y
                    self.stack[2 * top + 1] = top_y
                    top += 1

    def _may_hold(self, width, height):
        return width * height > self.best

    def _offer(self, x1, x2, y1, y2):
        area = (x2 - x1) * (y2 - y1)
        if area > self.best:
            self.best = area
            self.x1 = x1
            self.x2 = x2
            self.y1 = y1
            self.y2 = y2

    def _solve(self, i, k, low, high, start, end):
        """Keep a pair's largest rectangle if it beats the best (see `_octagon`)."""
        floor = self.best
        n = self._octagon(i, k, low, high, start, end)
        if n < 3:
            return
        area = rectangle.largest_rectangle(self.ring, n, 0.0, floor, self.work, self.corner)
        if area > floor:
            self._offer(self.corner[0], self.corner[4], self.corner[1], self.corner[5])

    def _cut(self, angle):
        """Cut the turned outline into trapezoids; the number of slabs."""
        self._turn(angle)
        ys = self.ys
        rank = self.rank
        line = self.line
        first = self.first
        start = self.start
        slabs = self._rank() - 1
        if slabs < 1:
            return 0
        # Of each slab the edges across it, from the lowest: y on its left and right, and +1 below or -1 above the area.
        for k in range(slabs + 1):
            first[k] = 0
        for r in range(self.rings):
            i = start[r + 1] - 1
            for j in range(start[r], start[r + 1]):
                if rank[i] < rank[j]:
                    first[rank[i]] += 1
                    first[rank[j]] -= 1
                else:
                    first[rank[j]] += 1
                    first[rank[i]] -= 1
                i = j
        total = 0
        across = 0
        for k in range(slabs + 1):
            across += first[k]
            first[k] = total
            self.filled[k] = total
            total += across
        total = first[slabs]
        if total > self.many:
            self._make_many(2 * total)
        edge = self.edge
        filled = self.filled
        for r in range(self.rings):
            i = start[r + 1] - 1
            for j in range(start[r], start[r + 1]):
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
                    p = filled[k]
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
                signals.PyErr_CheckSignals()
        self._pair_edges(slabs)
        return slabs

    def _turn(self, angle):
        m = self.m
        cosine = math.cos(angle)
        sine = math.sin(angle)
        for i in range(m):
            self.xs[i] = cosine * self.points[2 * i] + sine * self.points[2 * i + 1]
            self.ys[i] = cosine * self.points[2 * i + 1] - sine * self.points[2 * i]
        # Shell's sort, from the order of the angle before: almost in order where that was near.
        gap = 1
        while 3 * gap + 1 < m:
            gap = 3 * gap + 1
        while gap > 0:
            for i in range(gap, m):
                p = self.order[i]
                key = self.xs[p]
                k = i
                while k >= gap and self.xs[self.order[k - gap]] > key:
                    self.order[k] = self.order[k - gap]
                    k -= gap
                self.order[k] = p
            gap //= 3

    def _rank(self):
        """Find the lines across through the vertices, and each vertex's; their number."""
        m = self.m
        lines = 0
        # nature: floating point, fifty roundings of the ring's width
        tolerance = 1e-14 * (self.xs[self.order[m - 1]] - self.xs[self.order[0]])
        for k in range(m):
            i = self.order[k]
            if k == 0 or self.xs[i] - self.line[lines - 1] > tolerance:
                self.line[lines] = self.xs[i]
                lines += 1
            self.rank[i] = lines - 1
        return lines

    def _pair_edges(self, slabs):
        """Make trapezoids of the edges between which the area lies."""
        # Trapezoids: bottom and top on the left, bottom and top on the right.
        count = 0
        for k in range(slabs):
            depth = 0.0
            p = self.first[k]
            q = self.first[k + 1]
            self.first[k] = count
            bottom = p
            while p < q:
                if depth <= 0.0 and depth + self.edge[3 * p + 2] > 0.0:
                    bottom = p
                elif depth > 0.0 and depth + self.edge[3 * p + 2] <= 0.0:
                    self.trapezoid[4 * count] = self.edge[3 * bottom]
                    self.trapezoid[4 * count + 1] = self.edge[3 * p]
                    self.trapezoid[4 * count + 2] = self.edge[3 * bottom + 1]
                    self.trapezoid[4 * count + 3] = self.edge[3 * p + 1]
                    for end in range(0, 4, 2):  # where near-duplicates let the edges cross, they meet
                        if self.trapezoid[4 * count + end] > self.trapezoid[4 * count + end + 1]:
                            middle = 0.5 * (self.trapezoid[4 * count + end] + self.trapezoid[4 * count + end + 1])
                            self.trapezoid[4 * count + end] = middle
                            self.trapezoid[4 * count + end + 1] = middle
                    self.slab[count] = k
                    count += 1
                depth += self.edge[3 * p + 2]
                p += 1
        self.first[slabs] = count

    def _octagon(self, i, k, low, high, start, end):
        """Region from slab i to slab k: the window, cut by the slants at its ends.

        Returns number of vertices, up to 8, in `ring`, counter-clockwise; below 3 if empty.
        """
        ring = self.ring
        x1 = self.line[i]
        x2 = self.line[k + 1]
        ring[0] = x1
        ring[6] = x1
        ring[2] = x2
        ring[4] = x2
        ring[1] = low
        ring[3] = low
        ring[5] = high
        ring[7] = high
        n = self._clip(4, x1, self.line[i + 1], 4 * start, low, high)
        return n if start == end else self._clip(n, self.line[k], x2, 4 * end, low, high)

    def _clip(self, n, x1, x2, at, low, high):
        """Clip the ring to a trapezoid's bottom and top from x1 to x2."""
        left = self.trapezoid[at]
        right = self.trapezoid[at + 2]
        if left > low or right > low:
            n = self._keep_left(n, x1, left, x2, right)
        left = self.trapezoid[at + 1]
        right = self.trapezoid[at + 3]
        if left < high or right < high:
            n = self._keep_left(n, x2, right, x1, left)
        return n

    def _keep_left(self, n, x1, y1, x2, y2):
        """Clip the ring to the left of a line through two points; its size."""
        ring = self.ring
        kept = self.kept
        dx = x2 - x1
        dy = y2 - y1
        count = 0
        for p in range(n):
            q = p + 1 if p + 1 < n else 0
            a = dx * (ring[2 * p + 1] - y1) - dy * (ring[2 * p] - x1)
            b = dx * (ring[2 * q + 1] - y1) - dy * (ring[2 * q] - x1)
            if a >= 0.0:
                count = _add(kept, count, ring[2 * p], ring[2 * p + 1])
            if (a < 0.0 < b) or (b < 0.0 < a):
                share = a / (a - b)
                x = ring[2 * p] + share * (ring[2 * q] - ring[2 * p])
                y = ring[2 * p + 1] + share * (ring[2 * q + 1] - ring[2 * p + 1])
                count = _add(kept, count, x, y)
        while count > 1 and kept[2 * count - 2] == kept[0] and kept[2 * count - 1] == kept[1]:
            count -= 1
        for p in range(2 * count):
            ring[p] = kept[p]
        return count


def _add(ring, n, x, y):
    """Add a vertex unless it repeats the last one; the ring's size."""
    if n > 0 and ring[2 * n - 2] == x and ring[2 * n - 1] == y:
        return n
    ring[2 * n] = x
    ring[2 * n + 1] = y
    return n + 1
