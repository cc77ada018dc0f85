"""Kernels of the convex hull of a few points, for which making arrays costs more than the hull itself."""

from __future__ import annotations

import math

import numpy as np

__all__ = ["FewPoints", "small_hull"]

_INFINITE = float("inf")
_FLAT = 1e-9  # m^2: twice the area of a triangle that still counts as a straight line


def small_hull(points, tolerance=1e-9):
    """Convex hull of a few points given as tuples: the array function costs ten times as much on eight points.

    Args:
        points: Points (x, y) in m.
        tolerance: Twice the area in m^2 of a triangle that still counts as a straight line.

    Returns:
        Hull as a list of points, counter-clockwise from the lowest x.
    """
    cloud = sorted(set(points))
    if len(cloud) < 3:
        return cloud
    ring = []
    for _ in range(2):
        part = []
        for p in cloud:
            px, py = p
            while len(part) >= 2:
                ax, ay = part[len(part) - 2]
                bx, by = part[len(part) - 1]
                if (bx - ax) * (py - ay) - (by - ay) * (px - ax) > tolerance:
                    break
                part.pop()
            part.append(p)
        part.pop()
        ring += part
        cloud.reverse()
    return ring


class FewPoints:
    """A few points, gathered anew again and again, and the convex hull of some of them.

    Attributes:
        count: Number of points.
        corners: Number of corners of the hull that was made last.
    """

    def __init__(self):
        self.count = 0
        self.corners = 0
        self.room = 0
        self._make_room(16)

    def _make_room(self, room):
        """Room for so many points; those that are there stay, the hull is forgotten."""
        points = np.zeros((room, 2))
        for i in range(self.count):
            points[i, 0], points[i, 1] = self.points[i, 0], self.points[i, 1]
        self.room = room
        self.points = points
        self.cloud = np.zeros((room, 2))
        self.ring = np.zeros((2 * room, 2))
        self.corners = 0

    def clear(self):
        """No points at all."""
        self.count = 0
        self.corners = 0

    def add(self, x, y):
        """Add a point.

        Args:
            x: Where it is in m.
            y: The same.
        """
        if self.count == self.room:
            self._make_room(2 * self.room)
        self.points[self.count, 0], self.points[self.count, 1] = x, y
        self.count += 1

    def hull(self, first, end):
        """Make the convex hull of some points, as `small_hull` does.

        Args:
            first: Number of the first of them.
            end: Number after the last one.
        """
        count = self._sort(first, end)
        if count < 3:
            for i in range(count):
                self.ring[i, 0], self.ring[i, 1] = self.cloud[i, 0], self.cloud[i, 1]
            self.corners = count
            return
        size = 0
        for back in range(2):  # along the lower side, and back along the upper one
            begin = size
            for i in range(count):
                k = count - 1 - i if back else i
                px, py = self.cloud[k, 0], self.cloud[k, 1]
                while size - begin >= 2:
                    ax, ay = self.ring[size - 2, 0], self.ring[size - 2, 1]
                    bx, by = self.ring[size - 1, 0], self.ring[size - 1, 1]
                    if (bx - ax) * (py - ay) - (by - ay) * (px - ax) > _FLAT:
                        break
                    size -= 1
                self.ring[size, 0], self.ring[size, 1] = px, py
                size += 1
            size -= 1
        self.corners = size

    def _sort(self, first, end):
        """Put some points into `cloud`, from the lowest x on, each once; how many these are."""
        count = 0
        for i in range(first, end):
            x, y = self.points[i, 0], self.points[i, 1]
            k = count
            while k > 0 and (self.cloud[k - 1, 0] > x or (self.cloud[k - 1, 0] == x and self.cloud[k - 1, 1] > y)):
                k -= 1
            if k > 0 and self.cloud[k - 1, 0] == x and self.cloud[k - 1, 1] == y:
                continue
            for j in range(count, k, -1):
                self.cloud[j, 0], self.cloud[j, 1] = self.cloud[j - 1, 0], self.cloud[j - 1, 1]
            self.cloud[k, 0], self.cloud[k, 1] = x, y
            count += 1
        return count

    def margin(self, x, y):
        """Signed distance in m of a point to the hull's edge.

        Args:
            x: Point in m.
            y: Point in m.

        Returns:
            The distance, positive inside; -inf for an empty hull.
        """
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
        """Some points as tuples.

        Args:
            first: Number of the first of them.
            end: Number after the last one.

        Returns:
            The points (x, y) in m as a list.
        """
        return [(self.points[i, 0], self.points[i, 1]) for i in range(first, end)]

    def corners_of(self):
        """The hull's corners (x, y) in m as a list of tuples, counter-clockwise from the lowest x."""
        return [(self.ring[i, 0], self.ring[i, 1]) for i in range(self.corners)]
