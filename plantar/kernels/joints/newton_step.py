"""Kernel of a Newton step of inverse kinematics by the normal equations."""

import math

import numpy as np

__all__ = ["NewtonStep"]


class NewtonStep:
    """Solves J^T J dq = J^T e, with a term on the diagonal, for some of a model's velocities.

    Args:
        columns: Velocities (n,) that a step may use.
        row_units: Factor (m,) of each row of error and Jacobian.
        column_units: Factor (nv,) of each column of the Jacobian and velocity.
        movable: Entries (k,) of a step that move a joint.
        places: Indices (k,) of these joints in the configuration.
        middle: Middle of each joint's range (k,).
        half: Half of that range (k,); inf without one.
        diagonal: Term on the diagonal.
        least_pivot: Least Cholesky pivot of a valid step.
        given: Jacobian (m, nv) and error (m,) in m and rad, and configuration (nq,), written by the caller.
        jacobian: Receives the Jacobian (m, n) in units.
        step: Receives the step (n,) in units.
        velocity: Receives the step (nv,) in m and rad.
    """

    def __init__(
        self, columns, row_units, column_units, movable, places, middle, half, diagonal, least_pivot, given, jacobian,
        step, velocity,
    ):  # fmt: skip
        self.columns, self.row_units, self.column_units = columns, row_units, column_units
        self.movable, self.places, self.middle, self.half = movable, places, middle, half
        self.diagonal, self.least_pivot = diagonal, least_pivot
        self.given, self.error, self.configuration = given
        self.jacobian, self.step, self.velocity = jacobian, step, velocity
        self.normal = np.zeros((len(columns), len(columns)))
        self.column = np.zeros(len(columns))

    def solve(self, largest):
        """Whether a step of at most `largest` in units is valid: finite, no small pivot, within joint limits.

        Afterwards the error is in units.
        """
        normal, step, used, columns = self.normal, self.step, self.jacobian, self.columns
        jacobian, error = self.given, self.error
        m, n = self.row_units.shape[0], self.columns.shape[0]
        for i in range(n):
            step[i] = 0.0
            for j in range(i + 1):
                normal[i, j] = self.diagonal if i == j else 0.0
        for r in range(m):
            error[r] *= self.row_units[r]
            for i in range(n):
                used[r, i] = jacobian[r, columns[i]] * (self.row_units[r] * self.column_units[columns[i]])
            for i in range(n):
                share = used[r, i]
                if share != 0.0:
                    step[i] += share * error[r]
                    for j in range(i + 1):
                        normal[i, j] += share * used[r, j]
        return self._factor(n) and self._stays(n, largest)

    def _factor(self, n):
        """Cholesky factor and solution; whether all pivots are large enough."""
        normal, step, column = self.normal, self.step, self.column
        for k in range(n):
            if not normal[k, k] > self.least_pivot * self.least_pivot:
                return False
            pivot = math.sqrt(normal[k, k])
            normal[k, k] = pivot
            step[k] /= pivot
            for i in range(k + 1, n):
                column[i] = normal[i, k] / pivot
                normal[i, k] = column[i]
                step[i] -= column[i] * step[k]
            for i in range(k + 1, n):
                share = column[i]
                if share != 0.0:
                    for j in range(k + 1, i + 1):
                        normal[i, j] -= share * column[j]
        for k in range(n - 1, -1, -1):
            step[k] /= normal[k, k]
            for i in range(k):
                step[i] -= normal[k, i] * step[k]
        return True

    def _stays(self, n, largest):
        """Whether no entry is too large, and no joint leaves its limits."""
        configuration = self.configuration
        for i in range(n):
            if not math.fabs(self.step[i]) <= largest:
                return False
        for k in range(self.movable.shape[0]):
            beside = configuration[self.places[k]] + self.step[self.movable[k]] - self.middle[k]
            if not math.fabs(beside) <= self.half[k]:
                return False
        return True

    def worst(self):
        """Largest absolute error; NaN if one is."""
        error, largest = self.error, 0.0
        for r in range(self.row_units.shape[0]):
            value = math.fabs(error[r])
            if not value <= largest:
                largest = value
                if value != value:
                    break
        return largest

    def write(self):
        """Write the step, as found or changed since, to the model's velocity."""
        for i in range(self.columns.shape[0]):
            self.velocity[self.columns[i]] = self.step[i] * self.column_units[self.columns[i]]
