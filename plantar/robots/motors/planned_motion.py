"""Torques of a walking command: its ground forces, and its motion."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Command
from plantar.robots.kinematics.command_joints import carry_command
from plantar.robots.kinematics.leg_model import LegModel

_SMOOTH = 0.04  # beat, time constant of the low pass on the acceleration: 10 ms on a leg of 0.6 m


class PlannedMotion:
    """Velocity and acceleration of solutions a control period apart, and their torques.

    `period`: control period in s; `beat`: time scale sqrt(leg / g) in s; `whole`: whether unloaded legs get what moves
    them (`LegModel.add_motion`). Attributes `velocity` of the last solution (6 + k,) in m/s and rad/s; 0 at the first;
    `acceleration` (6 + k,), low-passed.
    """

    def __init__(self, legs: LegModel, period: float, beat: float, whole: bool = False) -> None:
        self._legs = legs
        self._period = period
        self._whole = whole
        self._share = -math.expm1(-period / (_SMOOTH * beat))
        self._last: NDArray[np.float64] | None = None
        self._moved = np.zeros(legs.model.nv)
        self.velocity = np.zeros(len(legs.rows))
        self.acceleration = np.zeros(len(legs.rows))

    def update(self) -> None:
        """Take in the legs' last solution."""
        configuration = self._legs.configuration
        if self._last is not None:
            mujoco.mj_differentiatePos(self._legs.model, self._moved, self._period, self._last, configuration)
            velocity = self._moved[self._legs.rows]
            self.acceleration += self._share * ((velocity - self.velocity) / self._period - self.acceleration)
            self.velocity = velocity
        self._last = configuration

    def carry(self, command: Command) -> None:
        """Torques of the last solution under a `command`'s forces and of its motion: the legs' `torques`."""
        carry_command(self._legs, command)
        left = max(command.feet["left"].force.item(2), 0.0)
        right = max(command.feet["right"].force.item(2), 0.0)
        share = left / (left + right) if left + right > 0.0 else 0.5
        self._legs.add_motion(
            self.velocity,
            self.acceleration,
            share,
            command.momentum,
            self._whole,
        )
