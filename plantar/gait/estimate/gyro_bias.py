"""Bias of the gyro, by feet that carry: a sole on the ground does not turn, so the base turns as the leg's joints do.

With R_s the rotation from a sole that stands to the base frame, R_s(k-1) R_s(k)^T is how the base turned in a tick,
seen in its own frame. What the gyro says beyond that is bias and noise. A single tick says little of it, as the noise
of the encoders is differentiated (5e-5 rad in 5 ms: 14 mrad/s), but in a mean over time that telescopes: after T
seconds an angle of 0.1 mrad over T is left of it. No accelerometer is needed, so all three axes are found, the vertical
one too.

Soles do turn: one that slips turns by milliradians within a tenth of a second. Both are therefore compared piece by
piece, each short enough for a slip to stand out of what noise leaves.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.gait.gyro_bias import GyroBias as _Kernel
from plantar.sides import Side

__all__ = ["GyroBias"]


_ONE_FOOT = 0.1
"""What a tick counts in which one foot carries, of one in which both do: in a second of single support a foot turns by
0.3 mrad by chance, while in one of standing the gyro's noise of 2 mrad/s leaves 0.1 mrad."""

_FIRST_PIECES = 2
"""Pieces of standing before a slip can be told from a bias."""


class GyroBias:
    """Mean of what the gyro measures beyond the turn of the legs: of all that came so far, then over a time constant.

    A foot weighs in with its load. A tick in which both feet carry counts ten times as much as one in which one does:
    the robot stands, while a sole that carries it in a step may turn, on soft ground or an edge, which is not told from
    a bias; over steps that comes to 0.1 mrad/s. A piece in which both are further apart about the base's z axis than
    noise explains counts as one in which they are as far apart as it may be.

    Attributes:
        value: The bias (3,) in the base frame in rad/s.
        missed: Angle (3,) in the base frame in rad by which the legs turned more than the gyro says, less its bias, in
            the piece that has just ended and in which no sole slipped; None while none has.
        kernel: What computes it: the estimator calls it within its own.

    Args:
        period: Control period in s.
        time_constant: Time constant in s of the mean.
        largest: Largest bias of an axis in rad/s; what would be beyond it is something else.
        piece: Duration in s of a piece.
        slip: Angle in rad that noise leaves at most in a piece.

    Example:
        >>> bias = GyroBias(0.005, 20.0, 0.05, 0.005, 6e-4)
        >>> bias.update(np.array([0.0, 0.0, 0.004]), np.zeros(3), {"left": 400.0, "right": 400.0}).tolist()
        [0.0, 0.0, 0.004]
    """

    def __init__(self, period: float, time_constant: float, largest: float, piece: float, slip: float) -> None:
        self._value, self._missed = np.zeros(3), np.zeros(3)
        most_ticks = max(1, round(piece / period))
        self.kernel = _Kernel(
            *(period, period / time_constant, largest, most_ticks, slip),
            *(_ONE_FOOT, _FIRST_PIECES * most_ticks, self._value, self._missed),
        )

    @property
    def value(self) -> NDArray[np.float64]:
        """The bias (3,) as it is now."""
        return self._value.copy()

    @property
    def missed(self) -> NDArray[np.float64] | None:
        """What the legs turned more in the piece that ended at the last tick (3,)."""
        return self._missed.copy() if self.kernel.concluded else None

    def update(
        self,
        gyro: NDArray[np.float64],
        turn: NDArray[np.float64] | None,
        weights: Mapping[Side, float],
    ) -> NDArray[np.float64]:
        """One control tick.

        Args:
            gyro: Angular velocity (3,) of the base in its own frame in rad/s, as measured.
            turn: Angle (3,) in the base frame in rad by which feet that stand still say the base has turned in the tick
                (`plantar.kernels.gait.floating_base.FloatingBase.stand_still`); None where no foot stands still.
            weights: How much each foot carries, in any unit; 0 for one that does not stand still.

        Returns:
            The bias (3,) in rad/s; the last one while no foot stands still.
        """
        gx, gy, gz = gyro.tolist()
        tx, ty, tz = (0.0, 0.0, 0.0) if turn is None else turn.tolist()
        both = weights["left"] > 0.0 and weights["right"] > 0.0
        self.kernel.update(gx, gy, gz, turn is not None, tx, ty, tz, both)
        return self.value
