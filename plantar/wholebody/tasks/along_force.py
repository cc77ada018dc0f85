"""A task of forces that takes no more of the motion than the direction in which it pushes (T 3.29, 3.41)."""

from __future__ import annotations

import numpy as np

from plantar.sensing.link_skin import SkinReading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task

__all__ = ["AlongForce"]


class AlongForce(Task):
    """Lets the wrenches of another task act as before, with one row a link in place of six: what is below may slide.

    With all six rows of a link owned by what it sees, a robot may not even go along it.

    Args:
        task: The task, whose demand holds six rows for each link.
        damping: Force in N for each m/s of the motion along the push, whichever way it goes.
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
