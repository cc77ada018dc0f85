"""What inverse kinematics asks of a task."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_rows import Rows

__all__ = ["Target", "Task"]


class Target:
    """What a task is asked for: an array of the task's own, at one place, where a kernel reads it.

    The first array that is set gives its shape; each is copied.
    """

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
    """Something that a configuration should fulfil, bound to a model and its data.

    The error is the displacement that is missing, in the coordinates of the Jacobian's rows: a small step dq with
    J dq = error removes it. Both are read from the data after `mj_kinematics` and `mj_comPos`.

    Attributes:
        rows: Number of rows of error and Jacobian.
        lengths: How many of them, the first ones, are lengths in m; the others are angles in rad.
        level: Where tasks cannot all be fulfilled, those of a lower level go first, and others miss their targets.
    """

    rows: int
    lengths: int = 0
    level: int = 0

    @abstractmethod
    def error(self, out: NDArray[np.float64]) -> None:
        """Write the error (rows,) in m and rad."""

    @abstractmethod
    def jacobian(self, out: NDArray[np.float64]) -> None:
        """Write the Jacobian (rows, nv), contiguous, in m and rad over the model's velocities."""

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Rows | None:
        """A kernel that writes both at once; None for a task that has none, whose solver asks for each.

        Args:
            error: Receives the error (rows,), but for a turn of more than a quarter: then `error` is asked as well.
            jacobian: Receives the Jacobian (rows, nv); an array of zeros that no one else writes to.

        Returns:
            The kernel, or None.
        """
        return None
