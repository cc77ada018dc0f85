"""Missing encoder and IMU readings: briefly the last ones, then blind."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.kernels.safety.plausible import are_finite

Readings: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


class BodySensors:
    """Bridges missing readings of encoders and IMU.

    `period` of control in s; `bridged`: longest use of the last readings in s. Attributes `blind`: whether readings
    were missing longer; final.
    """

    def __init__(self, period: float, bridged: float) -> None:
        self._most = round(bridged / period)
        self._silent = 0
        self._last: Readings | None = None
        self.blind = False

    def usable(self, readings: Readings) -> Readings | None:
        """Readings to use: given, or the last complete if a number is missing; None if blind.

        `readings`: joint angles (k,) in rad, angular velocity (3,) in rad/s and specific force (3,) in m/s^2.
        """
        if self.blind:
            return None
        if are_finite(*readings):
            self._silent = 0
            self._last = readings
            return readings
        if self._last is None:
            raise InputError("encoders or IMU hold a value that is not finite; the first reading has to be sound")
        self._silent += 1
        self.blind = self._silent > self._most
        return None if self.blind else self._last
