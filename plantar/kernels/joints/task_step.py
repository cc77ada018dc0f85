"""Step of inverse kinematics: all tasks' rows, Newton's step, configuration."""

import math

import numpy as np

from ..mechanics import rotations

__all__ = ["ComRows", "Configuration", "NewtonStep", "PointRows", "PoseRows", "Rows", "TaskStep", "TurnRows"]


class NewtonStep:
    """Solves J^T J dq = J^T e, with a diagonal term, for some velocities.

    Args:
        columns: Velocities (n,) that a step may use.
        row_units: Factor (m,) of each row of error and Jacobian; `column_units` (nv,) of each column and velocity.
        movable: Entries (k,) of step that move a joint; `places` (k,) their joints in configuration.
        middle: Middle of each joint's range (k,); `half` of it, inf without one.
        least_pivot: Least Cholesky pivot of valid step.
        given: Jacobian (m, nv) and error (m,) in m and rad, and configuration (nq,), written by caller.
        jacobian: Receives Jacobian (m, n) in units; `step` (n,) step.
        velocity: Receives step (nv,) in m and rad.
    """

    def __init__(
        self, columns, row_units, column_units, movable, places, middle, half, diagonal, least_pivot, given, jacobian,
        step, velocity,
    ):  # fmt: skip
        self.columns = columns
        self.row_units = row_units
        self.column_units = column_units
        self.movable = movable
        self.places = places
        self.middle = middle
        self.half = half
        self.diagonal = diagonal
        self.least_pivot = least_pivot
        self.given, self.error, self.configuration = given
        self.jacobian = jacobian
        self.step = step
        self.velocity = velocity
        self.normal = np.zeros((len(columns), len(columns)))
        self.column = np.zeros(len(columns))

    def solve(self, largest):
        """Whether a step up to `largest` in units is valid: finite, no small pivot, within joint limits. Then the error
        is in units.
        """
        normal = self.normal
        step = self.step
        used = self.jacobian
        columns = self.columns
        jacobian = self.given
        error = self.error
        m = self.row_units.shape[0]
        n = self.columns.shape[0]
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
        """Cholesky factor and solution; whether all pivots suffice."""
        normal = self.normal
        step = self.step
        column = self.column
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
        """Whether no entry is too large, and all joints stay within limits."""
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
        error = self.error
        largest = 0.0
        for r in range(self.row_units.shape[0]):
            value = math.fabs(error[r])
            if not value <= largest:
                largest = value
                if value != value:
                    break
        return largest

    def write(self):
        """Write the step, as found or changed, to the model's velocity."""
        for i in range(self.columns.shape[0]):
            self.velocity[self.columns[i]] = self.step[i] * self.column_units[self.columns[i]]


class Rows:
    """Error and Jacobian of a task."""

    def write(self):
        """Write both, into arrays that begin at zero.

        Returns whether the error is valid: a missing turn up to a quarter turn.
        """
        return True


class PointRows:
    """How a body's point moves: receives the velocity (3, nv) in `jacobian`."""

    def __init__(self, chain, motions, center, jacobian):
        self.chain = chain
        self.motions = motions
        self.center = center
        self.jacobian = jacobian

    def write(self, x, y, z):
        """Write the rows of the point (x, y, z)."""
        chain = self.chain
        motions = self.motions
        center = self.center
        out = self.jacobian
        x = x - center[0]
        y = y - center[1]
        z = z - center[2]
        for k in range(chain.shape[0]):
            i = chain[k]
            out[0, i] = motions[i, 3] + (motions[i, 1] * z - motions[i, 2] * y)
            out[1, i] = motions[i, 4] + (motions[i, 2] * x - motions[i, 0] * z)
            out[2, i] = motions[i, 5] + (motions[i, 0] * y - motions[i, 1] * x)


class TurnRows(Rows):
    """Body's missing turn (3,) from `actual` to `wanted` (3, 3), and its angular velocity (3, nv), in world."""

    def __init__(self, chain, motions, wanted, actual, error, jacobian):
        self.chain = chain
        self.motions = motions
        self.wanted = wanted
        self.actual = actual
        self.error = error
        self.jacobian = jacobian

    def write(self):
        """See `Rows`."""
        chain = self.chain
        motions = self.motions
        out = self.jacobian
        for k in range(chain.shape[0]):
            i = chain[k]
            for j in range(3):
                out[j, i] = motions[i, j]
        return rotations.missing_turn(self.wanted, self.actual, self.error)


class PoseRows(Rows):
    """Pose of a frame on a body: missing way (3,) and turn (3,) in world, and Jacobian (6, nv).

    `position`: desired origin (3,); `at` the current one; `rotation`: desired rotation (3, 3) to world; `turned` the
    current one.
    """

    def __init__(self, chain, motions, center, position, rotation, at, turned, error, jacobian):
        self.position = position
        self.at = at
        self.error = error
        self.point = PointRows(chain, motions, center, jacobian[:3])
        self.turn = TurnRows(chain, motions, rotation, turned, error[3:], jacobian[3:])

    def write(self):
        """See `Rows`."""
        at = self.at
        for i in range(3):
            self.error[i] = self.position[i] - at[i]
        self.point.write(at[0], at[1], at[2])
        return self.turn.write()


