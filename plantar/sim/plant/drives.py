"""True drives: encoders with zero errors, delayed set-points, gears with play."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.sim.plant.delay import Delay
from plantar.sim.plant.draw import TruePlant

__all__ = ["RIPPLES", "TrueDrives"]

RIPPLES = 200.0
"""Swings of the torque in a turn of a joint: two in a turn of the wave generator of a harmonic drive of 100 : 1."""


class TrueDrives:
    """Converts set-points so that the simulator's ideal servos behave as the true drives.

    A servo computes torque = kp (u - q) - kv q'. A gear with the play b passes no torque while the shaft moves between
    its flanks, then kp times the excess of u - q over b / 2. A gear with torque ripple passes (1 + r sin(n q)) times
    the torque. Both are expressed by another u.

    Args:
        plant: The true plant.
        stiffness: Position gains (k,) in N m/rad by the robot's file.
        damping: Velocity gains (k,) in N m s/rad, likewise.
    """

    def __init__(self, plant: TruePlant, stiffness: NDArray[np.float64], damping: NDArray[np.float64]) -> None:
        self._offsets = plant.encoder_offsets
        self._line: Delay[NDArray[np.float64]] | None = Delay(plant.actuation_delay) if plant.actuation_delay else None
        self._play = 0.5 * plant.backlash
        self._ripple = plant.torque_ripple
        self._lead = damping / (plant.stiffness_ratio * stiffness)

    def followed(
        self, time: float, setpoint: NDArray[np.float64], joints: NDArray[np.float64], speeds: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Set-points for the simulator's servos.

        Args:
            time: Time in s, never decreasing.
            setpoint: Set-points (k,) in rad.
            joints: True joint angles (k,) in rad.
            speeds: True joint speeds (k,) in rad/s.

        Returns:
            Angles (k,) in rad: the set-points that have arrived, less encoder offsets, after the gear.
        """
        arrived = setpoint if self._line is None else self._line.passed(time, setpoint)
        wanted = arrived - self._offsets
        if self._play:
            error = wanted - joints
            wanted = wanted - np.clip(error, -self._play, self._play)
        if self._ripple:
            wanted = wanted + self._ripple * np.sin(RIPPLES * joints) * (wanted - joints - self._lead * speeds)
        return np.asarray(wanted)
