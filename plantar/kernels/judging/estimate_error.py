"""Kernel of how far a controller's estimates are from the truth."""

from __future__ import annotations

import numpy as np

__all__ = ["EstimateError"]


class EstimateError:
    """Follows the estimates of CoM and ZMP, control tick by control tick.

    Args:
        center: True CoM (3,) in m, where the simulator writes it.
        reaction: `GroundReaction` of both feet, with the true ZMP.

    Attributes:
        com: Largest error (3,) in m of the CoM; not a number where an estimate was none.
        squares: Sum of the squared errors in m^2 of the ZMP.
        compared: Number of ticks in which there were both a true ZMP and an estimate.
    """

    def __init__(self, center, reaction):
        self.center = center
        self.reaction = reaction
        self.com = np.zeros(3)
        self.squares = 0.0
        self.compared = 0

    def update(self, com, zmp):
        """Compare the estimates with the truth as it is now.

        Args:
            com: Estimated CoM (3,) in m, a list.
            zmp: Estimated ZMP (2,) in m, a list, or None.
        """
        for axis in range(3):
            estimated = com[axis]
            off = abs(estimated - self.center[axis])
            if not off <= self.com[axis]:
                self.com[axis] = off
        if zmp is not None and self.reaction.found:
            x, y = zmp
            dx, dy = x - self.reaction.x, y - self.reaction.y
            self.squares += dx * dx + dy * dy
            self.compared += 1
