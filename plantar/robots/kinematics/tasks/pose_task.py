"""A site, for example a sole's frame, at a pose."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_rows import PoseRows, Rows
from plantar.kernels.mechanics.rotations import missing_pose
from plantar.mechanics.rotation import rotation_error
from plantar.robots.kinematics.tasks.chain import chain
from plantar.robots.kinematics.tasks.task import Target, Task

__all__ = ["PoseTask"]


class PoseTask(Task):
    """A site should be at a position and an orientation of the world.

    Attributes:
        position: Its origin (3,) in m, copied where it is set.
        rotation: Rotation (3, 3) from the site to the world frame, likewise.
    """

    rows = 6
    lengths = 3
    position, rotation = Target(), Target()

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, site: int) -> None:
        self._model, self._data, self._site = model, data, site
        self._position = data.site_xpos[site]
        self._rotation = data.site_xmat[site].reshape(3, 3)
        self.position, self.rotation = self._position, self._rotation

    def error(self, out: NDArray[np.float64]) -> None:
        """Way (3,) in m and turn (3,) that are missing, in the world frame."""
        if not missing_pose(self.position, self.rotation, self._position, self._rotation, out):
            out[3:] = rotation_error(self.rotation, self._rotation)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Velocity and angular velocity of the site (6, nv) in the world frame."""
        mujoco.mj_jacSite(self._model, self._data, out[:3], out[3:], self._site)

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """A kernel that writes both at once (see `Task.rows_for`).

        Returns the kernel.

        Args:
            error: Receives the error (rows,).
            jacobian: Receives the Jacobian (rows, nv).
        """
        model, data = self._model, self._data
        body = int(model.site_bodyid[self._site])
        return PoseRows(
            *(chain(model, body), data.cdof, data.subtree_com[model.body_rootid[body]]),
            *(self.position, self.rotation, self._position, self._rotation, error, jacobian),
        )
