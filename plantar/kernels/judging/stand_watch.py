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
        stood: Whether each foot (2,) carried since it touched, 0 or 1.
        place: Its sole's origin (x, y) in m and heading in rad (2, 3) when it last did.
        slip: Largest distance (2,) in m of the origin from where it was when it first did.
    """

    def __init__(self, enough):
        self.enough = enough
        self.stood = np.zeros(2, dtype=np.uint8)
        self.first = np.zeros((2, 2))
        self.place = np.zeros((2, 3))
        self.slip = np.zeros(2)

    def begin(self, foot):
        """A foot touches the ground: what was found before is forgotten.

        Args:
            foot: 0 for the left one, 1 for the right one.
        """
        self.stood[foot] = 0
        self.slip[foot] = 0.0

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
        slip = math.sqrt(dx * dx + dy * dy)
        if slip > self.slip[foot]:
            self.slip[foot] = slip
        self.place[foot, 0], self.place[foot, 1], self.place[foot, 2] = x, y, yaw
