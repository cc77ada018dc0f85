"""Torques as printed in T: added (T 3.6), or in higher tasks' null space (T 3.3-3.4, 3.7-3.13).

For comparison and force tasks: higher tasks do not correct accelerations (A 21). Otherwise use `fusion.hierarchy`.
"""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack, solve_triangular

from plantar.errors import InputError
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.hierarchy import RANK, Fused, joint_torques
from plantar.wholebody.tasks.task import Demand

Projection = Literal["recursive", "augmented", "successive"]
"""How higher tasks count: projected one after another, all rows at once (T 3.9-3.10), or only the last (T 3.7)."""


def mass_factor(mass_matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lower Cholesky factor L (n, n) of a mass matrix, M = L L^T."""
    factor, info = lapack.dpotrf(mass_matrix, lower=1, clean=1)
    if info != 0:
        raise InputError("the mass matrix is not positive definite: a model needs mass or armature at every joint")
    return np.asarray(factor)


def task_torque(robot: RobotDynamics, demand: Demand) -> NDArray[np.float64]:
    """Returns the generalized force (n,) of a task's `demand` of a `robot`: J^T f (T 3.4), f = Lambda (x''* - J' q')
    for motion, without bias.
    """
    if demand.acceleration is None:
        return np.asarray(demand.jacobian.T @ np.asarray(demand.force))
    factor = mass_factor(robot.mass_matrix)
    rows = solve_triangular(factor, demand.jacobian.T, lower=True).T
    drift = 0.0 if demand.drift is None else demand.drift
    return np.asarray(factor @ (np.linalg.pinv(rows, rcond=RANK) @ (demand.acceleration - drift)))


def null_space_projector(
    jacobian: NDArray[np.float64], factor: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """N = I - J^T (J^#)^T (T 3.7): generalized force without effect on a task.

    With M = L L^T, J's dynamically consistent inverse (A 25) is L^-T times the pseudo-inverse of J L^-T, also at
    singularities.

    `jacobian`: task's J (m, n); `factor`: L (n, n), for the dynamically consistent inverse; None for Moore-Penrose.
    Returns (n, n) of generalized forces.
    """
    rows = jacobian if factor is None else solve_triangular(factor, jacobian.T, lower=True).T
    size = jacobian.shape[1]
    plain = np.eye(size) - np.linalg.pinv(rows, rcond=RANK) @ rows
    if factor is None:
        return np.asarray(plain)
    return np.asarray(solve_triangular(factor, (factor @ plain).T, lower=True, trans=1).T)


def null_space_torques(
    robot: RobotDynamics,
    levels: Sequence[Sequence[Demand | None]],
    support: Demand | None = None,
    external: NDArray[np.float64] | None = None,
    projection: Projection = "recursive",
    consistent: bool = True,
) -> Fused:
    """Sum of task torques, each in higher ones' null space (T 3.8, 3.11, 3.13).

    `robot`, `levels`, `support` and `external` as in `plantar.wholebody.fusion.hierarchy.fuse`; returns the same.

    `consistent`: whether dynamically consistent; if not, lower tasks push higher ones.
    """
    size = len(robot.bias)
    factor = mass_factor(robot.mass_matrix)
    weighting = factor if consistent else None
    through = np.eye(size)
    above = np.zeros((0, size))
    force = np.zeros(size)
    for level in [[support], *levels]:
        asked = [d for d in level if d is not None]
        if not asked:
            continue
        force += through @ np.sum([task_torque(robot, d) for d in asked], axis=0)
        rows = np.vstack([d.jacobian for d in asked])
        if projection == "recursive":
            through = through @ null_space_projector(rows @ through.T, weighting)
        elif projection == "augmented":
            above = np.vstack([above, rows])
            through = null_space_projector(above, weighting)
        else:
            through = through @ null_space_projector(rows, weighting)
    return _fused(robot, force, support, external)


def weighted_sum(
    robot: RobotDynamics,
    levels: Sequence[Sequence[Demand | None]],
    support: Demand | None = None,
    external: NDArray[np.float64] | None = None,
    weights: Sequence[float | NDArray[np.float64]] | None = None,
) -> Fused:
    """tau = sum W_i tau_i (T 3.6): tasks disturb each other, below the support (T 3.13).

    `robot`, `levels`, `support` and `external` as in `plantar.wholebody.fusion.hierarchy.fuse`; returns the same.

    `weights`: each level's: a number or (n,); None for 1.
    """
    weights = [1.0] * len(levels) if weights is None else weights
    if len(weights) != len(levels):
        raise InputError(f"there are {len(weights)} weights for {len(levels)} levels; expected one for each")
    total = np.zeros_like(robot.bias)
    for weight, level in zip(weights, levels, strict=True):
        for demand in level:
            if demand is not None:
                total += weight * task_torque(robot, demand)
    if support is not None:
        factor = mass_factor(robot.mass_matrix)
        total = task_torque(robot, support) + null_space_projector(support.jacobian, factor) @ total
    return _fused(robot, total, support, external)


def _fused(
    robot: RobotDynamics, force: NDArray[np.float64], support: Demand | None, external: NDArray[np.float64] | None
) -> Fused:
    # Result of a generalized force (n,) without bias.
    acceleration = np.asarray(np.linalg.solve(robot.mass_matrix, force))
    total = force + robot.bias if external is None else force + robot.bias - external
    torque, support_force = joint_torques(robot, total, support)
    return Fused(torque, acceleration, support_force)
