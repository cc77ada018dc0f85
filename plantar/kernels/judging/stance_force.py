"""Kernel of the steadiness of the ground's force in single support."""

import math

import numpy as np

__all__ = ["StanceForce"]


class StanceForce:
    """Compares the ground's vertical force with the CoM's acceleration, and the ZMP with the edge of the support.

    By Newton's law both agree at each instant, so the acceleration is averaged: the second difference of the CoM's
    height over `span` steps each way. The remaining force is faster: a contact that flickers.

    Args:
        reaction: `GroundReaction` of both feet.
        center: CoM (3,) in m, updated by the simulator.
        mass: The robot's mass in kg.
        gravity: In m/s^2.
        period: Physics step in s.
        steps: Numbers of steps: `span`, and those left out after a landing.
        least: Vertical force in N from which a foot touches the ground.
        edge: Distance in m below which a ZMP is at the edge of the support.

    Attributes:
        compared: Steps in which force and acceleration were compared.
        squares: Sum of their squared differences in N^2.
        single: Steps in single support.
        at_edge: Those with the ZMP at the edge.
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
        left, right = self.reaction.loads[0], self.reaction.loads[1]
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
        first, middle = self.now % self.size, (self.now + self.span) % self.size
        bend = self.heights[place] - 2.0 * self.heights[middle] + self.heights[first]
        off = self.forces[middle] - self.mass * (self.gravity + bend * self.scale)
        self.compared += 1
        self.squares += off * off

    def rms(self):
        """Root mean square difference in N; NaN without a comparison."""
        return math.sqrt(self.squares / self.compared) if self.compared else math.nan
