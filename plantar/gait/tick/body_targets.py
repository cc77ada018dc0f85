"""The body's targets: CoM height, torso heading and lean."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.com_height import CoMHeight
from plantar.gait.plan.phases import Phase
from plantar.gait.tick.footing import Footing
from plantar.kernels.base.vectors import vector
from plantar.kernels.gait.leaning_torso import leaning_torso

_ROUND = 0.2  # of the way aside over which the lean ends
_FOLLOWS_GROUND = 1.98  # rad/beat, natural frequency of the CoM's height over ground that goes up and down


class BodyTargets:
    """CoM and torso targets over the commanded feet, their frame."""

    def __init__(self, settings: ControllerSettings, footing: Footing) -> None:
        self._settings = settings
        self._footing = footing
        ground = float(np.mean([footing.motion.footholds[side][0].item(2) for side in SIDES]))
        self._ground = CoMHeight(ground, settings.period, _FOLLOWS_GROUND / settings.body.beat)

    def at(
        self, phase: Phase, com: NDArray[np.float64], lean: float
    ) -> tuple[NDArray[np.float64], float, NDArray[np.float64]]:
        """Returns CoM (3,) in m, heading in rad and torso rotation (3, 3).

        `com` (2,), world frame, in m; `lean`: least needed in rad/m.
        """
        left = self._footing.motion.footholds["left"][1]
        right = self._footing.motion.footholds["right"][1]
        x, y = self._footing.frame.to_command(com).tolist()
        target = vector(x, y, self._com_height(phase))
        torso = left + 0.5 * math.remainder(right - left, 2.0 * math.pi)
        return target, torso, self.posture(target, torso, lean)

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

    def _com_height(self, phase: Phase) -> float:
        """Height in m over the stance foot, blended in double support, higher over partial footholds."""
        footing = self._footing
        motion = footing.motion
        stance = phase.stance
        if stance is None:
            target = 0.5 * (motion.footholds["left"][0].item(2) + motion.footholds["right"][0].item(2))
        else:
            target = motion.footholds[stance][0].item(2)
            # A leg that steps down has to reach the ground: the body comes down before its foot.
            target -= min(max(0.0, target - motion.comes_to), self._settings.spare_crouch)
        return self._ground.update(target + footing.contacts.rise) + self._settings.com_height
