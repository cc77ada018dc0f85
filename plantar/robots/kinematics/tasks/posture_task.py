"""Joints at a reference posture."""

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.robots.kinematics.tasks.task import Task


class PostureTask(Task):
    """Hinge and slide joints at given positions. `target`: positions (k,) in rad or m."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, joints: Sequence[int]) -> None:
        self.rows = len(joints)
        self._positions = data.qpos
        self._places = np.array([model.jnt_qposadr[i] for i in joints], dtype=int)
        self._dofs = np.array([model.jnt_dofadr[i] for i in joints], dtype=int)
        self.target: NDArray[np.float64] = self._positions[self._places]

    def error(self, out: NDArray[np.float64]) -> None:
        """Target less position (k,) in rad or m."""
        np.subtract(self.target, self._positions[self._places], out=out)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Ones (k, nv) at the joints' velocities."""
        out[:] = 0.0
        out[np.arange(self.rows), self._dofs] = 1.0
