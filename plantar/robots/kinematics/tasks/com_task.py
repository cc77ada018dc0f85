"""Center of mass at a point."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_step import ComRows, Rows
from plantar.robots.kinematics.tasks.task import Target, Task, chain


class ComTask(Task):
    """A body and its descendants: CoM at a world point. `target`: point (3,) in m, copied where it is set."""

    rows = 3
    lengths = 3
    target = Target()

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, body: int) -> None:
        self._model = model
        self._data = data
        self._body = body
        self._com = data.subtree_com[body]
        self.target = self._com

    def error(self, out: NDArray[np.float64]) -> None:
        """Target less CoM (3,) in m."""
        np.subtract(self.target, self._com, out=out)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Velocity of the CoM (3, nv)."""
        mujoco.mj_jacSubtreeCom(self._model, self._data, out, self._body)

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """See `Task.rows_for`.

        Takes `error` and `jacobian`; returns the kernel.
        """
        model = self._model
        data = self._data
        first = self._body
        last = first + 1  # the bodies of a tree follow each other
        while last < model.nbody and model.body_parentid[last] >= first:
            last += 1
        chains = [chain(model, body) for body in range(first, last)]
        return ComRows(
            *(np.concatenate(chains), np.cumsum([len(c) for c in chains]), model.body_mass[first:last].copy()),
            1.0 / max(mujoco.mjMINVAL, model.body_subtreemass[first]),
            *(data.cdof, data.subtree_com, model.body_rootid[first:last].astype(np.intp), data.xipos[first:last]),
            *(self.target, self._com, error, jacobian),
        )
