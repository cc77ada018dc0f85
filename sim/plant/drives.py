"""What the true drives make of a set-point: encoders whose zero is off, and set-points that come late."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sim.plant.delay import Delay
from sim.plant.draw import TruePlant

__all__ = ["TrueDrives"]


class TrueDrives:
    """The drives of the leg joints.

    Args:
        plant: The true plant.
    """

    def __init__(self, plant: TruePlant) -> None:
        self._offsets = plant.encoder_offsets
        self._line: Delay[NDArray[np.float64]] | None = Delay(plant.actuation_delay) if plant.actuation_delay else None

    def followed(self, time: float, setpoint: NDArray[np.float64]) -> NDArray[np.float64]:
        """The joint angles that the servos really go to.

        Args:
            time: Time in s, which never goes back.
            setpoint: Set-points (k,) in rad.

        Returns:
            Those that have arrived (k,) in rad, less what the encoders read too much: a servo goes by its encoder.
        """
        arrived = setpoint if self._line is None else self._line.passed(time, setpoint)
        return np.asarray(arrived - self._offsets)
