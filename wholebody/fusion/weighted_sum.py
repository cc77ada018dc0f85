"""Torques of tasks added with weights (T 3.6): no priorities, every task disturbs every other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from wholebody.dynamics import RobotDynamics
from wholebody.fusion.hierarchy import Fused
from wholebody.fusion.null_space import as_fused, mass_factor, null_space_projector, task_torque
from wholebody.tasks.task import Demand

__all__ = ["weighted_sum"]


def weighted_sum(
    robot: RobotDynamics,
    levels: Sequence[Sequence[Demand | None]],
    support: Demand | None = None,
    external: NDArray[np.float64] | None = None,
    weights: Sequence[float | NDArray[np.float64]] | None = None,
) -> Fused:
    """tau = sum W_i tau_i (T 3.6); only a support stays above, for a robot cannot do without (T 3.13).

    Args:
        robot: Kinematics and dynamics of this instant.
        levels: What the tasks ask for; None stands for a task that is silent.
        support: Rows on which the robot stands.
        external: Generalized force (n,) that is known to act.
        weights: Weight of each level: a number, or one (n,) for each coordinate; 1 for all where None.

    Returns:
        Torques, acceleration and support force.

    Raises:
        InputError: If there are not as many weights as levels, or nothing supports a base that is not driven.
    """
    if weights is not None and len(weights) != len(levels):
        raise InputError(f"there are {len(weights)} weights for {len(levels)} levels; expected one for each")
    total = np.zeros_like(robot.bias)
    for i, level in enumerate(levels):
        weight = 1.0 if weights is None else weights[i]
        for demand in level:
            if demand is not None:
                total += weight * task_torque(robot, demand)
    if support is not None:
        factor = mass_factor(robot.mass_matrix)
        total = task_torque(robot, support) + null_space_projector(support.jacobian, factor) @ total
    return as_fused(robot, total, support, external)
