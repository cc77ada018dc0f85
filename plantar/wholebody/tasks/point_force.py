"""A given force at a point of the robot (T 3.4, 3.29)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinReading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task

__all__ = ["AlongForce", "PointForce"]


class PointForce(Task):
    """Applies a force: tau = J_p^T f (T 3.29).

    Args:
        link: Link on which it acts.
        point: Point (3,) in the link's frame in m.

    Attributes:
        force: The force (3,) in the world frame in N; no demand while None or 0.
    """

    def __init__(self, link: str, point: NDArray[np.float64]) -> None:
        self.link, self.point = link, np.asarray(point, dtype=float)
        self.force: NDArray[np.float64] | None = None

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if self.force is None or not self.force.any():
            return None
        return Demand(robot.jacobian(self.link, self.point)[:3], force=self.force)


class AlongForce(Task):
    """Applies the wrenches of another task with one row a link in place of six, so that lower tasks may slide along.

    Args:
        task: The task, whose demand holds six rows for each link.
        damping: Force in N for each m/s of the motion along the push, either way.
    """

    def __init__(self, task: Task, damping: float = 0.0) -> None:
        self.task, self.damping = task, damping

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        asked = self.task.demand(robot, skin)
        if asked is None or asked.force is None:
            return asked
        wrenches = asked.force.reshape(-1, 6)
        sizes = np.sqrt(np.einsum("ij,ij->i", wrenches[:, :3], wrenches[:, :3]))
        pushing = sizes > 0.0
        if not pushing.any():
            return None
        wrenches, sizes = wrenches[pushing], sizes[pushing]
        links = asked.jacobian.reshape(-1, 6, asked.jacobian.shape[1])[pushing]
        rows = np.einsum("ij,ijk->ik", wrenches / sizes[:, None], links)
        return Demand(rows, force=sizes - self.damping * (rows @ robot.velocity))
