"""Keeps the swing foot at its wanted place in the world while the body leans and sags on its stance leg.

X_command = c_command + R_command R_estimated^T (X_world - c_estimated),    c: CoM
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.gait.lean_correction import correct
from plantar.settings.body_scale import REFERENCE_BODY, BodyScale

__all__ = ["PostureCompensation"]

_TIME_CONSTANT = 0.121  # beat: 0.03 s on a leg of 0.6 m
_LARGEST_SHIFT = 0.1  # leg


@dataclass
class PostureCompensation:
    """Filtered correction of one foot's commanded pose.

    Attributes:
        period: Control period in s.
        time_constant: Of the low-pass on the correction in s.
        fade: Time in s in which the correction comes in and goes out.
        largest_shift: Largest correction of the position in m.
        largest_turn: Largest correction of the orientation in rad.
    """

    period: float
    time_constant: float = _TIME_CONSTANT * REFERENCE_BODY.beat
    fade: float = 0.2
    largest_shift: float = _LARGEST_SHIFT * REFERENCE_BODY.leg
    largest_turn: float = 0.12
    shift: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    turn: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    _weight: float = 0.0
    _kept: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))

    @classmethod
    def for_body(cls, body: BodyScale, period: float, fade: float) -> PostureCompensation:
        """No correction yet, limited to a share of a robot's leg.

        Args:
            body: Dimensions of the robot.
            period: Control period in s.
            fade: Time in s in which the correction fades in and out.

        Returns:
            The compensation.
        """
        return cls(period, _TIME_CONSTANT * body.beat, fade, _LARGEST_SHIFT * body.leg)

    def start(self) -> None:
        """Begin with no correction: the foot lifts off."""
        self.shift, self.turn, self._weight, self._kept = np.zeros(3), np.zeros(3), 0.0, np.zeros(3)

    def keep(self, shift: NDArray[np.float64]) -> None:
        """Add what a foot that landed off its place was commanded farther, so that its target does not jump; it fades
        out.

        Args:
            shift: Old less new commanded place (3,) in m, command frame.
        """
        self._kept = shift
        self.shift = self.shift + shift

    def update(
        self,
        swings: bool,
        position: NDArray[np.float64],
        position_in_world: NDArray[np.float64],
        com_command: NDArray[np.float64],
        com_estimated: NDArray[np.float64],
        rotation_command: NDArray[np.float64],
        rotation_estimated: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Corrections of the sole's position (3,) in m and orientation (rotation vector (3,) in rad), command frame.

        Args:
            swings: Whether it is still the foot's single support.
            position: Wanted sole position (3,) in the command frame in m.
            position_in_world: The same point in the world frame in m.
            com_command: CoM reference (3,) in the command frame in m.
            com_estimated: Estimated CoM (3,) in the world frame in m.
            rotation_command: Commanded torso orientation (3, 3).
            rotation_estimated: Estimated torso orientation (3, 3), heading as commanded.

        Returns:
            The corrections at this tick.
        """
        step = self.period / self.fade
        # Fades: at lift-off and touchdown the foot is on the ground, and a jump of its target would push it.
        self._weight = min(1.0, self._weight + step) if swings else max(0.0, self._weight - step)
        correct(
            *(position, position_in_world, com_command, com_estimated, rotation_command, rotation_estimated),
            *(self._kept, self.largest_shift, self.largest_turn, self._weight),
            *(min(1.0, self.period / self.time_constant), self.shift, self.turn),
        )
        return self.shift.copy(), self.turn.copy()
