"""Tasks in strict order, dynamically consistent: A 19-25 and, with a support, T 3.13.

The projectors of A 22-25 are products of large matrices that lose their digits near singularities. In mass-weighted
coordinates y = L^T q'', M = L L^T, the dynamically consistent inverse (A 25) is the plain pseudo-inverse and the
projector (A 24) an orthogonal one, so the same torques follow from one QR decomposition a level: what a level owns is
an orthonormal basis, and what is below acts in the rest of it, to rounding.

Near a singularity the two things that are wanted of a task part: a direction with a singular value above `RANK` of its
rows' size stays its own, so that priority is strict; and below `DAMPED` of that size it is driven by
s / (s^2 + lambda^2), lambda^2 = (1 - (s / s_0)^2) s_0^2 / 4, so that torques stay bounded and continuous.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from plantar.errors import InputError
from wholebody.dynamics import RobotDynamics
from wholebody.tasks.task import Demand

__all__ = ["DAMPED", "RANK", "Fused", "fuse", "joint_torques", "mass_factor"]

RANK = 1e-11
"""Share of its rows' size below which a direction is none of a task's: some orders above rounding."""

DAMPED = 1e-2
"""Share of its smallest row's size below which a direction is damped: an elbow within some 0.6 degrees of straight."""


class Fused(NamedTuple):
    """What fused tasks come to.

    Attributes:
        torque: Torque or force (k,) of each joint of `RobotDynamics.joints` in N m or N, gravity included.
        acceleration: The generalized acceleration (n,) that it gives while nothing else pushes.
        support_force: Force (s,) along the rows of the support that this takes; None without one.
    """

    torque: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    support_force: NDArray[np.float64] | None


def fuse(
    robot: RobotDynamics,
    levels: Sequence[Sequence[Demand | None]],
    support: Demand | None = None,
    external: NDArray[np.float64] | None = None,
) -> Fused:
    """Torques that meet every level as well as the levels above it leave room for (A 19-25, T 3.8, 3.13).

    Within a level accelerations are met first, all together; forces add up and act in what these leave (T 3.22).

    Args:
        robot: Kinematics and dynamics of this instant.
        levels: What the tasks ask for, the highest priority first. None stands for a task that is silent; it and a
            level without any other cost nothing.
        support: Rows on which the robot stands, above all levels; a robot whose base is not driven needs them.
        external: Generalized force (n,) that is known to act, such as J^T w of what the skin feels; taken out of what
            the joints and the support have to do.

    Returns:
        Torques, acceleration and support force.

    Raises:
        InputError: If a demand has neither force nor acceleration, or rows of another length.
    """
    space = _Space(mass_factor(robot.mass_matrix))
    every = [[d for d in level if d is not None] for level in ([support], *levels)]
    asked = [level for level in every if level]
    for level in asked:
        space.add(level, last=level is asked[-1])
    acceleration = space.acceleration()
    force = robot.mass_matrix @ acceleration + robot.bias
    if external is not None:
        force -= external
    torque, support_force = joint_torques(robot, force, support)
    return Fused(torque, acceleration, support_force)


