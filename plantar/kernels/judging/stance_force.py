"""Steadiness of the ground's force in single support."""

import math

import numpy as np

__all__ = ["StanceForce", "StandWatch"]


class StanceForce:
    """Compares the ground's vertical force with the CoM's acceleration, and the ZMP with the support's edge.

    By Newton's law both agree, so the acceleration is averaged: the second difference of the CoM's height over `span`
    steps each way. What remains is a contact that flickers.

    Attributes `squares`: sum of their squared differences in N^2.

    Args:
        center: CoM (3,) in m, updated by simulator.
        mass: Robot's mass in kg.
        gravity: In m/s^2.
        period: Physics step in s.
        steps: `span`, and steps left out after a landing.
        least: Vertical force in N from which a foot touches.
        edge: Distance in m of ZMP at support's edge.
    """

    def __init__(self, reaction, center, mass, gravity, period, steps, least, edge):
        self.reaction = reaction
        self.center = center
        self.mass = mass
        self.gravity = gravity
        self.span, self.settling = steps
        self.scale = 1.0 / (self.span * period) ** 2
        self.least = least
        self.edge = edge
        self.size = 2 * self.span + 1
        self.heights = np.zeros(self.size)
        self.forces = np.zeros(self.size)
        self.now = 0
        self.lasting = 0
        self.compared = 0
        self.squares = 0.0
        self.single = 0
        self.at_edge = 0

    def step(self, since):
        """Add a physics step, `since` steps after the last landing."""
        left = self.reaction.loads[0]
        right = self.reaction.loads[1]
        place = self.now % self.size
        self.heights[place] = self.center[2]
        self.forces[place] = left + right
        self.now += 1
        if (left >= self.least) == (right >= self.least):
            self.lasting = 0
            return
        self.single += 1
        if self.reaction.margin < self.edge:
            self.at_edge += 1
        if since < self.settling:
            self.lasting = 0
            return
        self.lasting += 1
        if self.lasting < self.size:
            return
        first = self.now % self.size
        middle = (self.now + self.span) % self.size
        bend = self.heights[place] - 2.0 * self.heights[middle] + self.heights[first]
        off = self.forces[middle] - self.mass * (self.gravity + bend * self.scale)
        self.compared += 1
        self.squares += off * off

    def rms(self):
        """RMS difference in N; NaN without a comparison."""
        return math.sqrt(self.squares / self.compared) if self.compared else float("nan")


class StandWatch:
    """Follows both feet (0 left, 1 right), touch by touch.

    `enough`: ground force in N from which a foot carries. Attributes `slip`: largest distance in m of sole's origin
    from where its foot began to carry.
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
        """End the stand of a `foot` that touches in physics step `step`, above 0."""
        if self.stood[foot] and self.begun[foot] > 0:
            self.over.append(self._row(foot))
        self.stood[foot] = 0
        self.begun[foot] = step

    def _row(self, foot):
        return (self.begun[foot], foot, self.place[foot, 0], self.place[foot, 1], self.place[foot, 2])

    def stands(self):
        """All stands that began with a touch and carried, in that order.

        Returns rows: touch's physics step, foot, its sole's last x, y in m and heading in rad when carrying.
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
            self.first[foot, 0] = x
            self.first[foot, 1] = y
        dx = x - self.first[foot, 0]
        dy = y - self.first[foot, 1]
        self.slip = max(self.slip, math.sqrt(dx * dx + dy * dy))
        self.place[foot, 0] = x
        self.place[foot, 1] = y
        self.place[foot, 2] = yaw