class ComRows(Rows):
    """Bodies' CoM `com` (3,) at a `target` (3,): missing way (3,) and Jacobian (3, nv).

    `chains`: velocities that move each of b bodies, in turn, up to its `ends` (b,); `masses`: mass (b,) of each body;
    `share` one over their sum; `centers`: centers (t, 3) of trees; `trees` (b,) that of each body; `places`: CoM (b, 3)
    of each body.
    """

    def __init__(self, chains, ends, masses, share, motions, centers, trees, places, target, com, error, jacobian):
        self.chains = chains
        self.ends = ends
        self.masses = masses
        self.share = share
        self.motions = motions
        self.centers = centers
        self.trees = trees
        self.places = places
        self.target = target
        self.com = com
        self.error = error
        self.jacobian = jacobian

    def write(self):
        """See `Rows`."""
        chains = self.chains
        motions = self.motions
        centers = self.centers
        places = self.places
        out = self.jacobian
        for j in range(3):
            self.error[j] = self.target[j] - self.com[j]
            for i in range(out.shape[1]):
                out[j, i] = 0.0
        begin = 0
        for b in range(self.ends.shape[0]):
            mass = self.masses[b]
            t = self.trees[b]
            x = places[b, 0] - centers[t, 0]
            y = places[b, 1] - centers[t, 1]
            z = places[b, 2] - centers[t, 2]
            for k in range(begin, self.ends[b]):
                i = chains[k]
                out[0, i] += (motions[i, 3] + (motions[i, 1] * z - motions[i, 2] * y)) * mass
                out[1, i] += (motions[i, 4] + (motions[i, 2] * x - motions[i, 0] * z)) * mass
                out[2, i] += (motions[i, 5] + (motions[i, 0] * y - motions[i, 1] * x)) * mass
            begin = self.ends[b]
        for j in range(3):
            for i in range(out.shape[1]):
                out[j, i] *= self.share
        return True


_LEAST = 1e-15  # length that counts as none, and what a quaternion's may differ from 1


class Configuration:
    """Configuration (nq,) and its velocity (nv,).

    `ways`: indices (w,) in configuration that velocities `speeds` (w,) add to; `turns`: where each quaternion begins
    (t,), w first; `rates` (t,) its angular velocity, in body's frame.
    """

    def __init__(self, ways, speeds, turns, rates, configuration, velocity):
        self.ways = ways
        self.speeds = speeds
        self.turns = turns
        self.rates = rates
        self.configuration = configuration
        self.velocity = velocity

    def move(self):
        """Integrate the velocity over one unit of time."""
        for k in range(self.ways.shape[0]):
            self.configuration[self.ways[k]] += self.velocity[self.speeds[k]]
        for k in range(self.turns.shape[0]):
            self._turn(self.turns[k], self.rates[k])

    def _turn(self, place, rate):
        q = self.configuration
        velocity = self.velocity
        w = q[place]
        x = q[place + 1]
        y = q[place + 2]
        z = q[place + 3]
        length = math.sqrt((w * w + x * x) + (y * y + z * z))
        if length < _LEAST:
            w = 1.0
            x = 0.0
            y = 0.0
            z = 0.0
        elif math.fabs(length - 1.0) > _LEAST:
            share = 1.0 / length
            w = share * w
            x = share * x
            y = share * y
            z = share * z
        i = velocity[rate]
        j = velocity[rate + 1]
        k = velocity[rate + 2]
        angle = math.sqrt(i * i + j * j + k * k)
        if angle < _LEAST:
            i = 1.0
            j = 0.0
            k = 0.0
        else:
            share = 1.0 / angle
            i = share * i
            j = share * j
            k = share * k
        cosine = math.cos(0.5 * angle)
        sine = math.sin(0.5 * angle)
        i = sine * i
        j = sine * j
        k = sine * k
        q[place] = (w * cosine - x * i) - (y * j + z * k)
        q[place + 1] = (w * i + x * cosine) + (y * k - z * j)
        q[place + 2] = (w * j - x * k) + (y * cosine + z * i)
        q[place + 3] = (w * k + x * j) - (y * i - z * cosine)


class TaskStep:
    """Takes a step in the plain case.

    `rows`: tasks' `task_rows.Rows`, a list. Attributes `near`: whether rows held all errors at the last step.
    """

    def __init__(self, rows, newton, configuration):
        self.rows = rows
        self.newton = newton
        self.configuration = configuration
        self.near = True

    def step(self, largest):
        """Write the rows; step at most `largest` in units if they hold all errors."""
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
