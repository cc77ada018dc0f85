"""A site, for example a sole's frame, at a pose."""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.rotations import missing_pose
from plantar.kernels.task_rows import PoseRows
from plantar.mechanics.rotation import rotation_error
from sim.model.tasks.chain import chain
from sim.model.tasks.task import Task

__all__ = ["PoseTask"]


class PoseTask(Task):
    """A site shall be at a position and an orientation of the world.

    Attributes:
        position: Its origin (3,) in m.
        rotation: Rotation (3, 3) from the site to the world frame.

    Args:
        model: The model.
        data: Its data.
        site: The site's id.
    """

    rows = 6
    lengths = 3

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, site: int) -> None:
        self._model, self._data, self._site = model, data, site
        self._position = data.site_xpos[site]
        self._rotation = data.site_xmat[site].reshape(3, 3)
        self.position: NDArray[np.float64] = self._position.copy()
        self.rotation: NDArray[np.float64] = self._rotation.copy()

    def error(self, out: NDArray[np.float64]) -> None:
        """Way (3,) in m and turn (3,) that are missing, in the world frame."""
        if not missing_pose(self.position, self.rotation, self._position, self._rotation, out):
            out[3:] = rotation_error(self.rotation, self._rotation)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Velocity and angular velocity of the site (6, nv) in the world frame."""
        mujoco.mj_jacSite(self._model, self._data, out[:3], out[3:], self._site)

    def writer(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Callable[[], None]:
        """See `Task.writer`."""
        model, data = self._model, self._data
        body = int(model.site_bodyid[self._site])
        rows = PoseRows(
            *(chain(model, body), data.cdof, data.subtree_com[model.body_rootid[body]]),
            *(self._position, self._rotation, error, jacobian),
        )

        def write() -> None:
            if not rows.write(self.position, self.rotation):
                error[3:] = rotation_error(self.rotation, self._rotation)

        return write
