"""Compliance of the whole body in what is left to it: a posture, and what pulls the body out of it (A 13-14, 18)."""

from __future__ import annotations

import numpy as np

from plantar.sensing.link_skin import SkinReading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.task import Demand, Task

__all__ = ["BodyCompliance"]


class BodyCompliance(Task):
    """tau_c = K (q_d - q) - D q' + tau_skin + tau_oca (A 18 corrected: the body gives way to what pushes it).

    Args:
        posture: The posture, of torques.
        yields: Tasks that ask for forces: `DirectInteraction` for A 14, `BaseAvoidance` for A 15.
    """

    def __init__(self, posture: Posture, *yields: Task) -> None:
        self.posture, self.yields = posture, yields

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        torque = np.zeros(len(robot.velocity))
        for task in (self.posture, *self.yields):
            asked = task.demand(robot, skin)
            if asked is not None and asked.force is not None:
                torque += asked.jacobian.T @ asked.force
        return Demand(np.eye(len(torque)), force=torque)
