"""A sole's frame at a pose but for its roll, which a leg of five joints cannot choose."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.rotation import rotation_error
from plantar.robots.kinematics.tasks.pose_task import PoseTask

__all__ = ["RollingPoseTask"]


class RollingPoseTask(PoseTask):
    """A site should be at a position and an orientation of the world, but may roll about its own x axis.

    A leg without ankle roll puts its sole wherever it should be, with pitch and heading; the roll is what hip and shank
    make of it, and is left to the ground. See `PoseTask` for attributes and arguments.
    """

    rows = 5

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, site: int) -> None:
        super().__init__(model, data, site)
        self._turns = np.zeros((3, model.nv))

    def error(self, out: NDArray[np.float64]) -> None:
        """Way (3,) in m that is missing, in the world frame, and turn (2,) about the site's own y and z axes."""
        np.subtract(self.position, self._position, out=out[:3])
        out[3:] = (self._rotation.T @ rotation_error(self.rotation, self._rotation))[1:]

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Velocity of the site (3, nv) in the world frame, and its rate of turn (2, nv) about its own y and z axes."""
        mujoco.mj_jacSite(self._model, self._data, out[:3], self._turns, self._site)
        out[3:] = self._rotation.T[1:] @ self._turns

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> None:
        """None: this task has no kernel.

        Takes `error` and `jacobian`.
        """
