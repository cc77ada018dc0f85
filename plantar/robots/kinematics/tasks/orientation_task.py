"""A body upright, or at any other orientation."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_rows import Rows, TurnRows
from plantar.kernels.mechanics.rotations import missing_turn
from plantar.mechanics.rotation import rotation_error
from plantar.robots.kinematics.tasks.chain import chain
from plantar.robots.kinematics.tasks.task import Target, Task

__all__ = ["OrientationTask"]


class OrientationTask(Task):
    """A body should have an orientation in the world.

    Attributes:
        target: Rotation (3, 3) from the body to the world frame, copied where it is set.
    """

    rows = 3
    target = Target()

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, body: int) -> None:
        self._model, self._data, self._body = model, data, body
        self._rotation = data.xmat[body].reshape(3, 3)
        self.target = self._rotation

    def error(self, out: NDArray[np.float64]) -> None:
        """Turn (3,) that is missing, in the world frame (see `plantar.mechanics.rotation.rotation_error`)."""
        if not missing_turn(self.target, self._rotation, out):
            out[:] = rotation_error(self.target, self._rotation)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Angular velocity of the body (3, nv) in the world frame."""
        mujoco.mj_jacBody(self._model, self._data, None, out, self._body)

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """A kernel that writes both at once (see `Task.rows_for`).

        Returns the kernel.

        Args:
            error: Receives the error (rows,).
            jacobian: Receives the Jacobian (rows, nv).
        """
        return TurnRows(
            *(chain(self._model, self._body), self._data.cdof, self.target, self._rotation, error, jacobian)
        )
