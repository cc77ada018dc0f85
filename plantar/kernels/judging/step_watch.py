"""Kernel that looks after each physics step whether something happened that is worth a closer look."""

from __future__ import annotations

__all__ = ["AWAKE", "DIVERGED", "FAST", "LEGS", "StepWatch"]

LEGS = 4
"""What `StepWatch.step` adds where the legs touch each other; 1 and 2 stand for a left and a right foot that lands."""

FAST = 8
"""What it adds where a joint is faster than its limit."""

AWAKE = 16
"""What it adds while it is told to stay awake."""

DIVERGED = 32
"""What it adds where the simulator warned that its state diverged."""


class StepWatch:
    """Follows two feet, the legs and the joints through the steps of a simulation.

    Args:
        ground: Force (2,) of the ground on the feet in N, where the simulator writes it.
        legs: A number (1,) that is above 0 where the legs touch each other, likewise.
        speeds: Speeds (n,) of joints in rad/s, likewise.
        places: Where the speed of each joint that has a limit stands there (k,).
        per_speed: One over each limit (k,) in s/rad.
        least: Force in N from which on a foot touches the ground.
        airborne: Steps without the ground after which a touch is a landing.
        warnings: How often the simulator warned of what, where it counts.
        divergence: Which of these warnings say that its state diverged.

    Attributes:
        now: Number of steps so far.
        awake: Whether the next steps are to be looked at in any case.
    """

    def __init__(self, ground, legs, speeds, places, per_speed, least, airborne, warnings, divergence):
        self.ground = ground
        self.legs = legs
        self.speeds = speeds
        self.places = places
        self.per_speed = per_speed
        self.least = least
        self.airborne = airborne
        self.warnings = warnings
        self.divergence = divergence
        self.now = 0
        self.awake = False
        self.left = 0
        self.right = 0

    def step(self):
        """After each physics step.

        Returns:
            What is to be looked at, 0 for nothing: 1 a left foot that lands, 2 a right one, `LEGS`, `FAST`, `AWAKE`,
            `DIVERGED`.
        """
        self.now += 1
        seen = 16 if self.awake else 0
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
        for i in range(self.places.shape[0]):
            if not -1.0 <= self.speeds[self.places[i]] * self.per_speed[i] <= 1.0:
                seen += 8
                break
        for i in range(self.divergence.shape[0]):
            if self.warnings[self.divergence[i]] > 0:
                seen += 32
                break
        return seen
