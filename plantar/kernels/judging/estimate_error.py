"""Errors of a controller's estimates."""

import numpy as np

__all__ = ["EstimateError"]


class EstimateError:
    """Follows errors of estimated CoM and ZMP, tick by tick.

    `center`: True CoM (3,) in m, updated by simulator; `reaction`: `GroundReaction` of both feet, with true ZMP.
    Attributes `com`: largest error (3,) in m of CoM; NaN if an estimate was; `squares`: sum of squared errors in m^2 of
    ZMP over `compared` ticks.
    """

    def __init__(self, center, reaction):
        self.center = center
        self.reaction = reaction
        self.com = np.zeros(3)
        self.squares = 0.0
        self.compared = 0

    def update(self, com, zmp):
        """Compare the estimates `com` (3,) and `zmp` (2,) in m, lists or None, with the truth."""
        for axis in range(3):
            estimated = com[axis]
            off = abs(estimated - self.center[axis])
            if not off <= self.com[axis]:
                self.com[axis] = off
        if zmp is not None and self.reaction.found:
            x, y = zmp
            dx = x - self.reaction.x
            dy = y - self.reaction.y
            self.squares += dx * dx + dy * dy
            self.compared += 1
