"""Keeps joints off their range's ends by repulsive fields."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class JointRange(Task):
    """Pushes back joints near an end of their range, one row each.

    `low`: lower ends (k,) in rad or m, in order of `RobotDynamics.joints`; -inf for none; `high`: upper ends (k,);
    `margin`: distance to an end in rad or m where pushing begins; `stiffness`: torque in N m per rad of used margin,
    one or (k,); `damping`: torque in N m per rad/s towards the end, one or (k,).
    """

    def __init__(
        self, low: ArrayLike, high: ArrayLike, margin: float, stiffness: ArrayLike, damping: ArrayLike = 0.0
    ) -> None:
        self.low = np.asarray(low, dtype=float) + margin
        self.high = np.asarray(high, dtype=float) - margin
        self.stiffness = np.broadcast_to(np.asarray(stiffness, dtype=float), self.low.shape)
        self.damping = np.broadcast_to(np.asarray(damping, dtype=float), self.low.shape)
        self._rows: NDArray[np.float64] | None = None

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        positions = robot.joint_positions
        used = np.maximum(self.low - positions, 0.0) - np.maximum(positions - self.high, 0.0)
        near = np.flatnonzero(used)
        if not len(near):
            return None
        if self._rows is None:
            self._rows = np.eye(len(robot.velocity))[robot.joints]
        speed = robot.velocity[robot.joints][near]
        closing = np.where(speed * used[near] < 0.0, speed, 0.0)
        return Demand(self._rows[near], force=self.stiffness[near] * used[near] - self.damping[near] * closing)
