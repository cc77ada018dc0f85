"""Motion of the whole body that a series of joint solutions plans."""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["PlannedMotion"]

_SMOOTH = 0.04  # beat, time constant of the low pass on the acceleration: 10 ms on a leg of 0.6 m


class PlannedMotion:
    """Velocity and acceleration of solutions that follow each other by a control period.

    Args:
        model: The robot alone.
        rows: Places (6 + k,) of the base's and the leg joints' velocities.
        period: Control period in s.
        beat: Time scale sqrt(leg / g) of the robot in s.

    Attributes:
        velocity: Velocity (6 + k,) of the last solution in m/s and rad/s; 0 at the first one.
        acceleration: Its acceleration (6 + k,), low-passed.
    """

    def __init__(self, model: mujoco.MjModel, rows: NDArray[np.int_], period: float, beat: float) -> None:
        self._model, self._rows, self._period = model, rows, period
        self._share = -math.expm1(-period / (_SMOOTH * beat))
        self._last: NDArray[np.float64] | None = None
        self._moved = np.zeros(model.nv)
        self.velocity, self.acceleration = np.zeros(len(rows)), np.zeros(len(rows))

    def update(self, configuration: NDArray[np.float64]) -> None:
        """Take in a solution, a configuration (nq,)."""
        if self._last is not None:
            mujoco.mj_differentiatePos(self._model, self._moved, self._period, self._last, configuration)
            velocity = self._moved[self._rows]
            change = (velocity - self.velocity) / self._period
            self.acceleration += self._share * (change - self.acceleration)
            self.velocity = velocity
        self._last = configuration
