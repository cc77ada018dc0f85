"""Depth of the ground under a descending sole, relative to the nearest."""

import numpy as np

from ..base import memory, order

__all__ = ["SeenDepth"]

_INFINITE = float("inf")
_NONE = float("nan")


class SeenDepth:
    """Running mean of what a sole of n taxels sees.

    Args:
        count: n.
        least: Least number of taxels that have to see ground.
        highest: Distance in m of the nearest ground from which nothing counts.
        deep: Depth in m for all deeper or out of range.
        share: Of a new reading in the mean.

    Attributes:
        depth: (n,) in m; NaN for taxels that have been dead.
        looks: Number of readings in it.
    """

    def __init__(self, count, least, highest, deep, share):
        self.least = least
        self.highest = highest
        self.deep = deep
        self.share = share
        self.depth = np.zeros(count)
        self.work = np.zeros(count)
        self.looks = 0

    def lift(self):
        """Forget what was seen."""
        self.looks = 0
        for i in range(self.depth.shape[0]):
            self.depth[i] = 0.0

    def shows(self, depth):
        """Whether a taxel has seen ground deeper than a `depth` in m."""
        for i in range(self.depth.shape[0]):  # noqa: SIM110  compiled, a loop is what is quick
            if self.depth[i] > depth:
                return True
        return False

    def look(self, distance):
        """Add a reading of distances (n,) in m; inf out of range, NaN or -inf of a dead taxel."""
        given = memory.values(distance)
        seen = 0
        for i in range(self.depth.shape[0]):
            if abs(given[i]) < _INFINITE:
                self.work[seen] = given[i]
                seen += 1
        # From a few distances the height of the nearest ground is no more than noise.
        if seen < self.least:
            return
        # Relative to the nearest ground: the foot is on its way down.
        ground = order.mean_of_least(self.work, seen, max(self.least, seen // 3))
        if ground > self.highest:
            return
        self.looks += 1
        # Where nothing was known the first sight counts whole.
        share = self.share if self.looks > 1 else 1.0
        for i in range(self.depth.shape[0]):
            depth = min(max(given[i] - ground, -self.deep), self.deep)
            sound = given[i] > -_INFINITE
            self.depth[i] = self.depth[i] + share * (depth - self.depth[i]) if sound else _NONE
