# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that searches an outline for its largest rectangle: at one angle, and at any.

Plain Python that also compiles ahead of time (`outline_search.pxd` gives the C types). `plantar.geometry.inscribed` is
the public face.
"""

from __future__ import annotations

import math

from ..base import work_arrays
from . import any_angle, concave, corridors, node_heap, windows

__all__ = ["OutlineSearch"]

_FEW = 160  # vertices up to which parts are looked at whole, not in windows, at any angle
_MANY = 500  # the same at one angle
_QUARTER = 0.5 * math.pi
_SWEEPS = 32  # intervals of a half turn in which columns stand
_FINE = 12.0  # columns across the side of a square of the best area
_START = 0.5  # pitch of the first columns in mean edges
_WIDEST = 0.2  # rad of the widest interval that the search in a part starts with, or so many times A / d^2
_SHARE = 1.2
_CLOSE = 8e-7  # share of the area that is not looked for
_PROVEN = 1e-6  # the same with what least steps in convex parts and rounding leave
_ROUNDING = 1e-12


class OutlineSearch:
    """Largest rectangles in an outline, with the work arrays they need.

    A rectangle w x h that is turned by t about its middle is the box around one w' x h' inside it, so w h = w' h' +
    (w'^2 + h'^2) sin 2t / 2: the rectangles at one angle bound what is there at angles near it. Intervals of angles,
    the one of the largest bound first, are looked at in their middle, what is clear around it is thrown away, and what
    is left goes back with the bound that was found, until nothing above the best area is left or the work is used up.
    `OutlineRectangles.clear` finds what is clear, to second order with `TurnBound`.

    Where there are many vertices, columns across the outline (`Corridors`) bound the rectangles of each interval first,
    and leave some windows, small pieces of the outline, in which it goes on as above.

    Attributes:
        gap: By what share of its area nothing is larger than the rectangle found last at any angle.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.outline = concave.OutlineRectangles(lists)
        self.turning = any_angle.AnyAngle(lists, self.outline)
        self.sweeps = corridors.Corridors(lists)
        self.windows = windows.Windows(lists)
        self.heap = node_heap.NodeHeap(lists)
        self.found = work_arrays.numbers(8, lists)
        self.turn = work_arrays.numbers(16, lists)
        self.parts = 0
        self.gap = 0.0

    def take(self, points, starts, apart):
        """Take an outline.

        Args:
            points: Vertices (k, 2) in m, the area on the left of each ring.
            starts: Offsets (r + 1,) of the rings.
            apart: Whether islands meet in points at most.
        """
        self.parts = self.outline.take(points, starts, apart)
        self.sweeps.restart()
        self.windows.spent = 0

    def _spent(self):
        """Units of work since the outline was taken."""
        return self.outline.spent + self.sweeps.spent + self.windows.spent

    def at_angle(self, angle, out):
        """Largest rectangle whose first side stands at an angle, exact.

        Args:
            angle: The angle in rad.
            out: Receives the 4 corners about the first point, flat, counter-clockwise.

        Returns:
            Its area; 0, and nothing in `out`, where there is none.
        """
        outline = self.outline
        best = 0.0
        if outline.gather(0.0) <= _MANY:
            for k in range(self.parts):
                if outline.choose(k) <= best:
                    break
                best = outline.largest(angle, best, out)
            return best
        best = self._start(angle, out)
        self.heap.clear()
        self.windows.clear()
        outline.gather(best)
        for side in range(2):
            self._sweep(angle + side * _QUARTER, 0.0, best)
        while self.heap.size > 0:
            self.heap.pop()
            if self.heap.bound <= best * (1.0 + _ROUNDING):
                break
            outline.load(self.windows, self.heap.place)
            best = outline.largest(angle, best, out)
        return best

    def _start(self, angle, out):
        """A good rectangle at an angle to start with: the largest one where columns leave most room."""
        outline = self.outline
        self.sweeps.sweep(outline.points, outline.start, outline.rings, angle, 0.0, self._first_pitch(), 0.0, True)
        if self.sweeps.boxes == 0:
            return outline.largest(angle, 0.0, out)
        self.windows.clear()
        self.windows.add(outline.points, outline.start, outline.rings, angle, self.sweeps.box, 0)
        outline.load(self.windows, 0)
        best = outline.largest(angle, 0.0, out)
        if best > 0.0:
            return best
        outline.gather(0.0)
        return outline.largest(angle, 0.0, out)

    def _first_pitch(self):
        """Pitch of columns for an outline of which nothing is known: a share of the mean edge."""
        outline = self.outline
        length = 0.0
        for r in range(outline.rings):
            i = outline.start[r + 1] - 1
            for j in range(outline.start[r], outline.start[r + 1]):
                dx = outline.points[2 * j] - outline.points[2 * i]
                dy = outline.points[2 * j + 1] - outline.points[2 * i + 1]
                length += math.hypot(dx, dy)
                i = j
        return _START * length / outline.m

    def _sweep(self, angle, half, best):
        """Keep the windows of an interval in which more than an area may stand."""
        outline = self.outline
        sweeps = self.sweeps
        pitch = math.sqrt(best) / _FINE
        sweeps.sweep(outline.points, outline.start, outline.rings, angle, half, pitch, best, False)
        for k in range(sweeps.boxes):
            window = self.windows.add(outline.points, outline.start, outline.rings, angle, sweeps.box, 5 * k)
            bound = min(sweeps.box[5 * k + 4], outline.part_area[outline.part[0]])
            self.heap.push(bound, angle - half, angle + half, window)

    def at_any_angle(self, best, budget, out):
        """Largest rectangle at any angle, or a good one and how much larger others may be.

        Args:
            best: Area of a rectangle whose first side stands at angle 0; 0 where there is none.
            budget: Units of work after which the search ends; some microseconds hold a thousand of them.
            out: Holds that rectangle's corners; receives those of the one found.

        Returns:
            Its area; what is not known of larger ones stands in `gap`.
        """
        outline = self.outline
        turning = self.turning
        turning.convex = False
        turning.fine = 1.0
        turning.best = best
        turning.best_angle = 0.0
        for i in range(8):
            self.found[i] = out[i]
        self.heap.clear()
        self.windows.clear()
        self.gap = 0.0
        if outline.gather(best) <= _FEW:
            self._begin_with_parts(out)
        elif best > 0.0:
            self._begin_with_windows(budget)
        self._search(budget, out)
        for i in range(8):
            out[i] = self.found[i]
        return turning.best

    def _begin_with_parts(self, out):
        """Keep the angles of each part, between the directions of its edges; convex parts are done at once."""
        outline = self.outline
        turning = self.turning
        best_part = -1
        for k in range(self.parts):  # a good start first: it throws most of the other parts away
            if outline.choose(k) <= turning.best:
                break
            before = turning.best
            turning.seed(outline.points, outline.m, out)
            if turning.best > before:
                best_part = k
                self._keep(out)
        if best_part >= 0:
            outline.choose(best_part)
            if not outline.is_convex():  # those that are convex are climbed in as they are searched
                outline.measure()
                self._climb(turning.best_angle, turning.best, out)
        for k in range(self.parts):
            area = outline.choose(k)
            if area <= turning.best:
                break
            if outline.is_convex():
                self._march(out)
            else:
                window = self.windows.add_whole(outline.points, outline.start, outline.rings)
                self._divide(area, window)

    def _march(self, out):
        """Search a convex part."""
        outline = self.outline
        turning = self.turning
        before = turning.best
        turning.take_ring(outline.points, outline.m)
        turning.march(out)
        self.gap = max(self.gap, turning.gap)
        if turning.best > before:
            turning.best = turning.largest(turning.best_angle, 0.0, out)
            self._keep(out)
        turning.convex = False
        turning.fine = 1.0

    def _divide(self, area, window):
        """Keep a quarter turn in a window: between directions of edges, where areas have corners, none too wide."""
        outline = self.outline
        turning = self.turning
        turn = self.turn
        count = turning.find_directions(outline.points, outline.m)
        for k in range(count):
            turn[k] = turning.direction[k]
        turn[count] = turning.best_angle % _QUARTER
        turn[count + 1] = _QUARTER
        count += 2
        for k in range(1, count):
            angle = turn[k]
            i = k
            while i > 0 and turn[i - 1] > angle:
                turn[i] = turn[i - 1]
                i -= 1
            turn[i] = angle
        widest = max(0.02, min(_WIDEST, _SHARE * turning.best / self.windows.reach2[window]))
        low = 0.0
        for k in range(count):
            if turn[k] - low < 1e-12:
                continue
            pieces = int((turn[k] - low) / widest) + 1
            for i in range(pieces):
                at = low + (turn[k] - low) * i / pieces
                self.heap.push(area, at, low + (turn[k] - low) * (i + 1) / pieces, window)
            low = turn[k]

    def _begin_with_windows(self, budget):
        """Keep the windows that columns leave, interval by interval of a half turn of the long side."""
        outline = self.outline
        best = self.turning.best
        half = math.pi / (2 * _SWEEPS)
        for k in range(_SWEEPS):
            if self._spent() >= budget:
                self.heap.push(outline.part_area[outline.part[0]], 0.0, math.pi, -1)
                return
            self.sweeps.allow(budget - self._spent())
            self._sweep((2 * k + 1) * half, half * (1.0 + _ROUNDING), best)

    def _search(self, budget, out):
        """Look at the intervals, the one of the largest bound first, until nothing is left or the work is used up."""
        outline = self.outline
        turning = self.turning
        heap = self.heap
        loaded = -1
        while heap.size > 0:
            heap.pop()
            bound = heap.bound
            if bound <= turning.best * (1.0 + _CLOSE):
                break
            if self._spent() >= budget or heap.place < 0:
                self.gap = max(self.gap, bound / turning.best - 1.0 if turning.best > 0.0 else math.inf)
                return
            if heap.place != loaded:
                loaded = heap.place
                outline.load(self.windows, loaded)
            outline.allow(budget - self._spent())
            self._look(bound, heap.low, heap.high, loaded, out)
        self.gap = max(self.gap, _PROVEN) if turning.best > 0.0 else math.inf

    def _look(self, bound, low, high, window, out):
        """Look at the middle of an interval, and keep what is not clear."""
        outline = self.outline
        turning = self.turning
        middle = 0.5 * (low + high)
        half = 0.5 * (high - low)
        area = outline.clear(middle, half, turning.best * (1.0 + _CLOSE), out)
        if area > turning.best:
            self._climb(middle, area, out)
            outline.clear(middle, half, turning.best * (1.0 + _CLOSE), out)
        if outline.ended:
            self.heap.push(bound, low, high, window)
            return
        bound = min(bound, outline.most)
        if outline.clear_low < half:
            self.heap.push(bound, low, middle - outline.clear_low, window)
        if outline.clear_high < half:
            self.heap.push(bound, middle + outline.clear_high, high, window)

    def _climb(self, angle, area, out):
        """Keep the rectangle at an angle, in `out`, and climb to the summit beside it."""
        turning = self.turning
        self._keep(out)
        turning.climb(angle, area, out)
        beyond = self.outline.largest(turning.best_angle, area, out)
        turning.best = area
        if beyond > area:
            turning.best = beyond
            self._keep(out)

    def _keep(self, out):
        """Keep the corners of the best rectangle."""
        for i in range(8):
            self.found[i] = out[i]
