"""The interface of inverse kinematics to a task."""

from __future__ import annotations

from abc import ABC, abstractmethod

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_step import Rows


class Target:
    """A target array at a fixed place for kernels, of the first set shape."""

    def __set_name__(self, owner: type[Task], name: str) -> None:
        self._name = name

    def __get__(self, task: Task, owner: type[Task] | None = None) -> NDArray[np.float64]:
        found: NDArray[np.float64] = task.__dict__[self._name]
        return found

    def __set__(self, task: Task, value: NDArray[np.float64]) -> None:
        if self._name in task.__dict__:
            task.__dict__[self._name][:] = value
        else:
            task.__dict__[self._name] = np.array(value, dtype=np.float64)


class Task(ABC):
    """A wish for a configuration, bound to a model and its data.

    The error is the missing displacement: a small step dq with J dq = error removes it. Both are read after
    `mj_kinematics` and `mj_comPos`.

    `lengths`: number of first rows in m; the others are in rad; `level`: priority where tasks conflict, lower first.
    """

    rows: int
    lengths: int = 0
    level: int = 0

    @abstractmethod
    def error(self, out: NDArray[np.float64]) -> None:
        """Write the error (rows,) in m and rad."""

    @abstractmethod
    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Write the Jacobian (rows, nv), contiguous, in m and rad."""

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """A kernel that writes both at once, or None.

        `error`: receives the error (rows,), but for turns over 90 degrees, which `error` writes; `jacobian`: receives
        the Jacobian (rows, nv); zeros without another writer.
        """
        return None


def chain(model: mujoco.MjModel, body: int) -> NDArray[np.intp]:
    """Returns indices (c,) of a model's velocities that move a body, upwards to the root."""
    while body and not model.body_dofnum[body]:  # fixed to its parent
        body = int(model.body_parentid[body])
    moving: list[int] = []
    velocity = int(model.body_dofadr[body] + model.body_dofnum[body]) - 1 if body else -1
    while velocity >= 0:
        moving.append(velocity)
        velocity = int(model.dof_parentid[velocity])
    return np.array(moving, dtype=np.intp)