def mass_factor(mass_matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cholesky factor L (n, n) of a mass matrix, lower, in Fortran order.

    Raises:
        InputError: If the matrix is not positive definite.
    """
    factor, info = lapack.dpotrf(mass_matrix, lower=1, clean=1)
    if info != 0:
        raise InputError("the mass matrix is not positive definite: a model needs mass or armature at every joint")
    return np.asarray(factor)


def joint_torques(
    robot: RobotDynamics, force: NDArray[np.float64], support: Demand | None
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Split a generalized force among joints and support: S^T tau + J_s^T f_s (T 3.12).

    The support takes what acts on coordinates that no joint drives, with the least force.

    Args:
        robot: The robot.
        force: Generalized force (n,).
        support: Rows on which it stands; None for a robot all of whose coordinates are driven.

    Returns:
        Joint torques (k,) and support force (s,) or None.

    Raises:
        InputError: If coordinates are not driven and nothing supports them.
    """
    joints = robot.joints
    if support is None:
        if len(joints) < len(force):
            raise InputError("the robot's base is not driven: its stack needs a support")
        return force[joints], None
    free = np.ones(len(force), dtype=bool)
    free[joints] = False
    rows = support.jacobian
    if not free.any():
        return force[joints], None
    least = np.linalg.lstsq(rows[:, free].T, force[free], rcond=None)[0]
    return np.asarray(force[joints] - rows[:, joints].T @ least), np.asarray(least)


class _Space:
    """Directions of mass-weighted acceleration: what is owned by the levels so far, and what is left.

    Attributes:
        y: Acceleration (n,) in the basis of the owned directions, these first.
        used: How many are owned.
    """

    def __init__(self, factor: NDArray[np.float64]) -> None:
        self.y = np.zeros(len(factor))
        self.used = 0
        self._factor = factor
        self._turns: list[tuple[int, NDArray[np.float64], NDArray[np.float64], int]] = []

    def add(self, level: Sequence[Demand], last: bool) -> None:
        """Meet a level in what is left, and own its rows unless nothing comes after it."""
        meant = [d for d in level if d.acceleration is not None]
        pushing = [d for d in level if d.acceleration is None]
        if meant and self.used < len(self.y):
            wanted = [a if d.drift is None else a - d.drift for d in meant if (a := d.acceleration) is not None]
            self._own([d.jacobian for d in meant], np.concatenate(wanted))
        if pushing:
            torque = np.zeros(len(self.y))
            for demand in pushing:
                if demand.force is None:
                    raise InputError("a task asks for neither a force nor an acceleration")
                torque += demand.jacobian.T @ demand.force
            self.y[self.used :] += self._turned(torque[:, None])[self.used :, 0]
            if not last and self.used < len(self.y):
                self._own([d.jacobian for d in pushing], None)

    def acceleration(self) -> NDArray[np.float64]:
        """The generalized acceleration (n,) that y stands for."""
        back = self.y[:, None].copy(order="F")
        for first, reflectors, factors, _ in reversed(self._turns):
            back[first:] = _times(reflectors, factors, back[first:], "N")
        return np.asarray(lapack.dtrtrs(self._factor, back, lower=1, trans=1)[0][:, 0])

    def _turned(self, columns: NDArray[np.float64]) -> NDArray[np.float64]:
        """Columns J^T (n, m) as mass-weighted rows in the basis of the owned directions."""
        found = lapack.dtrtrs(self._factor, columns, lower=1)[0]
        for first, reflectors, factors, _ in self._turns:
            found[first:] = _times(reflectors, factors, found[first:], "T")
        return np.asarray(found)

    def _own(self, jacobians: list[NDArray[np.float64]], wanted: NDArray[np.float64] | None) -> None:
        """Take the rows' directions out of what is left; where an acceleration is wanted, meet it in them."""
        rows = jacobians[0] if len(jacobians) == 1 else np.vstack(jacobians)
        columns = self._turned(rows.T)
        sizes = np.sqrt(np.einsum("ij,ij->j", columns, columns))
        counted = sizes > RANK * sizes.max()
        if not counted.any():
            return
        missing = None if wanted is None else wanted - columns.T @ self.y
        sizes = np.where(counted, sizes, np.inf)
        first = self.used
        factored, order, factors, _, _ = lapack.dgeqp3(columns[first:] / sizes)
        rank = int(np.count_nonzero(np.abs(np.diagonal(factored)) > RANK))
        if rank == 0:
            return
        reflectors, factors = factored[:, :rank], factors[:rank]
        self._turns.append((first, reflectors, factors, rank))
        self.y[first:] = _times(reflectors, factors, self.y[first:, None], "T")[:, 0]
        if missing is not None:
            order -= 1
            upper = np.triu(factored[:rank])[:, counted[order]] * sizes[order][counted[order]]
            self.y[first : first + rank] += _met(upper, missing[order][counted[order]], DAMPED * sizes.min())
        self.used = first + rank


def _times(
    reflectors: NDArray[np.float64], factors: NDArray[np.float64], columns: NDArray[np.float64], which: str
) -> NDArray[np.float64]:
    """Q or its transpose times columns, Q of Householder vectors."""
    return np.asarray(lapack.dormqr("L", which, reflectors, factors, columns, max(64, 32 * columns.shape[1]))[0])


def _met(upper: NDArray[np.float64], wanted: NDArray[np.float64], damped: float) -> NDArray[np.float64]:
    """w with R^T w = wanted for R (rank, m); directions below `damped` are filtered as this module's head says."""
    rank, count = upper.shape
    if rank == count and np.abs(np.diagonal(upper)).min() > 4.0 * count * damped:
        return np.asarray(lapack.dtrtrs(upper, wanted, lower=0, trans=1)[0])
    left, sizes, right = np.linalg.svd(upper, full_matrices=False)
    short = np.maximum(0.0, 1.0 - (sizes / damped) ** 2) * (damped / 2.0) ** 2
    return np.asarray(left @ (sizes / (sizes**2 + short) * (right @ wanted)))
