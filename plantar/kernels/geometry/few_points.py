"""Convex hull of a few points, without arrays."""

import math

import numpy as np

from . import hull

__all__ = ["FewPoints"]

_INFINITE = float("inf")


class FewPoints:
    """A few points, and the convex hull of some.

    Attributes:
        count: Number of points.
        corners: Number of corners of last hull.
    """

    def __init__(self):
        self.count = 0
        self.corners = 0
        self.room = 0
        self._make_room(16)

    def _make_room(self, room):
        points = np.zeros((room, 2))
        for i in range(self.count):
            points[i, 0], points[i, 1] = self.points[i, 0], self.points[i, 1]
        self.room = room
        self.points = points
        self.order = np.zeros(2 * room, dtype=np.intp)
        self.chain = np.zeros(2 * room, dtype=np.intp)
        self.ring = np.zeros((room, 2))
        self.corners = 0

    def clear(self):
        """Drop all points."""
        self.count = 0
        self.corners = 0

    def add(self, x, y):
        """Add the point x, y in m."""
        if self.count == self.room:
            self._make_room(2 * self.room)
        self.points[self.count, 0], self.points[self.count, 1] = x, y
        self.count += 1

    def add_some(self, other, first, end):
        """Add points `first` to `end`, exclusive, of another `FewPoints`."""
        for i in range(first, end):
            self.add(other.points[i, 0], other.points[i, 1])

    def hull(self, first, end):
        """Make the exact convex hull of points `first` to `end`, exclusive."""
        chosen = self.points[first:end]
        self.corners = hull.hull_of_cloud(chosen, self.order, self.chain)
        hull.gather(chosen, self.chain, self.corners, self.ring)

    def margin(self, x, y):
        """Signed distance in m of x, y in m to the hull's edge, positive inside; -inf if empty."""
        count = self.corners
        if count == 0:
            return -_INFINITE
        inner = outer = _INFINITE
        ax, ay = self.ring[count - 1, 0], self.ring[count - 1, 1]
        if count == 1:
            return -math.sqrt((x - ax) * (x - ax) + (y - ay) * (y - ay))
        for i in range(count):
            bx, by = self.ring[i, 0], self.ring[i, 1]
            lx, ly, dx, dy = bx - ax, by - ay, x - ax, y - ay
            length = math.sqrt(lx * lx + ly * ly)
            depth = (lx * dy - ly * dx) / length
            inner = min(inner, depth)
            if depth <= 0.0 or count == 2:
                t = min(1.0, max(0.0, (dx * lx + dy * ly) / (length * length)))
                px, py = dx - t * lx, dy - t * ly
                outer = min(outer, math.sqrt(px * px + py * py))
            ax, ay = bx, by
        return inner if inner > 0.0 and count > 2 else -outer

    def area(self):
        """Area of the hull in m^2."""
        total = 0.0
        if self.corners > 2:
            x, y = self.ring[0, 0], self.ring[0, 1]
            ax, ay = self.ring[1, 0] - x, self.ring[1, 1] - y
            for i in range(2, self.corners):
                bx, by = self.ring[i, 0] - x, self.ring[i, 1] - y
                total += ax * by - bx * ay
                ax, ay = bx, by
        return 0.5 * total

    def points_of(self, first, end):
        """Points `first` to `end`, exclusive, as tuples (x, y) in m."""
        return [(self.points[i, 0], self.points[i, 1]) for i in range(first, end)]

    def corners_of(self):
        """Hull's corners (x, y) in m, counter-clockwise from the lowest x."""
        return [(self.ring[i, 0], self.ring[i, 1]) for i in range(self.corners)]
