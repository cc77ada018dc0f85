"""Strictly ordered, dynamically consistent tasks: A 19-25 and, with support, T 3.13.

With y = L^T q'', M = L L^T, the dynamically consistent inverse (A 25) is the pseudo-inverse and the projector (A 24)
orthogonal: one QR decomposition a level, accurate near singularities.

A direction with singular value above `RANK` of its rows' size belongs to its level, for strict priority; below `DAMPED`
it is driven by s / (s^2 + lambda^2), lambda^2 = (1 - (s / s_0)^2) s_0^2 / 4, for bounded, continuous torques.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from plantar.errors import InputError
from plantar.kernels.joints.task_space import TaskSpace
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand

RANK = 1e-11
"""Share of its rows' size below which a direction is none of a task's: some orders above rounding."""

DAMPED = 1e-2
"""Share of a row's full size below which a direction is damped: an elbow within some 0.6 degrees of straight.

A row's full size is what it would have if its row of the Jacobian were as long as the longest of its level: the row
itself may vanish at a singularity, such as that of the direction in which an arm is stretched.
"""


class Fused(NamedTuple):
    """Result of fused tasks.

    `torque` (k,) of `RobotDynamics.joints` in N m or N, with gravity; `acceleration`: generalized (n,) without other
    pushes; `support_force` (s,) along the support's rows, or None.
    """

    torque: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    support_force: NDArray[np.float64] | None


Split = Callable[
    [RobotDynamics, NDArray[np.float64], Demand | None], tuple[NDArray[np.float64], NDArray[np.float64] | None]
]
"""A way to share a generalized force (n,) among joints and support, such as `joint_torques`."""


def fuse(
    robot: RobotDynamics,
    levels: Sequence[Sequence[Demand | None]],
    support: Demand | None = None,
    external: NDArray[np.float64] | None = None,
    split: Split | None = None,
) -> Fused:
    """Torques for every level as higher ones allow (A 19-25, T 3.8, 3.13).

    Within a level accelerations are met first, together; forces add up in the rest (T 3.22).

    `levels`: tasks' demands, highest priority first; None for none; `support`: support rows above all levels; needed
    for an undriven base; `external`: known generalized force (n,), such as skin's J^T w; `split`: load sharing of
    joints and support; None for `joint_torques`.
    """
    every = [[d for d in level if d is not None] for level in ([support], *levels)]
    asked = [level for level in every if level]
    mass = robot.mass_matrix
    space = _space(len(mass))
    if not space.begin(mass):
        raise InputError("the mass matrix is not positive definite: a model needs mass or armature at every joint")
    for level in asked:
        _add(space, level, last=level is asked[-1])
    acceleration = np.empty(space.size)
    space.acceleration(acceleration)
    force = mass.dot(acceleration) + robot.bias
    if external is not None:
        force -= external
    torque, support_force = (split or joint_torques)(robot, force, support)
    return Fused(torque, acceleration, support_force)


def joint_torques(
    robot: RobotDynamics, force: NDArray[np.float64], support: Demand | None
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Split a generalized force: S^T tau + J_s^T f_s (T 3.12), with least support force.

    `force`: generalized (n,); `support`: its rows; None if all coordinates are driven. Returns joint torques (k,) and
    support force (s,) or None.
    """
    joints = robot.joints
    if support is None:
        if len(joints) < len(force):
            raise InputError("the robot's base is not driven: its stack needs a support")
        return force[joints], None
    base = len(force) - len(joints)
    if base == 0:
        return force[joints], None
    rows = support.jacobian
    if joints[0] == base:  # those that no joint drives come first
        carried = rows[:, :base]
        driven = rows[:, base:]
        undriven = force[:base]
        torque = force[base:]
    else:
        free = np.delete(np.arange(len(force)), joints)
        carried = rows[:, free]
        driven = rows[:, joints]
        undriven = force[free]
        torque = force[joints]
    least = _least_norm(carried.T, undriven)
    return np.asarray(torque - least.dot(driven)), least


def _least_norm(matrix: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    # Shortest x with matrix x = wanted, or nearest, by QR or singular values.
    rows, columns = matrix.shape
    if rows <= columns:
        factored, scales, _, info = lapack.dgeqrf(matrix.T)
        upper = factored[:rows]
        ends = np.abs(upper.diagonal())
        if info == 0 and ends.min() > 1e-6 * ends.max():
            found = np.zeros((columns, 1))
            found[:rows, 0] = lapack.dtrtrs(upper, wanted, lower=0, trans=1)[0]
            return np.asarray(lapack.dormqr("L", "N", factored, scales, found, 64)[0][:, 0])
    return np.asarray(np.linalg.lstsq(matrix, wanted, rcond=None)[0])


def _add(space: TaskSpace, level: Sequence[Demand], last: bool) -> None:
    # Meet a level in free directions, owning its rows unless last.
    meant = [d for d in level if d.acceleration is not None]
    pushing = [d for d in level if d.acceleration is None]
    if meant and space.used < space.size:
        wanted = [a if d.drift is None else a - d.drift for d in meant if (a := d.acceleration) is not None]
        _meet(space, _stacked(meant, space.size), wanted[0] if len(wanted) == 1 else np.concatenate(wanted))
    if pushing:
        torque = np.zeros(space.size)
        for demand in pushing:
            if demand.force is None:
                raise InputError("a task asks for neither a force nor an acceleration")
            torque += demand.force @ demand.jacobian
        space.push(torque)
        if not last and space.used < space.size:
            rows = _stacked(pushing, space.size)
            space.own(rows, rows[0], False, RANK)  # of what is wanted nothing is read


def _stacked(demands: Sequence[Demand], size: int) -> NDArray[np.float64]:
    rows = demands[0].jacobian if len(demands) == 1 else np.vstack([d.jacobian for d in demands])
    if rows.ndim != 2 or rows.shape[1] != size:
        raise InputError(f"a task's Jacobian has shape {rows.shape}; expected rows of {size}")
    return np.ascontiguousarray(rows)


def _meet(space: TaskSpace, rows: NDArray[np.float64], wanted: NDArray[np.float64]) -> None:
    # Own rows and meet their demand, damped below `DAMPED`.
    if wanted.shape != (len(rows),):
        raise InputError(f"a task asks for an acceleration of shape {wanted.shape}; expected one a row, ({len(rows)},)")
    rank, bound = space.own(rows, np.ascontiguousarray(wanted), True, RANK)
    count = len(rows)
    if rank == 0:
        return
    if bound > DAMPED:
        if rank == count:
            space.meet(rank)
        else:
            space.fit(rank, count, RANK)
        return
    sizes = np.asarray(space.sizes)[:count]
    counted = sizes > RANK * sizes.max()
    left = np.asarray(space.columns)[space.used - rank : space.used, :count].T[counted]
    missing = np.asarray(space.missing)[:count][counted]
    damped = DAMPED * float(np.asarray(space.full)[:count][counted].min())
    across, strengths, along = np.linalg.svd(left, full_matrices=False)
    short = np.maximum(0.0, 1.0 - (strengths / damped) ** 2) * (damped / 2.0) ** 2
    met = np.asarray(space.y)[space.used - rank : space.used]
    met += along.T @ (strengths / (strengths**2 + short) * (across.T @ missing))


@lru_cache(maxsize=8)
def _space(size: int) -> TaskSpace:
    # Work arrays for a number of coordinates, made once.
    return TaskSpace(size)
