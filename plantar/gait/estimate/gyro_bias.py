"""Bias of the gyro, from feet that carry: a sole on the ground does not turn, so the base turns as the leg's joints do.

With R_s the rotation from a standing sole to the base frame, R_s(k-1) R_s(k)^T is the turn of the base in a tick, in
its own frame. The rest of the gyro's reading is bias and noise. Encoder noise in one tick is large (5e-5 rad in 5 ms:
14 mrad/s), but the mean telescopes: after T seconds 0.1 mrad / T is left. No accelerometer is needed, so all three axes
are observed, the vertical one too.

Soles slip: by milliradians within a tenth of a second. Both turns are therefore compared in pieces short enough for a
slip to exceed the noise.
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
    """Mean difference of the gyro and the turn of the legs: over all samples so far, then over a time constant.

    A foot is weighted by its load, and a tick in which both feet carry counts ten times as much: a single sole may turn
    on soft ground or an edge, which looks like a bias (0.1 mrad/s over steps). A piece in which both differ
    about the base's z axis by more than noise explains is limited to that difference.

    Attributes:
        value: The bias (3,) in the base frame in rad/s.
        missed: Angle (3,) in the base frame in rad by which the legs turned more than the corrected gyro in the piece
            that has just ended without a slip; else None.
        kernel: The compiled part, which the estimator calls within its own.

    Args:
        period: Control period in s.
        time_constant: Time constant in s of the mean.
        largest: Largest bias of an axis in rad/s.
        piece: Duration in s of a piece.
        slip: Largest angle in rad by which noise differs in a piece.

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
        """The bias (3,) in the base frame in rad/s."""
        return self._value.copy()

    @property
    def missed(self) -> NDArray[np.float64] | None:
        """Angle (3,) in rad by which the legs turned more in the piece that ended at the last tick."""
        return self._missed.copy() if self.kernel.concluded else None

    def update(
        self,
        gyro: NDArray[np.float64],
        turn: NDArray[np.float64] | None,
        weights: Mapping[Side, float],
    ) -> NDArray[np.float64]:
        """Advance by one control tick.

        Args:
            gyro: Measured angular velocity (3,) of the base in its own frame in rad/s.
            turn: Turn (3,) of the base in the tick in rad by the still feet, in the base frame
                (`plantar.kernels.gait.floating_base.FloatingBase.stand_still`); None where no foot is still.
            weights: Load of each foot in any unit; 0 for one that is not still.

        Returns:
            The bias (3,) in rad/s, unchanged while no foot is still.
        """
        gx, gy, gz = gyro.tolist()
        tx, ty, tz = (0.0, 0.0, 0.0) if turn is None else turn.tolist()
        both = weights["left"] > 0.0 and weights["right"] > 0.0
        self.kernel.update(gx, gy, gz, turn is not None, tx, ty, tz, both)
        return self.value
