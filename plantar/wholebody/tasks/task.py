"""Interface of tasks: Jacobian, and force or acceleration along it."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import LinkWrench
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics


class Demand(NamedTuple):
    """A task's demand now: a force, or an acceleration with drift.

    Attributes:
        jacobian: Task's J (m, n) (T 3.2, A 2).
        force: f (m,) along its rows, tau = J^T f (T 3.4), in N, N m.
        acceleration: Reference x''* (m,) (A 4-5), in m/s^2, rad/s^2.
        drift: J' q' (m,) of A 3, with acceleration.
    """

    jacobian: NDArray[np.float64]
    force: NDArray[np.float64] | None = None
    acceleration: NDArray[np.float64] | None = None
    drift: NDArray[np.float64] | None = None


class Task(Protocol):
    """A task; new ones are one file, one class."""

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        """Current demand; None saves its computation (T 3.24).

        Args:
            robot: Its dynamics now.
            skin: Latest reading; None without skin.

        Returns:
            The demand.
        """


def wrench_demand(robot: RobotDynamics, wrenches: Sequence[LinkWrench]) -> Demand | None:
    """Apply wrenches to links: tau = J^T E w, all rows in one demand (T 3.20-3.22, 3.24).

    Returns world frame, about each link's origin.
    """
    if not wrenches:
        return None
    rows = []
    forces = []
    for link, wrench, _ in wrenches:
        rotation = robot.pose(link)[1]
        rows.append(robot.jacobian(link))
        forces += [rotation @ wrench[:3], rotation @ wrench[3:]]
    return Demand(rows[0] if len(rows) == 1 else np.vstack(rows), force=np.concatenate(forces))
