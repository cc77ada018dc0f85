"""Kernel of what joints did at most: their speeds both ways, and whether one is at its torque limit."""

from __future__ import annotations

import numpy as np

__all__ = ["JointExtremes"]


class JointExtremes:
    """Follows k joints of a simulation.

    Args:
        speeds: Speeds (n,) of all joints in rad/s, where the simulator writes them.
        places: Where each joint's speed stands there (k,).
        torques: Torques (m,) of all servos in N m, likewise.
        servos: Where each joint's torque stands there (k,).
        per_torque: One over each joint's torque limit (k,) in 1/(N m); 0 where there is none.

    Attributes:
        high: Largest speed (k,) in rad/s so far; 0 where none was above 0.
        low: Least speed (k,) likewise.
        shares: Share (k,) of its limit that each joint's torque was at the last `tick`.
    """

    def __init__(self, speeds, places, torques, servos, per_torque):
        self.speeds = speeds
        self.places = places
        self.torques = torques
        self.servos = servos
        self.per_torque = per_torque
        self.high = np.zeros(len(places))
        self.low = np.zeros(len(places))
        self.shares = np.zeros(len(places))

    def extend(self):
        """Take in the speeds as they are now."""
        for i in range(self.places.shape[0]):
            speed = self.speeds[self.places[i]]
            if speed > self.high[i] or speed != speed:
                self.high[i] = speed
            if speed < self.low[i] or speed != speed:
                self.low[i] = speed

    def tick(self):
        """Take in speeds and torques as they are now.

        Returns:
            Whether a torque is at its limit.
        """
        self.extend()
        at_limit = False
        for i in range(self.places.shape[0]):
            share = self.torques[self.servos[i]] * self.per_torque[i]
            self.shares[i] = share
            if share >= 1.0 or share <= -1.0:
                at_limit = True
        return at_limit
