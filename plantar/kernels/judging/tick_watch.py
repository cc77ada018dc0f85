"""Kernel of what a judge finds at each control tick, from where the simulator writes its state."""

from __future__ import annotations

import math

import numpy as np

__all__ = ["TickWatch"]

_INFINITE = float("inf")
_MARGIN = 1e-9  # of the cosine of a tilt: nearer than this to a fall, who asks looks again


class TickWatch:
    """Follows a walk tick by tick.

    Args:
        reaction: `GroundReaction` of both feet.
        stands: `StandWatch` of both feet.
        upright: Rotation (9,) of the torso, row by row, where the simulator writes it.
        center: CoM (3,) in m, likewise.
        places: Origins of the left and the right sole (3,) each in m, likewise.
        turns: Rotations of both soles (9,) each, likewise.
        ground: Force (2,) of the ground on the feet in N, likewise.
        tilted: Cosine of the tilt from which on the robot has fallen.
        lowest: Height in m of the CoM above the lower sole below which it has.

    Attributes:
        up: Least cosine of the torso's tilt so far.
        margin: Least margin of the ZMP in m so far; inf where there was none.
        margin_since: The same since who judges last set it to inf.
        errors: Largest error (3,) in m of the CoM that was told.
        squares: Sum of the squared errors in m^2 of the ZMP that was told, over those ticks in which there was one.
        compared: Number of these ticks.
        until: Time (2,) in s until which each foot's contact area is looked for.
        area: Largest such area (2,) in m^2.
    """

    def __init__(self, reaction, stands, upright, center, places, turns, ground, tilted, lowest):
        self.reaction = reaction
        self.stands = stands
        self.upright = upright
        self.center = center
        self.left, self.right = places
        self.left_turn, self.right_turn = turns
        self.ground = ground
        self.tilted = tilted + _MARGIN
        self.lowest = lowest
        self.up = 1.0
        self.margin = _INFINITE
        self.margin_since = _INFINITE
        self.errors = np.zeros(3)
        self.squares = 0.0
        self.compared = 0
        self.until = np.full(2, -_INFINITE)
        self.area = np.zeros(2)

    def update(self, feet, now, com, zmp):
        """At each control tick.

        Args:
            feet: `FootContacts` of both feet.
            now: Time in s.
            com: The CoM (3,) in m as it is told, a list.
            zmp: The ZMP (2,) in m as it is told, a list, or None.

        Returns:
            Whether the robot may have fallen: who judges looks again.
        """
        reaction = self.reaction
        reaction.update(feet)
        if reaction.found:
            if reaction.margin < self.margin:
                self.margin = reaction.margin
            if reaction.margin < self.margin_since:
                self.margin_since = reaction.margin
            if zmp is not None:
                x, y = zmp
                self._compare_zmp(x, y)
        x, y, z = com
        self._compare_com(x, y, z)
        for foot in range(2):
            if now <= self.until[foot]:
                area = reaction.area(foot)
                if area > self.area[foot]:
                    self.area[foot] = area
        self._stand()
        return self._may_have_fallen()

    def _compare_zmp(self, x, y):
        """Take in how far the ZMP that was told is off."""
        dx, dy = x - self.reaction.x, y - self.reaction.y
        self.squares += dx * dx + dy * dy
        self.compared += 1

    def _compare_com(self, x, y, z):
        """Take in how far the CoM that was told is off; what is no number is the largest error."""
        self._err(0, abs(x - self.center[0]))
        self._err(1, abs(y - self.center[1]))
        self._err(2, abs(z - self.center[2]))

    def _err(self, axis, off):
        if not off <= self.errors[axis]:
            self.errors[axis] = off

    def _stand(self):
        """Take in where the feet are that carry."""
        enough = self.stands.enough
        if self.ground[0] >= enough:
            yaw = math.atan2(self.left_turn[3], self.left_turn[0])
            self.stands.carry(0, self.ground[0], self.left[0], self.left[1], yaw)
        if self.ground[1] >= enough:
            yaw = math.atan2(self.right_turn[3], self.right_turn[0])
            self.stands.carry(1, self.ground[1], self.right[0], self.right[1], yaw)

    def _may_have_fallen(self):
        """Whether torso or CoM are where they are after a fall, or nearly so."""
        up = self.upright[8]
        if up < self.up:
            self.up = up
        lower = self.right[2] if self.right[2] < self.left[2] else self.left[2]
        return up < self.tilted or self.center[2] - lower < self.lowest
