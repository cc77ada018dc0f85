"""A force at a point of the robot that is given, not measured (T 3.4, 3.29)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinReading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task

__all__ = ["PointForce"]


class PointForce(Task):
    """Lets a force act: tau = J_p^T f (T 3.29).

    Args:
        link: Link on which it acts.
        point: Point (3,) in the link's frame in m.

    Attributes:
        force: The force (3,) in the world frame in N; silent while it is None or 0.
    """

    def __init__(self, link: str, point: NDArray[np.float64]) -> None:
        self.link, self.point = link, np.asarray(point, dtype=float)
        self.force: NDArray[np.float64] | None = None

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if self.force is None or not self.force.any():
            return None
        return Demand(robot.jacobian(self.link, self.point)[:3], force=self.force)
