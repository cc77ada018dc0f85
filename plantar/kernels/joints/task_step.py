"""Kernel of a step of inverse kinematics: rows of all tasks, Newton's step, and the configuration that it moves."""

from __future__ import annotations

__all__ = ["TaskStep"]


class TaskStep:
    """Takes a step where it is plain.

    Args:
        rows: Rows of the tasks that have a kernel (`task_rows.Rows`), a list.
        newton: Newton's step of error and Jacobian (`newton_step.NewtonStep`).
        configuration: What moves at its velocity (`configuration.Configuration`).

    Attributes:
        near: Whether the rows held all errors at the last step; else a task has to write its own.
    """

    def __init__(self, rows, newton, configuration):
        self.rows, self.newton, self.configuration = rows, newton, configuration
        self.near = True

    def step(self, largest):
        """Write the rows, and take the step if they hold all errors and it may stay as it is.

        Args:
            largest: Largest entry of a step in units.
        """
        self.near = True
        for rows in self.rows:
            if not rows.write():
                self.near = False
        if not (self.near and self.newton.solve(largest)):
            return False
        self.move()
        return True

    def move(self):
        """Take the step as it stands."""
        self.newton.write()
        self.configuration.move()
