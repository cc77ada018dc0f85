"""A site, for example a sole's frame, at a pose."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_step import PoseRows, Rows, TurnRows
from plantar.kernels.mechanics.rotations import missing_pose, missing_turn
from plantar.mechanics.rotation import rotation_error
from plantar.robots.kinematics.tasks.task import Target, Task, chain


class PoseTask(Task):
    """A site at a position and an orientation of the world.

    `position`: origin (3,) in m, copied where it is set; `rotation`: rotation (3, 3) from site to world, likewise.
    """

    rows = 6
    lengths = 3
    position = Target()
    rotation = Target()

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, site: int) -> None:
        self._model = model
        self._data = data
        self._site = site
        self._position = data.site_xpos[site]
        self._rotation = data.site_xmat[site].reshape(3, 3)
        self.position = self._position
        self.rotation = self._rotation

    def error(self, out: NDArray[np.float64]) -> None:
        """Missing way (3,) in m and turn (3,), in the world frame."""
        if not missing_pose(self.position, self.rotation, self._position, self._rotation, out):
            out[3:] = rotation_error(self.rotation, self._rotation)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Velocity and angular velocity of the site (6, nv), world frame."""
        mujoco.mj_jacSite(self._model, self._data, out[:3], out[3:], self._site)

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """See `Task.rows_for`.

        Takes `error` and `jacobian`; returns the kernel.
        """
        model = self._model
        data = self._data
        body = int(model.site_bodyid[self._site])
        return PoseRows(
            *(chain(model, body), data.cdof, data.subtree_com[model.body_rootid[body]]),
            *(self.position, self.rotation, self._position, self._rotation, error, jacobian),
        )


class OrientationTask(Task):
    """A body at an orientation in the world. `target`: rotation (3, 3) from body to world, copied where it is set."""

    rows = 3
    target = Target()

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, body: int) -> None:
        self._model = model
        self._data = data
        self._body = body
        self._rotation = data.xmat[body].reshape(3, 3)
        self.target = self._rotation

    def error(self, out: NDArray[np.float64]) -> None:
        """Missing turn (3,) in the world (see `plantar.mechanics.rotation.rotation_error`)."""
        if not missing_turn(self.target, self._rotation, out):
            out[:] = rotation_error(self.target, self._rotation)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Angular velocity of the body (3, nv) in the world frame."""
        mujoco.mj_jacBody(self._model, self._data, None, out, self._body)

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """See `Task.rows_for`.

        Takes `error` and `jacobian`; returns the kernel.
        """
        return TurnRows(
            *(chain(self._model, self._body), self._data.cdof, self.target, self._rotation, error, jacobian)
        )


class RollingPoseTask(PoseTask):
    """A site's pose with any roll about its x axis.

    See `PoseTask` for attributes and arguments.
    """

    rows = 5

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, site: int) -> None:
        super().__init__(model, data, site)
        self._turns = np.zeros((3, model.nv))

    def error(self, out: NDArray[np.float64]) -> None:
        """Missing way (3,) in m, world frame, and turn (2,) about the site's y, z."""
        np.subtract(self.position, self._position, out=out[:3])
        out[3:] = (self._rotation.T @ rotation_error(self.rotation, self._rotation))[1:]

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Site velocity (3, nv), world frame, and turn rate (2, nv) about its y, z."""
        mujoco.mj_jacSite(self._model, self._data, out[:3], self._turns, self._site)
        out[3:] = self._rotation.T[1:] @ self._turns

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> None:
        """None: no kernel.

        Takes `error` and `jacobian`.
        """
