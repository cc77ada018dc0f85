"""Torques of a walking command: its ground forces, and its motion."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Command
from plantar.kernels.joints.motion_load import JointMotion
from plantar.robots.kinematics.leg_model import LegModel

_SMOOTH = 0.04  # beat, time constant of the low pass on the acceleration: 10 ms on a leg of 0.6 m


class PlannedMotion:
    """Velocity and acceleration of solutions a control period apart, and their torques.

    `period`: control period in s; `beat`: time scale sqrt(leg / g) in s; `whole`: whether unloaded legs get what moves
    them (`LegModel.add_motion`). Attributes `velocity` of the last solution (6 + k,) in m/s and rad/s; 0 at the first;
    `acceleration` (6 + k,), low-passed; both
    are overwritten by the next `update`.
    """

    def __init__(self, legs: LegModel, period: float, beat: float, whole: bool = False) -> None:
        self._legs = legs
        self._period = period
        self._whole = whole
        share = -math.expm1(-period / (_SMOOTH * beat))
        model = legs.model
        self._model = model
        self._configuration = legs.live_configuration
        self._last = np.zeros(model.nq)
        self._begun = False
        self._moved = np.zeros(model.nv)
        self._motion = JointMotion(self._moved, legs.rows, period, share)
        self.velocity: NDArray[np.float64] = self._motion.velocity
        self.acceleration: NDArray[np.float64] = self._motion.acceleration

    def update(self) -> None:
        """Take in the legs' last solution."""
        if self._begun:
            mujoco.mj_differentiatePos(self._model, self._moved, self._period, self._last, self._configuration)
            self._motion.update()
        self._begun = True
        self._last[:] = self._configuration

    def carry(self, command: Command) -> None:
        """Torques of the last solution under a `command`'s forces and of its motion: the legs' `torques`."""
        self._legs.carry_command(command, self.velocity, self.acceleration, self._whole)
