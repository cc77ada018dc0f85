"""Follows a walk step by step: landings, margins, forces, stands, limits, falls."""

import math

import numpy as np

__all__ = ["DIVERGED", "FALLING", "LEGS", "OTHERS", "OUTSIDE", "StepWatch"]

LEGS = 4
"""What `StepWatch.step` adds where the legs touch each other; 1 and 2 stand for a left and a right foot that lands."""

FALLING = 8
"""What it adds where torso or CoM are where they are after a fall, or nearly so."""

DIVERGED = 16
"""What it adds where the simulator warned that its state diverged."""

OTHERS = 32
"""What it adds where something touches that is no sole, or both soles touch each other."""

OUTSIDE = 64
"""What it adds where a force acts that is not known."""

_INFINITE = float("inf")
_ROUNDING = 1e-9  # of the cosine of a tilt: nearer than this to a fall, the judge computes the angle


class StepWatch:
    """Follows two feet, trunk, legs and joints, in the simulator's arrays.

    Attributes `up`: least cosine of torso's tilt; `margin`: least margin of ZMP in m; inf without a ZMP.

    Args:
        reaction: `GroundReaction` of both feet; `stands`, `joints`, `stance` and `forces` follow them.
        upright: Rotation (9,) of torso, row by row.
        center: CoM (3,) in m.
        places: Left and right sole origins (3,) in m; `turns` their rotations (9,).
        legs: Number (1,), above 0 where legs touch each other.
        warnings: Simulator's warning counts; `divergence` the indices of diverged state.
        least: Vertical force in N from which a foot touches.
        windows: Steps in the air before a landing, after it for impact, and for contact area.
        fallen: Cosine of torso's tilt, and CoM height in m above lower sole, below which it fell.
    """

    def __init__(
        self,
        reaction,
        stands,
        joints,
        stance,
        forces,
        upright,
        center,
        places,
        turns,
        legs,
        warnings,
        divergence,
        least,
        windows,
        fallen,
    ):
        self.reaction = reaction
        self.stands = stands
        self.joints = joints
        self.stance = stance
        self.forces = forces
        self.upright = upright
        self.center = center
        self.left, self.right = places
        self.left_turn, self.right_turn = turns
        self.legs = legs
        self.warnings = warnings
        self.divergence = divergence
        self.least = least
        self.airborne, self.impact_window, self.area_window = windows
        tilted, self.lowest = fallen
        self.tilted = tilted + _ROUNDING
        self.now = 0
        self.up = 1.0
        self.margin = _INFINITE
        self.margin_since = _INFINITE
        self.touched = np.zeros(2, dtype=np.intp)
        self.landed = np.full(2, -(1 << 40), dtype=np.intp)
        self.impact = np.zeros(2)
        self.area = np.zeros(2)
        self.rows = []
        self.last = [-1, -1]

    def step(self, feet, contacts):
        """Follow a physics step with the `FootContacts` of both feet, of so many `contacts` of all bodies.

        Returns the sum of the judge's events: 1 for a left landing, 2 for a right one, `LEGS`, `FALLING`, `DIVERGED`,
        `OTHERS` and `OUTSIDE`.
        """
        self.now += 1
        self.reaction.update(feet)
        self.joints.step()
        seen = 0
        for foot in range(2):
            if self.reaction.loads[foot] >= self.least:
                if self.now - self.touched[foot] > self.airborne:
                    self._land(foot)
                    seen += 1 + foot
                self.touched[foot] = self.now
        self._follow()
        for touching in feet:
            contacts -= touching.size
        if contacts != 0:
            seen += 32
        if self.forces.unknown():
            seen += 64
        return seen + self._look()

    def _land(self, foot):
        self._keep()
        self.last[foot] = len(self.rows)
        self.rows.append([self.now, foot, 0.0, 0.0, _INFINITE])
        self.landed[foot] = self.now
        self.margin_since = _INFINITE
        self.impact[foot] = 0.0
        self.area[foot] = 0.0
        self.stands.begin(foot, self.now)

    def _keep(self):
        for foot in range(2):
            number = self.last[foot]
            if number >= 0:
                row = self.rows[number]
                row[2] = self.impact[foot]
                row[3] = self.area[foot]
        if self.rows:
            row = self.rows[len(self.rows) - 1]
            row[4] = self.margin_since

    def landings(self):
        """Landings: physics step, foot, largest vertical ground force in N and contact area in m^2 in their windows,
        and least margin in m before the next.
        """
        self._keep()
        return [tuple(row) for row in self.rows]

    def _follow(self):
        reaction = self.reaction
        if reaction.found:
            self.margin = min(self.margin, reaction.margin)
            self.margin_since = min(self.margin_since, reaction.margin)
        for foot in range(2):
            force = reaction.loads[foot]
            age = self.now - self.landed[foot]
            if age <= self.impact_window and force > self.impact[foot]:
                self.impact[foot] = force
            if age <= self.area_window:
                self.area[foot] = max(self.area[foot], reaction.area(foot))
        self._stand(0, self.left, self.left_turn)
        self._stand(1, self.right, self.right_turn)
        self.up = min(self.up, self.upright[8])
        self.stance.step(self.now - max(self.landed[0], self.landed[1]))

    def _look(self):
        seen = 0
        if self.legs[0] > 0.0:
            seen += 4
        lower = min(self.left[2], self.right[2])
        if self.upright[8] < self.tilted or self.center[2] - lower < self.lowest:
            seen += 8
        for i in range(self.divergence.shape[0]):
            if self.warnings[self.divergence[i]] > 0:
                seen += 16
                break
        return seen

    def _stand(self, foot, place, turn):
        force = self.reaction.loads[foot]
        if force >= self.stands.enough:
            self.stands.carry(foot, force, place[0], place[1], math.atan2(turn[3], turn[0]))
