# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that keeps intervals of angles, the one of the largest bound first.

Plain Python that also compiles ahead of time (`node_heap.pxd` gives the C types). `outline_search` searches with it.
"""

from __future__ import annotations

from ..base import work_arrays

__all__ = ["NodeHeap"]


class NodeHeap:
    """Binary heap of intervals of angles, each of a place and with a bound; the largest bound is taken first.

    Attributes:
        size: Number of intervals that are kept.
        bound: Bound of the interval taken last; `low` and `high` its ends, `place` where it belongs.

    Args:
        lists: Keep lists instead of arrays, which the interpreted form reads faster.
    """

    def __init__(self, lists):
        self.lists = lists
        self.size = 0
        self.made = 0
        self.room = 0
        self.bound = 0.0
        self.low = 0.0
        self.high = 0.0
        self.place = 0
        self._make_room(256)

    def _make_room(self, room):
        """Room for so many intervals, those that are kept among them."""
        nodes = work_arrays.numbers(3 * room, self.lists)
        places = work_arrays.places(2 * room, self.lists)
        for i in range(3 * self.size):
            nodes[i] = self.nodes[i]
        for i in range(2 * self.size):
            places[i] = self.places[i]
        self.nodes = nodes
        self.places = places
        self.room = room

    def clear(self):
        """Forget all."""
        self.size = 0
        self.made = 0

    def _is_before(self, bound, number, at):
        """Whether an interval comes before the one at a place of the heap; of equal ones the one that came first."""
        other = self.nodes[3 * at]
        return bound > other or (bound == other and number < self.places[2 * at + 1])

    def _put(self, at, bound, low, high, place, number):
        """Write an interval at a place of the heap."""
        self.nodes[3 * at] = bound
        self.nodes[3 * at + 1] = low
        self.nodes[3 * at + 2] = high
        self.places[2 * at] = place
        self.places[2 * at + 1] = number

    def _move(self, source, at):
        """Copy an interval to another place of the heap."""
        self._put(
            at,
            self.nodes[3 * source],
            self.nodes[3 * source + 1],
            self.nodes[3 * source + 2],
            self.places[2 * source],
            self.places[2 * source + 1],
        )

    def push(self, bound, low, high, place):
        """Keep an interval.

        Args:
            bound: Area in m^2 above which nothing stands there.
            low: Its least angle in rad; high its largest one.
            place: Where it belongs.
        """
        if self.size == self.room:
            self._make_room(2 * self.room)
        at = self.size
        self.size += 1
        number = self.made
        self.made += 1
        while at > 0:
            above = (at - 1) // 2
            if not self._is_before(bound, number, above):
                break
            self._move(above, at)
            at = above
        self._put(at, bound, low, high, place, number)

    def pop(self):
        """Take the interval of the largest bound, one there must be."""
        self.bound = self.nodes[0]
        self.low = self.nodes[1]
        self.high = self.nodes[2]
        self.place = self.places[0]
        self.size -= 1
        last = self.size
        bound = self.nodes[3 * last]
        number = self.places[2 * last + 1]
        at = 0
        while 2 * at + 1 < last:
            below = 2 * at + 1
            if below + 1 < last and self._is_before(self.nodes[3 * below + 3], self.places[2 * below + 3], below):
                below += 1
            if self._is_before(bound, number, below):
                break
            self._move(below, at)
            at = below
        if at != last:
            self._move(last, at)
