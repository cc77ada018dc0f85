# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that turns the largest rectangle of a convex ring or of an outline to its best angle.

Plain Python that also compiles ahead of time (`any_angle.pxd` gives the C types). `plantar.inscribed` is the public
face.
"""

from __future__ import annotations

import math

import numpy as np

from . import concave, rectangle

__all__ = ["AnyAngle"]

_QUARTER = 0.5 * math.pi
_GOLDEN = 0.3819660112501051
_PIECES = 12  # intervals of a quarter turn that the search starts with
_SEEDS = 6  # directions of edges that are looked at first
_FINE = 6e-3  # half an interval in rad below which one summit at most is taken to stand in it
_CLOSE = 2e-7  # share of the area that is not looked for
_SECTIONS = 48
_STEP = 1e-6  # rad to either side by which a summit is told


class AnyAngle:
    """Largest rectangles at any angle, with the work arrays they need.

    A rectangle of area A that is turned by t about its middle still holds one of A - d^2 t at the old angle, d its
    diagonal. So the largest area at one angle bounds what is there at angles near it: intervals of a quarter turn are
    cut and thrown away until those that are left are narrow, and in these the summit is found by golden sections.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.convex = False
        self.n = 0
        self.best = 0.0
        self.best_angle = 0.0
        self.stack = self._numbers(512)
        self.outline = concave.OutlineRectangles(lists)

    def _numbers(self, size):
        return [0.0] * size if self.lists else np.zeros(size)

    def in_ring(self, ring, n, work, out):
        """Largest rectangle in a convex ring.

        Args:
            ring: Clean convex ring, counter-clockwise, near the origin; flat.
            n: Number of vertices, 3 or more.
            work: Room for 8 n + 16 numbers.
            out: Receives the 4 corners, flat, counter-clockwise.

        Returns:
            Its area.
        """
        self.convex = True
        self.ring = ring
        self.n = n
        self.work = work
        self.best = 0.0
        self.best_angle = 0.0
        self._seed(ring, n, out)
        self._search(ring, n, out)
        return self._largest(self.best_angle, 0.0, out)

    def in_outline(self, points, starts, apart, out):
        """Largest rectangle in an outline.

        Args:
            points: Vertices (k, 2) in m, the area on the left of each ring.
            starts: Offsets (r + 1,) of the rings.
            apart: Whether islands meet in points at most.
            out: Receives the 4 corners about the first point, flat, counter-clockwise.

        Returns:
            Its area.
        """
        self.convex = False
        self.best = 0.0
        self.best_angle = 0.0
        outline = self.outline
        parts = outline.take(points, starts, apart)
        best_part = 0
        for k in range(parts):  # a good start first: it throws most of the other parts away
            if outline.choose(k) <= self.best:
                break
            before = self.best
            self._seed(outline.points, outline.m, out)
            if self.best > before:
                best_part = k
        for k in range(parts):
            if outline.choose(k) <= self.best:
                break
            before = self.best
            self._search(outline.points, outline.m, out)
            if self.best > before:
                best_part = k
        outline.choose(best_part)
        return self._largest(self.best_angle, 0.0, out)

    def _largest(self, angle, floor, out):
        """Largest rectangle at one angle; the floor where it is not above it."""
        if self.convex:
            return rectangle.largest_rectangle(self.ring, self.n, angle, floor, self.work, out)
        return self.outline.largest(angle, floor, out)

    def _seed(self, points, n, out):
        """Try the directions of some edges."""
        stack = self.stack
        count = 0
        for i in range(n - 1):
            dx = points[2 * i + 2] - points[2 * i]
            dy = points[2 * i + 3] - points[2 * i + 1]
            angle = (math.atan2(dy, dx) + 4.0 * _QUARTER) % _QUARTER
            known = False
            for k in range(count):
                if abs(stack[k] - angle) < 1e-6 or abs(stack[k] - angle) > _QUARTER - 1e-6:
                    known = True
            if known:
                continue
            stack[count] = angle
            count += 1
            area = self._largest(angle, self.best, out)
            if area > self.best:
                self.best = area
                self.best_angle = angle
            if count == _SEEDS:
                break

    def _search(self, points, n, out):
        """Search all angles of a quarter turn for more than the best so far."""
        reach2 = 0.0  # square of the diameter
        for i in range(n):
            for j in range(i):
                dx = points[2 * i] - points[2 * j]
                dy = points[2 * i + 1] - points[2 * j + 1]
                reach2 = max(reach2, dx * dx + dy * dy)
        if self.best > 0.0:
            self._climb(self.best_angle - _FINE, self.best_angle, self.best_angle + _FINE, self.best, out)
        stack = self.stack
        for k in range(_PIECES):
            stack[2 * k] = _QUARTER * k / _PIECES
            stack[2 * k + 1] = _QUARTER * (k + 1) / _PIECES
        top = _PIECES
        while top > 0:
            top -= 1
            low = stack[2 * top]
            high = stack[2 * top + 1]
            middle = 0.5 * (low + high)
            half = 0.5 * (high - low)
            floor = max(0.0, self.best * (1.0 + _CLOSE) - reach2 * half)
            area = self._largest(middle, floor, out)
            if area <= floor:
                continue
            if area > self.best:
                self.best = area
                self.best_angle = middle
                self._climb(low, middle, high, area, out)
            if half <= _FINE:
                self._refine(low, middle, high, area, out)
                continue
            safe = (self.best * (1.0 + _CLOSE) - area) / reach2
            if safe >= half:
                continue
            if top + 2 <= len(stack) // 2:
                stack[2 * top] = low
                stack[2 * top + 1] = middle - safe
                stack[2 * top + 2] = middle + safe
                stack[2 * top + 3] = high
                top += 2

    def _refine(self, low, middle, high, area, out):
        """Look for a summit in a narrow interval, unless what it rises by at its ends leaves no room for one."""
        half = middle - low
        before = self._largest(low, 0.5 * area, out)
        after = self._largest(high, 0.5 * area, out)
        summit = max(area, max(before, after))
        rise = max(abs(area - before), abs(area - after))
        if summit + rise <= self.best * (1.0 + _CLOSE):
            return
        if before > area and before >= after:
            self._climb(low - half, low, middle, before, out)
        elif after > area:
            self._climb(middle, high, high + half, after, out)
        else:
            self._climb(low, middle, high, area, out)

    def _climb(self, low, middle, high, area, out):
        """Golden sections round a summit; the best so far where it is higher."""
        side = middle + _STEP
        beside = self._largest(side, area, out)
        if beside > area:
            low = middle
        else:
            side = middle - _STEP
            beside = self._largest(side, area, out)
            if beside > area:
                high = middle
        if beside > area:
            middle = side
            area = beside
        else:  # the summit itself, as edges and corners that touch make them
            low = high
        for _ in range(_SECTIONS):
            if high - low < 1e-8:
                break
            if high - middle > middle - low:
                angle = middle + _GOLDEN * (high - middle)
            else:
                angle = middle - _GOLDEN * (middle - low)
            trial = self._largest(angle, area, out)
            if trial > area:
                if angle > middle:
                    low = middle
                else:
                    high = middle
                middle = angle
                area = trial
            elif angle > middle:
                high = angle
            else:
                low = angle
        if area > self.best:
            self.best = area
            self.best_angle = middle
