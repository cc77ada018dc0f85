"""Keeps the swing foot's place in the world while the body leans and sags.

X_command = c_command + R_command R_estimated^T (X_world - c_estimated),    c: CoM
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.kernels.gait.lean_correction import correct

_TIME_CONSTANT = 0.121  # chosen: beat: 0.03 s on a leg of 0.6 m; six ticks
_LARGEST_SHIFT = 0.1  # leg; chosen: 60 mm on h1, the shift of a foot by a lean of 4 degrees
# chosen: share of its coming, at the end, in which it slows down: an even rate that stops would jerk the foot
_ROUNDED = 0.4


@dataclass
class PostureCompensation:
    """Filtered correction of a foot's commanded pose.

    Attributes:
        period: Of control in s.
        time_constant: Correction's low-pass in s.
        fade: Time in s of its coming and going.
        largest_shift: Position correction's limit in m.
        largest_turn: Orientation correction's limit in rad.
        shift: Correction (3,) in m, command frame.
        turn: Rotation vector (3,) in rad.
    """

    period: float
    time_constant: float = _TIME_CONSTANT * REFERENCE_BODY.beat
    fade: float = 0.2  # derived: 0.7 of a double support of 0.3 s, rounded; the controller gives its own
    largest_shift: float = _LARGEST_SHIFT * REFERENCE_BODY.leg
    largest_turn: float = 0.12  # chosen: 7 degrees
    shift: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    turn: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    _weight: float = 0.0
    _left: float = 1.0  # derived: all is left at the start
    _kept: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))

    @classmethod
    def for_body(cls, body: BodyScale, period: float, fade: float) -> "PostureCompensation":
        """Returns no correction yet, limited to shares of a robot's leg.

        `period` of control in s; `fade`: time in s of its coming and going.
        """
        return cls(period, _TIME_CONSTANT * body.beat, fade, _LARGEST_SHIFT * body.leg)

    def start(self) -> None:
        """Lift-off without correction."""
        self.shift = np.zeros(3)
        self.turn = np.zeros(3)
        self._weight = 0.0
        self._left = 1.0
        self._kept = np.zeros(3)

    def release(self) -> None:
        """A tick of a foot that stands and takes weight: the correction that it landed with fades evenly.

        Measured again, it would follow the body onto the foot, which its leg turns into force: 3 mm and 5 mrad within
        30 ms, as after a probe of 1 s, are 0.7 weights.
        """
        left = max(0.0, self._left - self.period / self.fade)
        share = left / self._left if self._left > 0.0 else 0.0
        self._left = left
        self.shift = share * self.shift
        self.turn = share * self.turn

    def keep(self, shift: NDArray[np.float64]) -> None:
        """Add a landed foot's farther command, so that its target does not jump; it fades.

        `shift`: old less new commanded place (3,) in m, command frame.
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
    ) -> None:
        """Advance by a tick.

        Args:
            swings: Whether still in its single support.
            position: Wanted sole (3,), command frame, in m.
            position_in_world: The same point, world frame, in m.
            com_command: CoM reference (3,), command frame, in m.
            com_estimated: Estimated CoM (3,), world frame, in m.
            rotation_command: Commanded torso (3, 3).
            rotation_estimated: Estimated torso (3, 3), heading as commanded.
        """
        step = self.period / self.fade
        # Fades: at lift-off and touchdown the foot is on the ground, and a jump of its target would push it.
        rest = 1.0 - self._weight
        self._weight = self._weight + step * min(1.0, rest / _ROUNDED) if swings else max(0.0, self._weight - step)
        correct(
            *(position, position_in_world, com_command, com_estimated, rotation_command, rotation_estimated),
            *(self._kept, self.largest_shift, self.largest_turn, self._weight),
            *(min(1.0, self.period / self.time_constant), self.shift, self.turn),
        )
