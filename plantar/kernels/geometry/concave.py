# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel for the largest rectangle in an outline with islands and holes, exact.

Plain Python that also compiles ahead of time (`concave.pxd` gives the C types). `plantar.inscribed` is the public face.
"""

from __future__ import annotations

import math

from ..base import signals, work_arrays
from . import rectangle

__all__ = ["OutlineRectangles"]

_ASK = 1 << 19  # units of work between two looks for signals
_INF = math.inf


class OutlineRectangles:
    """Largest rectangles of outlines, with the work arrays they need.

    The arrays are written to by every call: compiled calls follow each other, interpreted ones need an object each.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.m = 0
        self.rings = 0
        self.given_rings = 0
        self.parts = 0
        self.room = 0
        self.many = 0
        self._make_given(64, 16)
        self._make_room(64, 16)
        self._make_many(512)
        self.ring = work_arrays.numbers(18, self.lists)
        self.work = work_arrays.numbers(96, self.lists)
        self.corner = work_arrays.numbers(8, self.lists)
        self.spent = 0
        self.next_look = _ASK
        self.limit = _INF
        self.ended = False
        self.best = 0.0
        self.found = False
        self.x1 = 0.0
        self.x2 = 0.0
        self.y1 = 0.0
        self.y2 = 0.0

    def _make_given(self, points, rings):
        """Work arrays for an outline of so many points and rings."""
        self.given = work_arrays.numbers(2 * points, self.lists)
        self.given_start = work_arrays.places(rings + 1, self.lists)
        self.owner = work_arrays.places(rings + 1, self.lists)
        self.part = work_arrays.places(rings + 1, self.lists)
        self.ring_area = work_arrays.numbers(rings + 1, self.lists)
        self.part_area = work_arrays.numbers(rings + 1, self.lists)

    def _make_room(self, points, rings):
        """Work arrays for what is looked at, so many points and rings."""
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
        """Work arrays for so many edges across slabs."""
        self.many = total
        self.edge = work_arrays.numbers(3 * total, self.lists)
        self.trapezoid = work_arrays.numbers(2 * total + 4, self.lists)
        self.reach = work_arrays.numbers(total // 2 + 1, self.lists)
        self.left = work_arrays.numbers(total + 2, self.lists)
        self.right = work_arrays.numbers(total + 2, self.lists)
        self.stack = work_arrays.numbers(total + 4, self.lists)
        self.path = work_arrays.places(total // 2 + 2, self.lists)
        self.slab = work_arrays.places(total // 2 + 1, self.lists)

    def take(self, points, starts, apart):
        """Take an outline, and find its parts: each island with its holes.

        Args:
            points: Vertices (k, 2) in m, the area on the left of each ring.
            starts: Offsets (r + 1,) of the rings.
            apart: Whether islands meet in points at most, so that no rectangle lies in two; all rings are one part
                where they may share edges.

        Returns:
            Number of parts, the one of most area first.
        """
        m = points.shape[0]
        rings = len(starts) - 1
        if m > self.room or rings + 1 > len(self.start):
            self._make_room(max(2 * m, self.room), max(2 * rings, len(self.start)))
        if 2 * m > len(self.given) or rings + 1 > len(self.owner):
            self._make_given(max(2 * m, 64), max(2 * rings, 16))
        self.given_rings = rings
        self.spent = 0
        self.next_look = _ASK
        self.allow(_INF)
        for i in range(m):
            self.given[2 * i] = points[i, 0] - points[0, 0]
            self.given[2 * i + 1] = points[i, 1] - points[0, 1]
        for r in range(rings + 1):
            self.given_start[r] = starts[r]
        self.parts = 0
        whole = 0.0
        for r in range(rings):
            a = self.given_start[r]
            b = self.given_start[r + 1]
            twice = 0.0
            j = b - 1
            for i in range(a, b):
                twice += (self.given[2 * j] - self.given[2 * a]) * (self.given[2 * i + 1] - self.given[2 * a + 1]) - (
                    self.given[2 * i] - self.given[2 * a]
                ) * (self.given[2 * j + 1] - self.given[2 * a + 1])
                j = i
            self.ring_area[r] = 0.5 * twice
            whole += 0.5 * twice
            if twice > 0.0:
                self.part[self.parts] = r
                self.part_area[r] = 0.5 * twice
                self.parts += 1
                self.owner[r] = r
        if not apart or self.parts < 2:
            for r in range(rings):
                self.owner[r] = 0
            self.part[0] = 0
            self.part_area[0] = whole
            self.parts = 1
            return 1
        for r in range(rings):
            if self.ring_area[r] <= 0.0:
                self.owner[r] = self._around(r)
                self.part_area[self.owner[r]] += self.ring_area[r]
        for i in range(1, self.parts):
            r = self.part[i]
            j = i
            while j > 0 and self.part_area[self.part[j - 1]] < self.part_area[r]:
                self.part[j] = self.part[j - 1]
                j -= 1
            self.part[j] = r
        return self.parts

    def allow(self, work):
        """Allow so many units of work from now on; what then ends too early says so in `ended`, and finds less."""
        self.limit = self.spent + work
        self.ended = False

    def _count(self, work):
        """Count some units of work, and look for signals from time to time."""
        self.spent += work
        if self.spent > self.next_look:
            self.next_look = self.spent + _ASK
            signals.PyErr_CheckSignals()

    def _around(self, hole):
        """The smallest rim that encloses the middle of a hole's first edge."""
        given = self.given
        a = self.given_start[hole]
        x = 0.5 * (given[2 * a] + given[2 * a + 2])
        y = 0.5 * (given[2 * a + 1] + given[2 * a + 3])
        best = -1
        for k in range(self.parts):
            r = self.part[k]
            inside = False
            j = self.given_start[r + 1] - 1
            for i in range(self.given_start[r], self.given_start[r + 1]):
                if (given[2 * i + 1] > y) != (given[2 * j + 1] > y):
                    share = (y - given[2 * i + 1]) / (given[2 * j + 1] - given[2 * i + 1])
                    if x < given[2 * i] + share * (given[2 * j] - given[2 * i]):
                        inside = not inside
                j = i
            if inside and (best < 0 or self.ring_area[r] < self.ring_area[best]):
                best = r
        return best if best >= 0 else self.part[0]

    def choose(self, k):
        """Look at one part of the outline from now on.

        Args:
            k: Which part, from that of most area.

        Returns:
            Its area.
        """
        chosen = self.part[k]
        m = 0
        rings = 0
        for r in range(self.given_rings):
            if self.owner[r] != chosen and self.parts > 1:
                continue
            self.start[rings] = m
            rings += 1
            for i in range(self.given_start[r], self.given_start[r + 1]):
                self.points[2 * m] = self.given[2 * i]
                self.points[2 * m + 1] = self.given[2 * i + 1]
                self.order[m] = m
                m += 1
        self.start[rings] = m
        self.rings = rings
        self.m = m
        return self.part_area[chosen]

    def largest(self, angle, floor, out):
        """Largest rectangle in the chosen part whose first side stands at an angle.

        Lines across through every vertex cut the area into trapezoids in slabs. A rectangle starts in one trapezoid,
        ends in another one and crosses those between; what it may then use is convex: a window in y, and the slants of
        the first and the last trapezoid. Branch and bound over the pairs: the box of the window bounds what a pair can
        give, and the pairs that are left are solved as convex polygons.

        Args:
            angle: Angle of the first side in rad.
            floor: Look for more than this area only; 0 to find the largest.
            out: Receives the 4 corners, flat, counter-clockwise; untouched unless the area is above the floor.

        Returns:
            Its area; the floor where there is none above it.
        """
        return self._enumerate(angle, floor, out)

    def _enumerate(self, angle, floor, out):
        """Branch and bound over the pairs of trapezoids that a rectangle starts and ends in.

        Where all of a pair's window passes through one way into the trapezoid before the first, what starts in the
        first goes on at least up to the way, which the pair with that one may use too: the pair is left out, likewise
        at the end. So each rectangle lies in what some pair that is left may use.
        """
        slabs = self._cut(angle)
        if slabs < 1:
            return floor
        self._find_ways(slabs, floor)
        line = self.line
        slab = self.slab
        reach = self.reach
        left = self.left
        trapezoid = self.trapezoid
        count = self.first[slabs]
        self.best = floor
        self.found = False
        # First pass: rectangles between lines, a good start. Second pass: whatever two trapezoids may still give.
        for exact in range(1 if floor > 0.0 else 0, 2):
            for start in range(count):
                self._count(1)
                if self.spent > self.limit:
                    self.ended = True
                    break
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
        if self.found:
            rectangle.write_corners(out, math.cos(angle), math.sin(angle), self.x1, self.x2, self.y1, self.y2)
        return self.best

    def _find_ways(self, slabs, floor):
        """Find how far to the right a rectangle can get from each trapezoid, and the widest ways through its sides."""
        # How far to the right a rectangle can get from a trapezoid, if it is high enough for more than the floor. And
        # the widest ways through its sides: what passes there unhindered goes on, and need not start or end here.
        least = floor / (self.line[slabs] - self.line[0])
        for t in range(self.first[0], self.first[1]):
            self.left[2 * t] = 1.0
            self.left[2 * t + 1] = 0.0
        for k in range(slabs - 1, -1, -1):
            if k + 1 < slabs:
                for t in range(self.first[k + 1], self.first[k + 2]):
                    self.left[2 * t] = 1.0
                    self.left[2 * t + 1] = 0.0
            if k + 1 < slabs:
                self._count((self.first[k + 1] - self.first[k]) * (self.first[k + 2] - self.first[k + 1]))
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
                        if wide > least and self.reach[t] > far:
                            far = self.reach[t]
                        if wide > self.left[2 * t + 1] - self.left[2 * t]:
                            self.left[2 * t] = bottom_y
                            self.left[2 * t + 1] = top_y
                        if wide > self.right[2 * start + 1] - self.right[2 * start]:
                            self.right[2 * start] = bottom_y
                            self.right[2 * start + 1] = top_y
                self.reach[start] = far

    def _walk(self, start, slabs, exact):
        """Walk from a trapezoid to all those to the right in which a rectangle that starts in it may end."""
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
                self.spent += 1
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
        """Whether a box may hold more than the best so far."""
        return width * height > self.best

    def _offer(self, x1, x2, y1, y2):
        """Keep a rectangle if it is larger than the best so far."""
        area = (x2 - x1) * (y2 - y1)
        if area > self.best:
            self.best = area
            self.x1 = x1
            self.x2 = x2
            self.y1 = y1
            self.y2 = y2
            self.found = True

    def _solve(self, i, k, low, high, start, end):
        """Keep the largest rectangle of a pair of trapezoids if it is larger than the best so far (see `_octagon`)."""
        floor = self.best
        self.spent += 20
        n = self._octagon(i, k, low, high, start, end)
        if n < 3:
            return
        area = rectangle.largest_rectangle(self.ring, n, 0.0, floor, self.work, self.corner)
        if area > floor:
            self._offer(self.corner[0], self.corner[4], self.corner[1], self.corner[5])

    def _cut(self, angle):
        """Cut the part, turned back by an angle, into trapezoids; the number of slabs."""
        self._turn(angle)
        m = self.m
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
        self.spent += 3 * total + 4 * m
        if total > self.many:
            self._make_many(2 * total)
        edge = self.edge
        filled = self.filled
        moved = 0
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
                        moved += 1
                    edge[3 * p] = left
                    edge[3 * p + 1] = right
                    edge[3 * p + 2] = side
                    filled[k] += 1
                    left = right
                i = j
                if moved > _ASK // 4:
                    self._count(moved)
                    moved = 0
        self._count(moved)
        self._pair_edges(slabs)
        return slabs

    def _turn(self, angle):
        """Turn the vertices back by an angle, and order them by x."""
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
        """Find the lines across through the vertices, and which each vertex is on; the number of lines."""
        m = self.m
        lines = 0
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
        """What a rectangle may use that starts in one trapezoid and ends in another: a window, cut by their slants.

        Args:
            i: Slab of the first trapezoid; k of the last one.
            low: Bottom of the window in m, at or above the bottoms at xb and xc; likewise high.
            start: Index of the first trapezoid; end of the last one.

        Returns:
            Number of vertices, up to 8, in `ring`, counter-clockwise; 0 where nothing is left.
        """
        ring = self.ring
        trapezoid = self.trapezoid
        xa = self.line[i]
        xb = self.line[i + 1]
        xc = self.line[k]
        xd = self.line[k + 1]
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
