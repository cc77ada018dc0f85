# cython: infer_types=True
"""From any polygon to a shape's corners in or around it."""

import math

import numpy as np

from ..base import work_arrays
from . import clean, concave, enclosing, inscribed, parallelogram, rectangle

__all__ = ["ConvexShapes"]

_LARGEST = 1e100  # nature: floating point: coordinates in m beyond count as not finite, as by `hull`
_INF = math.inf
_QUARTER = 0.5 * math.pi  # nature: a right angle in rad


class ConvexShapes:
    """Shapes of convex polygons (k, 2), with work arrays.

    `lists`: keep lists instead of arrays, faster when interpreted.
    """

    def __init__(self, lists):
        self.lists = lists
        self.ring = work_arrays.numbers(64, self.lists)
        self.work = work_arrays.numbers(512, self.lists)
        self.out = work_arrays.numbers(8, self.lists)
        self.outline = concave.OutlineRectangles(lists)
        self.n = 0
        self.x = 0.0
        self.y = 0.0

    def _clean(self, polygon):
        """Copy a polygon into `ring`, clean and counter-clockwise; its size."""
        k = polygon.shape[0]
        if 2 * k + 2 > len(self.ring):
            self.ring = work_arrays.numbers(4 * k + 2, self.lists)
            self.work = work_arrays.numbers(8 * (2 * k) + 128, self.lists)  # as many as the ring takes
        i = clean.anchor(polygon)
        self.x = float(polygon[i, 0]) if i < k else 0.0
        self.y = float(polygon[i, 1]) if i < k else 0.0
        turn = clean.turning(polygon, self.x, self.y, 0.0)
        if turn != 0:
            self._take(polygon, turn < 0, self.x, self.y)
        else:
            self._take(clean.clean_ring(polygon, self.x, self.y, 0.0), False, 0.0, 0.0)
        if self.n > 2:
            self.n = inscribed.ends_of_flat(self.ring, self.n)
        return self.n

    def _take(self, polygon, backwards, x0, y0):
        """Copy a clean polygon into `ring`, about a point, from its first vertex."""
        ring = self.ring
        n = polygon.shape[0]
        for i in range(n):
            j = n - i if backwards and i > 0 else i
            ring[2 * i] = float(polygon[j, 0]) - x0
            ring[2 * i + 1] = float(polygon[j, 1]) - y0
        self.n = n

    def _corners(self, count):
        """First corners of `out`, at the polygon's place."""
        room = np.empty((count, 2))
        corners = room
        for i in range(count):
            corners[i, 0] = self.out[2 * i] + self.x
            corners[i, 1] = self.out[2 * i + 1] + self.y
        return room

    def _flat(self, count):
        """Shape of a polygon without area: to one end and back; none if empty."""
        if self.n == 0:
            return np.empty((0, 2))
        for i in range(count):
            end = 2 if self.n == 2 and 0 < i <= count // 2 else 0
            self.out[2 * i] = self.ring[end]
            self.out[2 * i + 1] = self.ring[end + 1]
        return self._corners(count)

    def _middle(self, count):
        """Corners all at the middle of a polygon without area; none if empty."""
        if self.n == 0:
            return np.empty((0, 2))
        for i in range(count):
            self.out[2 * i] = 0.5 * (self.ring[0] + self.ring[2 * self.n - 2])
            self.out[2 * i + 1] = 0.5 * (self.ring[1] + self.ring[2 * self.n - 1])
        return self._corners(count)

    def triangle(self, polygon):
        """Corners of the largest triangle inside."""
        if self._clean(polygon) < 3:
            return self._flat(3)
        inscribed.largest_triangle(self.ring, self.n, self.out)
        return self._corners(3)

    def parallelogram(self, polygon):
        """Corners of the largest parallelogram inside."""
        if self._clean(polygon) < 3:
            return self._flat(4)
        parallelogram.largest_parallelogram(self.ring, self.n, self.out)
        return self._corners(4)

    def circle(self, polygon):
        """Center (1, 2), none for an empty polygon, and radius of the largest circle inside."""
        if self._clean(polygon) < 3:
            return self._middle(1), 0.0
        radius = inscribed.largest_circle(self.ring, self.n, self.work, self.out)
        return self._corners(1), radius

    def rectangle(self, polygon, angle):
        """Corners of the largest rectangle inside, its first side at an angle."""
        if self._clean(polygon) < 3:
            return self._middle(4)
        size = rectangle.largest_rectangle(self.ring, self.n, angle, 0.0, self.work, self.out)
        if size <= 0.0:
            return self._middle(4)
        if self._leans(angle):  # an edge almost upright: better conditioned with x and y exchanged
            after = rectangle.largest_rectangle(self.ring, self.n, angle + _QUARTER, size, self.work, self.out)
            if after > size:  # the first corner of the turned rectangle is the lower right one
                x = self.out[6]
                y = self.out[7]
                for i in range(7, 1, -1):
                    self.out[i] = self.out[i - 2]
                self.out[0] = x
                self.out[1] = y
        return self._corners(4)

    def _leans(self, angle):
        """Whether an edge is almost, not quite, at a right angle to a direction."""
        c = math.cos(angle)
        s = math.sin(angle)
        for i in range(self.n):
            j = i + 1 if i + 1 < self.n else 0
            dx = self.ring[2 * j] - self.ring[2 * i]
            dy = self.ring[2 * j + 1] - self.ring[2 * i + 1]
            along = abs(c * dx + s * dy)
            across = abs(c * dy - s * dx)
            # nature: floating point, five roundings, up to edges that stand out by a thousandth
            if 1e-15 * across < along < 1e-3 * across:
                return True
        return False

    def rectangle_in_outline(self, points, starts, angle):
        """Corners of the largest rectangle in an outline at an angle; one point without area."""
        self.outline.take(points, starts)
        self.x = points[0, 0]
        self.y = points[0, 1]
        if self.outline.largest(angle, self.out) <= 0.0:
            for i in range(8):
                self.out[i] = 0.0
        return self._corners(4)

    def box(self, polygon):
        """Corners of the rectangle of least area around."""
        if self._clean(polygon) < 3:
            return self._flat(4)
        enclosing.least_box(self.ring, self.n, self.out)
        return self._corners(4)

    def parallelogram_around(self, polygon):
        """Corners of the parallelogram of least area around."""
        if self._clean(polygon) < 3:
            return self._flat(4)
        enclosing.least_parallelogram(self.ring, self.n, self.work, self.out)
        return self._corners(4)

    def bounding_box(self, points):
        """Corners of the axis-aligned box around finite points."""
        low_x = _INF
        low_y = _INF
        high_x = -_INF
        high_y = -_INF
        for i in range(points.shape[0]):
            x = float(points[i, 0])
            y = float(points[i, 1])
            if abs(x) <= _LARGEST and abs(y) <= _LARGEST:
                low_x = min(low_x, x)
                low_y = min(low_y, y)
                high_x = max(high_x, x)
                high_y = max(high_y, y)
        if low_x > high_x:
            return np.empty((0, 2))
        room = np.empty((4, 2))
        corners = room
        for i in range(4):
            corners[i, 0] = high_x if i == 1 or i == 2 else low_x
            corners[i, 1] = high_y if i >= 2 else low_y
        return room
