"""Which joint angles miss their targets."""

import math

import numpy as np

from ..base import memory

__all__ = ["TrackingCheck"]


class TrackingCheck:
    """Compares measured with commanded joint angles.

    Args:
        joints: Number of angles.
        confirmed: Ticks after which a joint that misses its target is off, and ten times as many until it is not.
        most: Error in rad that is allowed.

    Attributes:
        off: 1 for a joint that is off, else 0 (k,).
        count: How many are.
    """

    def __init__(self, joints, confirmed, most):
        self.joints = joints
        self.confirmed = confirmed
        self.most = most
        self.count = 0
        self.off = np.zeros(joints)
        self.before = np.zeros(joints)
        self.over = np.zeros(joints)
        self.calm = np.zeros(joints)

    def update(self, measured, commanded):
        """Compare a tick's angles (k,) in rad; returns how many joints are off.

        Targets that did not move since the last tick are not compared: they may not be what the drives get.
        """
        q = memory.values(measured)
        c = memory.values(commanded)
        before = memory.room(self.before)
        off = memory.room(self.off)
        over = memory.room(self.over)
        calm = memory.room(self.calm)
        moves = False
        for i in range(self.joints):
            if c[i] != before[i]:
                moves = True
            before[i] = c[i]
        if not moves:
            return self.count
        self.count = 0
        for i in range(self.joints):
            error = math.fabs(q[i] - c[i])
            if error <= self.most:
                over[i] = 0.0
                calm[i] += 1.0
            else:  # also where the angle is no number
                over[i] += 1.0
                calm[i] = 0.0
            if over[i] >= self.confirmed:
                off[i] = 1.0
            elif calm[i] >= 10 * self.confirmed:
                off[i] = 0.0
            if off[i] != 0.0:
                self.count += 1
        return self.count
