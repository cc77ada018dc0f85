"""Joint posture, for the remaining freedom (T 3.2.5.1, A 18)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


class Posture(Task):
    """Draws joints to a posture: accelerations q''* = K (q_d - q) + D (q'_d - q'), or such torques (A 18).

    Args:
        target: Wanted (k,) in rad or m, `RobotDynamics.joints` order.
        stiffness: K, one or (k,): in 1/s^2, with `torques` in N m/rad.
        damping: D likewise; None for critical, of accelerations.
        joints: Held ones' indices; None for all.
        torques: Whether it asks for torques, which add in its level.

    Attributes:
        target_velocity: Wanted q'_d (k,) in rad/s or m/s, 0 at first.
    """

    def __init__(
        self,
        target: ArrayLike,
        stiffness: ArrayLike = 50.0,
        damping: ArrayLike | None = None,
        joints: Sequence[int] | None = None,
        torques: bool = False,
    ) -> None:
        self.target = np.asarray(target, dtype=float)
        self.target_velocity = np.zeros(len(self.target))
        self.stiffness = np.asarray(stiffness, dtype=float)
        self.damping = 2.0 * np.sqrt(self.stiffness) if damping is None else np.asarray(damping, dtype=float)
        self.torques = torques
        self._held = np.arange(len(self.target)) if joints is None else np.asarray(joints)
        self._rows: NDArray[np.float64] | None = None

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        held = robot.joints[self._held]
        if self._rows is None:
            self._rows = np.eye(len(robot.velocity))[held]
        pull = self.stiffness * (self.target - robot.joint_positions) + self.damping * (
            self.target_velocity - robot.velocity[robot.joints]
        )
        asked = pull[self._held]
        return Demand(self._rows, force=asked) if self.torques else Demand(self._rows, acceleration=asked)


class BodyCompliance(Task):
    """tau_c = K (q_d - q) - D q' + tau_skin + tau_oca (A 18 corrected: yields to pushes).

    `yields`: force tasks: `DirectInteraction` for A 14, `BaseAvoidance` for A 15.
    """

    def __init__(self, posture: Posture, *yields: Task) -> None:
        self.posture = posture
        self.yields = yields

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        torque = np.zeros(len(robot.velocity))
        for task in (self.posture, *self.yields):
            asked = task.demand(robot, skin)
            if asked is not None and asked.force is not None:
                torque += asked.jacobian.T @ asked.force
        return Demand(np.eye(len(torque)), force=torque)
