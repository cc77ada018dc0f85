"""What every task is: a Jacobian, and the force or the acceleration that is asked for along its rows."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from wholebody.dynamics import RobotDynamics
from wholebody.skin.reading import SkinReading

__all__ = ["Demand", "Task", "link_rows"]


class Demand(NamedTuple):
    """What a task asks for at one instant. It gives a force, or an acceleration with its drift.

    Attributes:
        jacobian: J (m, n) of the task (T 3.2, A 2).
        force: Force f (m,) along its rows, which acts as tau = J^T f (T 3.4), in N, N m.
        acceleration: Reference acceleration x''* (m,) (A 4-5), in m/s^2, rad/s^2.
        drift: J' q' (m,) of A 3; counts with an acceleration only.
    """

    jacobian: NDArray[np.float64]
    force: NDArray[np.float64] | None = None
    acceleration: NDArray[np.float64] | None = None
    drift: NDArray[np.float64] | None = None


class Task(Protocol):
    """A task. A new one is one new file with one class."""

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        """What it asks for now; None while it has nothing to say, and then nothing is computed for it (T 3.24).

        Args:
            robot: Kinematics and dynamics of this instant.
            skin: The latest reading; None for a robot without skin.
        """


def link_rows(
    robot: RobotDynamics, links: list[tuple[str, NDArray[np.float64]]]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stack the Jacobians of links and turn wrenches in their frames to the world (T 3.20-3.22).

    Args:
        robot: The robot.
        links: Name of each link, and the wrench (6,) about its origin in its frame.

    Returns:
        Jacobian (6 k, n) and wrenches (6 k,) in the world frame, each about its link's origin.
    """
    rows, forces = [], []
    for link, wrench in links:
        rotation = robot.pose(link)[1]
        rows.append(robot.jacobian(link))
        forces += [rotation @ wrench[:3], rotation @ wrench[3:]]
    return np.vstack(rows), np.concatenate(forces)
