"""The body's targets: CoM height, torso heading and lean."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.plan.phases import Phase
from plantar.gait.tick.footing import Footing
from plantar.kernels.base.vectors import vector
from plantar.kernels.gait.com_height import CoMHeight
from plantar.kernels.gait.leaning_torso import leaning_torso
from plantar.mechanics.base_state import BaseState

_ROUND = 0.2  # chosen: of the way aside over which the lean ends
# measured: beats in which the torso comes to lean as far as a leg needs that carries for longer than a step; with 2 a
# hip that is at its limit then stays there
_LEANS = 1.0
# derived: of the way from the standing foot to a lower one, where a double support holds the body: as far to either
_MIDWAY = 0.5
# chosen: rad/beat, natural frequency of the CoM's height over ground that goes up and down; 8 rad/s on h1, twice the
# pendulum's
_FOLLOWS_GROUND = 1.98


class BodyTargets:
    """CoM and torso targets over the commanded feet, their frame."""

    def __init__(self, settings: ControllerSettings, footing: Footing) -> None:
        self._settings = settings
        self._footing = footing
        ground = float(np.mean([footing.motion.footholds[side][0].item(2) for side in SIDES]))
        legs = settings.standing_legs
        self._legs = legs if len(legs) == len(SIDES) else {}
        self._hips = {side: np.array(leg.hip) for side, leg in self._legs.items()}
        self._leans = 0.0
        self._period = settings.period
        self._ground = CoMHeight(ground, settings.period, _FOLLOWS_GROUND / settings.body.beat)

    def at(
        self, phase: Phase, com: NDArray[np.float64], lean: float, state: BaseState
    ) -> tuple[NDArray[np.float64], float, NDArray[np.float64]]:
        """Returns CoM (3,) in m, heading in rad and torso rotation (3, 3).

        `com` (2,), world frame, in m; `lean`: what its hips need in rad/m.
        """
        left = self._footing.motion.footholds["left"][1]
        right = self._footing.motion.footholds["right"][1]
        x, y = self._footing.frame.to_command(com).tolist()
        target = vector(x, y, self._com_height(phase, state))
        torso = left + 0.5 * math.remainder(right - left, 2.0 * math.pi)
        guard = self._footing.guard
        holds = guard is not None and guard.holds
        if holds or self._leans > 0.0:
            lean = self._lean(lean, holds)
        return target, torso, self.posture(target, torso, lean)

    def _lean(self, lean: float, holds: bool) -> float:
        """Lean in rad/m: the larger of what the hips need and the walk's own, both while a leg is held."""
        own = self._settings.trunk_lean
        change = self._period / (_LEANS * self._settings.body.beat)
        if not holds:
            change = -change
        self._leans = min(1.0, max(0.0, self._leans + change))
        # nature: the cubic without speed at both ends, 3 s^2 - 2 s^3
        share = self._leans * self._leans * (3.0 - 2.0 * self._leans)
        return max(own, lean) + share * min(own, lean)

    def posture(self, com: NDArray[np.float64], torso: float, lean: float = 0.0) -> NDArray[np.float64]:
        """Returns the torso's rotation (3, 3): along the feet, leaning over the foot that `com` (3,) in m nears.

        The lean brings carrying hip and CoM together, relieving the hip roll.
        """
        settings = self._settings
        footholds = self._footing.motion.footholds
        lean = max(settings.trunk_lean, lean)
        left = footholds["left"][0]
        right = footholds["right"][0]
        turn: NDArray[np.float64] = leaning_torso(com, left, right, torso, settings.lean_reach, lean, _ROUND)
        return turn

    def _com_height(self, phase: Phase, state: BaseState) -> float:
        """Height in m over the stance foot, blended in double support, higher over partial footholds."""
        footing = self._footing
        motion = footing.motion
        stance = phase.stance
        if stance is None:
            target = 0.5 * (motion.footholds["left"][0].item(2) + motion.footholds["right"][0].item(2))
            target += footing.contacts.rise
        else:
            stands = motion.footholds[stance][0].item(2)
            # A leg that steps down has to reach the ground: the body comes down before its foot, to where both will
            # have it. Lower, the standing knee carries it bent for nothing.
            down = _MIDWAY * max(0.0, stands - motion.comes_to)
            target = stands - min(down, self._settings.spare_crouch)
            target += footing.contacts.rise
            if self._legs and motion.comes_down:
                target = self._within_reach(target, stands, stance, state)
        ground: float = self._ground.update(target)
        return ground + self._settings.com_height

    def _within_reach(self, target: float, stands: float, stance: Side, state: BaseState) -> float:
        """A `target` in m, lower where the swing's end is out of its leg's reach: a leg that hangs straight is a strut
        that the body falls onto. No lower than the standing knee bears.

        `stands`: height in m of the `stance` foot.
        """
        footing = self._footing
        motion = footing.motion
        swing = other_side(stance)
        leg = self._legs[swing]
        hip = state.position_base + state.rotation_base_to_world.dot(self._hips[swing])
        x, y = footing.frame.to_command(hip[:2]).tolist()
        end_x, end_y, yaw = motion.end
        away = math.hypot(end_x + leg.ankle * math.cos(yaw) - x, end_y + leg.ankle * math.sin(yaw) - y)
        # The hip stays as far below the CoM as it is.
        above = state.com.item(2) - hip.item(2) - self._settings.com_height
        reaches: float = motion.comes_to + leg.tallest(away) + above
        if reaches >= target:
            return target
        contacts = footing.contacts
        bears = stands + self._legs[stance].lowest_for(contacts.center(stance).item(0), 1.0 / contacts.mass_ratio)
        return min(target, max(reaches, bears))
