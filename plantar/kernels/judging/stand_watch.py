"""Kernel of the places of loaded feet, and their slip."""

import math

import numpy as np

__all__ = ["StandWatch"]


class StandWatch:
    """Follows both feet (0 left, 1 right), each from one touch of the ground to the next.

    Args:
        enough: Ground force in N from which a foot carries.

    Attributes:
        slip: Largest distance in m of a sole's origin from where its foot began to carry.
    """

    def __init__(self, enough):
        self.enough = enough
        self.begun = np.zeros(2, dtype=np.intp)
        self.stood = np.zeros(2, dtype=np.uint8)
        self.first = np.zeros((2, 2))
        self.place = np.zeros((2, 3))
        self.slip = 0.0
        self.over = []

    def begin(self, foot, step):
        """End the stand of a `foot` that touches the ground in physics step `step`, above 0."""
        if self.stood[foot] and self.begun[foot] > 0:
            self.over.append(self._row(foot))
        self.stood[foot] = 0
        self.begun[foot] = step

    def _row(self, foot):
        return (self.begun[foot], foot, self.place[foot, 0], self.place[foot, 1], self.place[foot, 2])

    def stands(self):
        """All stands that began with a touch and carried, in the order of their touches.

        Returns:
            Rows of the touch's physics step, foot, and x, y in m and heading in rad of its sole when it last carried.
        """
        rows = list(self.over)
        for foot in range(2):
            if self.stood[foot] and self.begun[foot] > 0:
                rows.append(self._row(foot))
        return sorted(rows)

    def carry(self, foot, force, x, y, yaw):
        """Add the `force` in N on a `foot`, its sole's origin `x`, `y` in m and heading `yaw` in rad."""
        if not force >= self.enough:
            return
        if not self.stood[foot]:
            self.stood[foot] = 1
            self.first[foot, 0], self.first[foot, 1] = x, y
        dx, dy = x - self.first[foot, 0], y - self.first[foot, 1]
        self.slip = max(self.slip, math.sqrt(dx * dx + dy * dy))
        self.place[foot, 0], self.place[foot, 1], self.place[foot, 2] = x, y, yaw
