"""Given force at a point (T 3.4, 3.29)."""

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class PointForce(Task):
    """Applies a force: tau = J_p^T f (T 3.29).

    `point` (3,), link frame, in m. Attributes `force` (3,), world frame, in N; None or 0 for no demand.
    """

    def __init__(self, link: str, point: NDArray[np.float64]) -> None:
        self.link = link
        self.point = np.asarray(point, dtype=float)
        self.force: NDArray[np.float64] | None = None

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        if self.force is None or not self.force.any():
            return None
        return Demand(robot.jacobian(self.link, self.point)[:3], force=self.force)


class AlongForce(Task):
    """Another task's wrenches with one row a link, not six, so that lower tasks can slide along.

    `damping`: force in N per m/s along the push, either way.
    """

    def __init__(self, task: Task, damping: float = 0.0) -> None:
        self.task = task
        self.damping = damping

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        asked = self.task.demand(robot, skin)
        if asked is None or asked.force is None:
            return asked
        wrenches = asked.force.reshape(-1, 6)
        sizes = np.sqrt(np.einsum("ij,ij->i", wrenches[:, :3], wrenches[:, :3]))
        pushing = sizes > 0.0
        if not pushing.any():
            return None
        wrenches = wrenches[pushing]
        sizes = sizes[pushing]
        links = asked.jacobian.reshape(-1, 6, asked.jacobian.shape[1])[pushing]
        rows = np.einsum("ij,ijk->ik", wrenches / sizes[:, None], links)
        return Demand(rows, force=sizes - self.damping * (rows @ robot.velocity))
