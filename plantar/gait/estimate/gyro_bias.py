"""Gyro bias by loaded feet: a standing sole does not turn, so the base turns with leg joints.

Compared in pieces short enough for a slip to exceed noise.
"""

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.gait.gyro_bias import GyroBias as _Kernel

# derived: What a tick counts in which one foot carries, of one in which both do: in a second of single support a foot
# turns by 0.3 mrad by chance, while in one of standing the gyro's noise of 2 mrad/s leaves 0.1 mrad; (0.1 / 0.3)^2
_ONE_FOOT = 0.1

_FIRST_PIECES = 2  # derived: Pieces of standing before a slip differs measurably from a bias


class GyroBias:
    """Mean difference of gyro and leg turn: over all samples, then a time constant.

    A foot counts by load; both-feet ticks count tenfold, as a single sole can turn on soft ground.

    Attributes `kernel`: compiled part, called within the estimator's. `period` of control in s; `time_constant` of the
    mean in s; `largest`: bias of an axis in rad/s; `piece`: its duration in s; `slip`: largest angle in rad by noise in
    a piece.
    """

    def __init__(self, period: float, time_constant: float, largest: float, piece: float, slip: float) -> None:
        self._value = np.zeros(3)
        most_ticks = max(1, round(piece / period))
        self.kernel = _Kernel(
            *(period, period / time_constant, largest, most_ticks, slip),
            *(_ONE_FOOT, _FIRST_PIECES * most_ticks, self._value, np.zeros(3)),
        )

    @property
    def value(self) -> NDArray[np.float64]:
        """Bias (3,), base frame, in rad/s."""
        return self._value.copy()
