# cython: infer_types=True
"""Contact's outline: a walk along edges that no two active cells share."""

import math

import numpy as np

from ..base import memory, vectors

__all__ = ["EdgeTable", "Rings", "area_and_centroid", "ring_areas"]


def area_and_centroid(points, starts):
    """Area in m^2, less holes, and centroid x, y in m of vertices (k, 2) with ring offsets (r + 1); the first vertex
    without area.
    """
    x0 = points[0, 0]
    y0 = points[0, 1]
    twice = 0.0
    sx = 0.0
    sy = 0.0
    for r in range(len(starts) - 1):
        last = starts[r + 1]
        ax = points[last - 1, 0] - x0
        ay = points[last - 1, 1] - y0
        for i in range(starts[r], last):
            bx = points[i, 0] - x0
            by = points[i, 1] - y0
            cross = ax * by - bx * ay
            twice += cross
            sx += (ax + bx) * cross
            sy += (ay + by) * cross
            ax = bx
            ay = by
    if twice == 0.0:
        return 0.0, x0, y0
    # nature: the centroid of a triangle is a third of its corners
    return 0.5 * twice, x0 + sx / (3.0 * twice), y0 + sy / (3.0 * twice)


def ring_areas(points, starts):
    """Signed areas (r) in m^2 of rings of vertices (k, 2) with offsets (r + 1), a list; 0 below 3 vertices."""
    areas = []
    for r in range(len(starts) - 1):
        first = starts[r]
        last = starts[r + 1]
        twice = 0.0
        ax = 0.0
        ay = 0.0
        for i in range(first + 1, last):
            bx = points[i, 0] - points[first, 0]
            by = points[i, 1] - points[first, 1]
            twice += ax * by - bx * ay
            ax = bx
            ay = by
        areas.append(0.5 * float(twice))
    return areas


class Rings:
    """Rings around an area, base of `plantar.geometry.outline.Outline`.

    `points`: vertices (k, 2) of all rings in m, one ring after another; `starts`: offsets (r + 1) of rings;
    `ring_areas`: signed area (r) of each ring in m^2.
    """

    def __init__(self, points, starts, ring_areas):
        self.points = points
        self.starts = starts
        self.ring_areas = ring_areas

    @property
    def area(self):
        """Area in m^2, less holes; exact to 1e-12."""
        areas = self.ring_areas
        return areas[0] if len(areas) == 1 else math.fsum(areas)


class EdgeTable:
    """Directed edges of a sole's cells, each counter-clockwise, in turn.

    `edges`: offsets (n + 1,) of each cell's edges and, for each edge (h,), its cell, neighbour's same edge or -1, next
    edge, first vertex; `vertices`: coordinates of the v vertices, flat (2 v,), in m; `straight`: distance in m of
    corner from its neighbours' line; `reuse`: keep work arrays from walk to walk; compiled walks cannot interleave.
    """

    def __init__(self, edges, vertices, straight, reuse):
        self.cell_start, self.cell, self.twin, self.after, self.origin = edges
        self.vertices = vertices
        self.straight = straight
        self.reuse = reuse
        self.mark = bytearray(len(self.cell))
        self.path = np.empty(len(self.cell), dtype=np.intp)
        self.place = np.full(len(vertices) // 2, -1, dtype=np.intp)
        self.leaving = bytearray(len(vertices) // 2)
        self.points = np.empty((len(self.cell), 2))

    def __reduce__(self):
        """Rebuild from the arguments, in another process."""
        tables = [self.cell_start, self.cell, self.twin, self.after, self.origin]
        edges = tuple([np.array(t) for t in tables])
        return type(self), (edges, np.array(self.vertices), self.straight, self.reuse)

    def rings(self, active, kind):
        """Rings around the active cells, the contact on their left, as an object; None where there are not n bytes.

        `kind`: `Rings` or a derived class; its `__init__` is not called.
        """
        if len(active) != len(self.cell_start) - 1:
            return None
        found = Rings.__new__(kind)
        starts = [0]
        areas = []
        found.points = self._trace(active, starts, areas)
        memory.close(found.points)
        found.starts = tuple(starts)
        found.ring_areas = tuple(areas)
        return found

    def _trace(self, active, starts, areas):
        """Walk; returns the points, and appends rings' offsets and areas."""
        n = len(self.cell_start) - 1
        # Of each edge: 0 not on the outline, 1 on it, 2 walked. Of each vertex: how many edges of the outline leave it.
        mark = self.mark
        leaving = self.leaving
        path = self.path
        place = self.place
        if not self.reuse:
            mark = bytearray(len(self.mark))
            leaving = bytearray(len(self.leaving))
            path = np.empty(len(self.path), dtype=np.intp)
            place = np.full(len(self.leaving), -1, dtype=np.intp)
        count = 0
        pinched = False
        for i in range(n):
            if active[i]:
                for h in range(self.cell_start[i], self.cell_start[i + 1]):
                    t = self.twin[h]
                    if t < 0 or not active[self.cell[t]]:
                        mark[h] = 1
                        count += 1
                        v = self.origin[h]
                        leaving[v] += 1
                        if leaving[v] > 1:
                            pinched = True
        if count == 0:
            return np.empty((0, 2))
        points = self.points
        if not self.reuse:
            room = np.empty((count, 2))
            points = room
        used = 0
        for i in range(n):
            if not active[i]:
                continue
            for first in range(self.cell_start[i], self.cell_start[i + 1]):
                if mark[first] != 1:
                    continue
                size = 0
                h = first
                while mark[h] == 1:
                    mark[h] = 2
                    v = self.origin[h]
                    if pinched:
                        low = place[v]
                        if low >= 0:  # back at a vertex of this ring: what lies between is another ring
                            used = self._keep(path, low, size, points, used, starts, areas)
                            for k in range(low, size):
                                place[path[k]] = -1
                            size = low
                        place[v] = size
                    path[size] = v
                    size += 1
                    h = self.after[h]
                    while mark[h] == 0:
                        h = self.after[self.twin[h]]
                used = self._keep(path, 0, size, points, used, starts, areas)
                if pinched:
                    for k in range(size):
                        place[path[k]] = -1
        for i in range(n):  # work arrays as they were: nothing marked
            if active[i]:
                for h in range(self.cell_start[i], self.cell_start[i + 1]):
                    mark[h] = 0
                    leaving[self.origin[h]] = 0
        if not self.reuse:
            return room[:used]
        return vectors.points_of(points, used)

    def _keep(self, path, low, high, points, used, starts, areas):
        """Write the ring path[low:high] to the points, less straight vertices; points used."""
        base = used
        b = path[high - 1]
        bx = self.vertices[2 * b]
        by = self.vertices[2 * b + 1]
        a = path[high - 2]
        ax = self.vertices[2 * a]
        ay = self.vertices[2 * a + 1]
        twice = 0.0
        ox = bx
        oy = by
        for k in range(low, high):
            c = path[k]
            cx = self.vertices[2 * c]
            cy = self.vertices[2 * c + 1]
            ux = bx - ax
            uy = by - ay
            wx = cx - bx
            wy = cy - by
            turn = ux * wy - uy * wx
            if abs(turn) > self.straight * (abs(ux) + abs(uy) + abs(wx) + abs(wy)):
                points[used, 0] = bx
                points[used, 1] = by
                used += 1
                ax = bx
                ay = by
            twice += (bx - ox) * (cy - oy) - (cx - ox) * (by - oy)
            bx = cx
            by = cy
        if used - base < 3 or twice == 0.0:
            return base
        starts.append(used)
        areas.append(0.5 * float(twice))
        return used
