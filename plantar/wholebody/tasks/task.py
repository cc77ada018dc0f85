"""The interface of a task: a Jacobian, and the force or acceleration along its rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import LinkWrench, SkinReading
from plantar.wholebody.dynamics import RobotDynamics

__all__ = ["Demand", "Task", "wrench_demand"]


class Demand(NamedTuple):
    """A task's demand at one instant: a force, or an acceleration with its drift.

    Attributes:
        jacobian: J (m, n) of the task (T 3.2, A 2).
        force: Force f (m,) along its rows, which acts as tau = J^T f (T 3.4), in N, N m.
        acceleration: Reference acceleration x''* (m,) (A 4-5), in m/s^2, rad/s^2.
        drift: J' q' (m,) of A 3, with an acceleration.
    """

    jacobian: NDArray[np.float64]
    force: NDArray[np.float64] | None = None
    acceleration: NDArray[np.float64] | None = None
    drift: NDArray[np.float64] | None = None


class Task(Protocol):
    """A task. A new one is one new file with one class."""

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        """The current demand; None for none, which saves its computation (T 3.24).

        Args:
            robot: Kinematics and dynamics of this instant.
            skin: The latest reading; None for a robot without skin.

        Returns:
            The demand.
        """


def wrench_demand(robot: RobotDynamics, wrenches: Sequence[LinkWrench]) -> Demand | None:
    """Apply wrenches to links: tau = J^T E w, all links' rows in one demand (T 3.20-3.22, 3.24).

    Args:
        robot: The robot.
        wrenches: Wrench on each link; no demand without any.

    Returns:
        The demand, in the world frame about each link's origin.
    """
    if not wrenches:
        return None
    rows, forces = [], []
    for link, wrench, _ in wrenches:
        rotation = robot.pose(link)[1]
        rows.append(robot.jacobian(link))
        forces += [rotation @ wrench[:3], rotation @ wrench[3:]]
    return Demand(rows[0] if len(rows) == 1 else np.vstack(rows), force=np.concatenate(forces))
