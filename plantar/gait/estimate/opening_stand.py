"""Sensor means of the opening stand."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.estimate.estimator import SoleLoad


class Stood(NamedTuple):
    """Means of a standing robot.

    `joint_positions`: encoders (k,) in rad; `up`: unit vector (3,) against gravity, base frame, by accelerometer;
    `wrenches` (6,) on each sole, own frame, in N and N m.
    """

    joint_positions: NDArray[np.float64]
    up: NDArray[np.float64]
    wrenches: Mapping[Side, NDArray[np.float64]]


class OpeningStand:
    """Averages encoders, accelerometer and soles."""

    def __init__(self) -> None:
        self._count = 0
        self._joints = np.zeros(0)
        self._specific = np.zeros(3)
        self._wrenches: dict[Side, NDArray[np.float64]] = {side: np.zeros(6) for side in SIDES}

    def update(
        self, joint_positions: NDArray[np.float64], accelerometer: NDArray[np.float64], soles: Mapping[Side, SoleLoad]
    ) -> None:
        """Add a control tick: encoders `joint_positions` (k,) in rad, specific force `accelerometer` (3,) of the base,
        base frame, in m/s^2, and each sole's load, `soles`.
        """
        self._count += 1
        self._joints = joint_positions.copy() if self._count == 1 else self._joints + joint_positions
        self._specific = self._specific + accelerometer
        for side in SIDES:
            self._wrenches[side] = self._wrenches[side] + soles[side].wrench_in_sole

    def mean(self) -> Stood | None:
        """Means so far; None before the first tick."""
        if self._count == 0:
            return None
        n = self._count
        return Stood(
            self._joints / n,
            self._specific / float(np.linalg.norm(self._specific)),
            {side: self._wrenches[side] / n for side in SIDES},
        )
