"""Kernel of a step of inverse kinematics: rows of all tasks, Newton's step, and the configuration."""

__all__ = ["TaskStep"]


class TaskStep:
    """Takes a step in the plain case.

    Args:
        rows: The tasks' `task_rows.Rows`, a list.
        newton: The `NewtonStep`.
        configuration: The `Configuration` to move.

    Attributes:
        near: Whether the rows held all errors at the last step; else a task has to write its own.
    """

    def __init__(self, rows, newton, configuration):
        self.rows, self.newton, self.configuration = rows, newton, configuration
        self.near = True

    def step(self, largest):
        """Write the rows, and take a step of at most `largest` in units if they hold all errors."""
        self.near = True
        for rows in self.rows:
            if not rows.write():
                self.near = False
        if not (self.near and self.newton.solve(largest)):
            return False
        self.move()
        return True

    def move(self):
        """Take the current step."""
        self.newton.write()
        self.configuration.move()
