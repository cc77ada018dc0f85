# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that keeps pieces of an outline: what of it lies in boxes.

Plain Python that also compiles ahead of time (`windows.pxd` gives the C types). `outline_search` searches with it.
"""

from __future__ import annotations

import math

from ..base import work_arrays
from . import turn_bound

__all__ = ["Windows"]


class Windows:
    """Pieces of an outline, each cut out once and kept.

    A ring that leaves its box and comes back runs to and fro along the box's side: where it does its edges cancel.

    Attributes:
        count: Number of pieces.
        spent: Units of work so far.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.spent = 0
        self.count = 0
        self.used = 0
        self.rings = 0
        self.points = work_arrays.numbers(2048, self.lists)
        self.start = work_arrays.places(256, self.lists)
        self.first = work_arrays.places(66, self.lists)
        self.reach2 = work_arrays.numbers(64, self.lists)
        self.ring = work_arrays.numbers(256, self.lists)
        self.cut = work_arrays.numbers(256, self.lists)

    def clear(self):
        """Forget all pieces."""
        self.count = 0
        self.used = 0
        self.rings = 0
        self.first[0] = 0
        self.start[0] = 0

    def add(self, points, start, rings, angle, box, at):
        """Keep what of an outline lies in a box.

        Args:
            points: Vertices of the outline, flat.
            start: Offsets (rings + 1) of its rings; rings their number.
            angle: Angle in rad at which the box is seen.
            box: Numbers among which x from and to, y from and to of the box stand; at where they do.

        Returns:
            Which piece it is.
        """
        cosine = math.cos(angle)
        sine = math.sin(angle)
        self._open()
        for r in range(rings):
            n = start[r + 1] - start[r]
            self._make_buffers(n)
            self.spent += n
            ring = self.ring
            for i in range(2 * n):
                ring[i] = points[2 * start[r] + i]
            for side in range(4):
                sign = -1.0 if side % 2 else 1.0
                nx = sign * (cosine if side < 2 else -sine)
                ny = sign * (sine if side < 2 else cosine)
                self._make_buffers(n)
                n = turn_bound.cut_ring(self.ring, n, nx, ny, sign * box[at + side], self.cut)
                if n < 3:
                    break
                ring = self.ring
                self.ring = self.cut
                self.cut = ring
            if n > 2:
                self._keep(self.ring, 0, n)
        return self._close()

    def add_whole(self, points, start, rings):
        """Keep all of an outline; which piece it is."""
        self._open()
        for r in range(rings):
            self._keep(points, start[r], start[r + 1] - start[r])
        return self._close()

    def _make_buffers(self, n):
        """Room for a ring of n vertices and for what a cut leaves of it."""
        if 4 * n + 8 > len(self.cut):
            self.cut = work_arrays.numbers(8 * n + 16, self.lists)
        if 4 * n + 8 > len(self.ring):
            before = self.ring
            self.ring = work_arrays.numbers(8 * n + 16, self.lists)
            for i in range(len(before)):
                self.ring[i] = before[i]

    def _open(self):
        """Begin a piece."""
        if self.count + 2 > len(self.reach2):
            self.first = _longer_places(self.first, self.lists)
            self.reach2 = _longer(self.reach2, self.lists)

    def _close(self):
        """End a piece, and measure the square of the diagonal of the box around it; which piece it is."""
        piece = self.count
        low_x = math.inf
        high_x = -math.inf
        low_y = math.inf
        high_y = -math.inf
        for i in range(self.start[self.first[piece]], self.used):
            low_x = min(low_x, self.points[2 * i])
            high_x = max(high_x, self.points[2 * i])
            low_y = min(low_y, self.points[2 * i + 1])
            high_y = max(high_y, self.points[2 * i + 1])
        self.reach2[piece] = 0.0
        if high_x > low_x:
            self.reach2[piece] = (high_x - low_x) * (high_x - low_x) + (high_y - low_y) * (high_y - low_y)
        self.count += 1
        self.first[self.count] = self.rings
        return piece

    def _keep(self, ring, begin, n):
        """Keep a ring of n vertices that begins at some place."""
        while 2 * (self.used + n) > len(self.points):
            self.points = _longer(self.points, self.lists)
        if self.rings + 2 > len(self.start):
            self.start = _longer_places(self.start, self.lists)
        for i in range(2 * n):
            self.points[2 * self.used + i] = ring[2 * begin + i]
        self.used += n
        self.rings += 1
        self.start[self.rings] = self.used


def _longer(before, lists):
    """The same numbers with as much room again."""
    after = work_arrays.numbers(2 * len(before), lists)
    for i in range(len(before)):
        after[i] = before[i]
    return after


def _longer_places(before, lists):
    """The same indices with as much room again."""
    after = work_arrays.places(2 * len(before), lists)
    for i in range(len(before)):
        after[i] = before[i]
    return after
