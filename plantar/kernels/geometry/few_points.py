"""Convex hull of a few points, without arrays."""

import numpy as np

from . import convex, hull

__all__ = ["FewPoints"]

_INFINITE = float("inf")


class FewPoints:
    """A few points, and the convex hull of some."""

    def __init__(self):
        self.count = 0
        self.corners = 0
        self.room = 0
        self._make_room(16)

    def _make_room(self, room):
        points = np.zeros((room, 2))
        for i in range(self.count):
            points[i, 0] = self.points[i, 0]
            points[i, 1] = self.points[i, 1]
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
        self.points[self.count, 0] = x
        self.points[self.count, 1] = y
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
        if self.corners == 0:
            return -_INFINITE
        return convex.margin_of_clean(self.ring[: self.corners], x, y)

    def area(self):
        """Area of the hull in m^2."""
        return convex.area(self.ring[: self.corners])

    def points_of(self, first, end):
        """Points `first` to `end`, exclusive, as tuples (x, y) in m."""
        return [(self.points[i, 0], self.points[i, 1]) for i in range(first, end)]

    def corners_of(self):
        """Hull's corners (x, y) in m, counter-clockwise from the lowest x."""
        return [(self.ring[i, 0], self.ring[i, 1]) for i in range(self.corners)]
