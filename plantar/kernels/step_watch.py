"""Kernel that looks after each physics step whether something happened that is worth a closer look."""

from __future__ import annotations

__all__ = ["FAST", "LEGS", "StepWatch"]

LEGS = 4
"""What `StepWatch.step` adds where the legs touch each other; 1 and 2 stand for a left and a right foot that lands."""

FAST = 8
"""What it adds where a joint may be faster than its limit."""


class StepWatch:
    """Follows two feet, the legs and the joints through the steps of a simulation.

    Args:
        ground: Force (2,) of the ground on the feet in N, where the simulator writes it.
        legs: A number (1,) that is above 0 where the legs touch each other, likewise.
        speeds: Speeds (n,) of joints in rad/s, likewise.
        least: Force in N from which on a foot touches the ground.
        airborne: Steps without the ground after which a touch is a landing.
        slow: Sum of the squares of all speeds up to which no joint is faster than its limit.

    Attributes:
        now: Number of steps so far.
    """

    def __init__(self, ground, legs, speeds, least, airborne, slow):
        self.ground = ground
        self.legs = legs
        self.speeds = speeds
        self.least = least
        self.airborne = airborne
        self.slow = slow
        self.now = 0
        self.left = 0
        self.right = 0

    def step(self):
        """After each physics step.

        Returns:
            What is to be looked at, 0 for nothing: 1 a left foot that lands, 2 a right one, `LEGS`, `FAST`.
        """
        self.now += 1
        seen = 0
        if self.ground[0] >= self.least:
            if self.now - self.left > self.airborne:
                seen += 1
            self.left = self.now
        if self.ground[1] >= self.least:
            if self.now - self.right > self.airborne:
                seen += 2
            self.right = self.now
        if self.legs[0] > 0.0:
            seen += 4
        total = 0.0
        for i in range(self.speeds.shape[0]):
            total += self.speeds[i] * self.speeds[i]
        if not total <= self.slow:
            seen += 8
        return seen
