"""Kernel of where feet stand while they carry, and how far they slip."""

from __future__ import annotations

import math

import numpy as np

__all__ = ["StandWatch"]


class StandWatch:
    """Follows both feet, each from one touch of the ground to the next.

    Args:
        enough: Ground force in N from which on a foot carries.

    Attributes:
        slip: Largest distance in m of a sole's origin from where it was when that foot first carried, of all stands.
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
        """A foot touches the ground: its stand before is over.

        Args:
            foot: 0 for the left one, 1 for the right one.
            step: Number of the physics step, above 0.
        """
        if self.stood[foot] and self.begun[foot] > 0:
            self.over.append(self._row(foot))
        self.stood[foot] = 0
        self.begun[foot] = step

    def _row(self, foot):
        """A foot's stand as it is now."""
        return (self.begun[foot], foot, self.place[foot, 0], self.place[foot, 1], self.place[foot, 2])

    def stands(self):
        """All stands that began with a touch and carried, the present ones too, in the order of their touches.

        Returns:
            Of each the physics step of the touch, the foot, and its sole's origin (x, y) in m and heading in rad when
            it last carried.
        """
        rows = list(self.over)
        for foot in range(2):
            if self.stood[foot] and self.begun[foot] > 0:
                rows.append(self._row(foot))
        return sorted(rows)

    def carry(self, foot, force, x, y, yaw):
        """Take in where a foot is, and what it carries.

        Args:
            foot: 0 for the left one, 1 for the right one.
            force: Ground force on it in N.
            x: Its sole's origin in m.
            y: The same.
            yaw: Its heading in rad.
        """
        if not force >= self.enough:
            return
        if not self.stood[foot]:
            self.stood[foot] = 1
            self.first[foot, 0], self.first[foot, 1] = x, y
        dx, dy = x - self.first[foot, 0], y - self.first[foot, 1]
        self.slip = max(self.slip, math.sqrt(dx * dx + dy * dy))
        self.place[foot, 0], self.place[foot, 1], self.place[foot, 2] = x, y, yaw
