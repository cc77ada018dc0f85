"""Gyro bias by loaded feet: a standing sole does not turn, so the base turns with leg joints.

Compared in pieces short enough for a slip to exceed noise.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.gait.gyro_bias import GyroBias as _Kernel
from plantar.sides import Side

# What a tick counts in which one foot carries, of one in which both do: in a second of single support a foot turns by
# 0.3 mrad by chance, while in one of standing the gyro's noise of 2 mrad/s leaves 0.1 mrad
_ONE_FOOT = 0.1

_FIRST_PIECES = 2  # Pieces of standing before a slip differs measurably from a bias


class GyroBias:
    """Mean difference of gyro and leg turn: over all samples, then a time constant.

    A foot counts by load; both-feet ticks count tenfold, as a single sole can turn on soft ground.

    Attributes:
        kernel: Compiled part, called within the estimator's.

    Args:
        period: Of control in s.
        time_constant: Of the mean in s.
        largest: Bias of an axis in rad/s.
        piece: Its duration in s.
        slip: Largest angle in rad by noise in a piece.
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
        """Bias (3,), base frame, in rad/s."""
        return self._value.copy()

    @property
    def missed(self) -> NDArray[np.float64] | None:
        """Angle (3,) in rad, base frame, that the legs turned more in a just ended piece without slip, or None."""
        return self._missed.copy() if self.kernel.concluded else None

    def update(
        self,
        gyro: NDArray[np.float64],
        turn: NDArray[np.float64] | None,
        weights: Mapping[Side, float],
    ) -> NDArray[np.float64]:
        """Returns bias (3,) in rad/s after a tick.

        By the `gyro` (3,) in rad/s and the base's `turn` (3,) in rad by still feet, None without, both in the base
        frame; `weights` is each foot's load in any unit, 0 if not still.
        """
        gx, gy, gz = gyro.tolist()
        tx, ty, tz = (0.0, 0.0, 0.0) if turn is None else turn.tolist()
        both = weights["left"] > 0.0 and weights["right"] > 0.0
        self.kernel.update(gx, gy, gz, turn is not None, tx, ty, tz, both)
        return self.value
