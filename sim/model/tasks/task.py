"""What inverse kinematics asks of a task."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = ["Task"]


class Task(ABC):
    """Something that a configuration shall fulfil, bound to a model and its data.

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

    def writer(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> Callable[[], None]:
        """What writes both, whenever it is called, where a solver wants them: a task that has a kernel does so at once.

        Args:
            error: Receives the error (rows,).
            jacobian: Receives the Jacobian (rows, nv); an array of zeros that nobody else writes to.
        """

        def write() -> None:
            self.error(error)
            self.jacobian(jacobian)

        return write
