"""A link's pose, position or orientation (T 3.39, 3.42-3.44, A 4)."""

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.mechanics.rotation import rotation_error
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task

_ROWS = {"pose": slice(0, 6), "position": slice(0, 3), "orientation": slice(3, 6)}


class PoseGains(Settings):
    """Gains of holding a pose; critical damping is d = 2 sqrt(k).

    Attributes:
        stiffness: K of A 4 for position, unit mass.
        damping: D of A 4 for position.
        turn_stiffness: K for orientation, unit inertia.
        turn_damping: D for orientation.
        speed: V_max of T 3.44 towards a far target.
    """

    stiffness: float = number(100.0, "1/s^2", 0, 1e6)
    damping: float = number(20.0, "1/s", 0, 1e4)
    turn_stiffness: float = number(100.0, "1/s^2", 0, 1e6)
    turn_damping: float = number(20.0, "1/s", 0, 1e4)
    speed: float = number(0.5, "m/s", 1e-3, 100)


class CartesianPose(Task):
    """Draws a link's point to its target at bounded speed: x''* = x''_d + K e + D (x'_d - x') (A 4, T 3.42-3.44).

    Args:
        point: (3,), link frame, in m; None for its origin.
        rows: Position, orientation or both.

    Attributes:
        target_position: Wanted (3,), world frame, in m; the first one until set.
        target_rotation: Wanted (3, 3) to the world; likewise.
        target_velocity: Wanted linear (3,) in m/s; `target_acceleration` in m/s^2.
    """

    def __init__(
        self,
        link: str,
        point: NDArray[np.float64] | None = None,
        gains: PoseGains | None = None,
        rows: Literal["pose", "position", "orientation"] = "pose",
    ) -> None:
        self.link = link
        self.point = point
        self.gains = gains or PoseGains()
        self.target_position: NDArray[np.float64] | None = None
        self.target_rotation: NDArray[np.float64] | None = None
        self.target_velocity = np.zeros(3)
        self.target_acceleration = np.zeros(3)
        self._rows = _ROWS[rows]

    def position_error(self, robot: RobotDynamics) -> NDArray[np.float64]:
        """To the target position (3,), world frame, in m; zeros without."""
        return np.zeros(3) if self.target_position is None else self.target_position - self._place(robot)[0]

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        position, rotation = self._place(robot)
        if self.target_position is None:
            self.target_position = position.copy()
        if self.target_rotation is None:
            self.target_rotation = rotation.copy()
        rows = self._rows
        gains = self.gains
        jacobian = robot.jacobian(self.link, self.point)
        moving = jacobian.dot(robot.velocity)
        wanted = np.empty(6)
        if rows.start == 0:
            pull = gains.stiffness * (self.target_position - position)
            fastest = gains.damping * gains.speed  # of T 3.43, k_v nu x'_d: no pull is stronger
            strength = math.sqrt(pull.dot(pull))
            if strength > fastest > 0.0:
                pull *= fastest / strength
            pull += gains.damping * (self.target_velocity - moving[:3])
            np.add(pull, self.target_acceleration, out=wanted[:3])
        if rows.stop == 6:
            turn = gains.turn_stiffness * rotation_error(self.target_rotation, rotation)
            np.subtract(turn, gains.turn_damping * moving[3:], out=wanted[3:])
        return Demand(jacobian[rows], acceleration=wanted[rows], drift=robot.drift(self.link, self.point)[rows])

    def _place(self, robot: RobotDynamics) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        origin, rotation = robot.pose(self.link)
        return (origin if self.point is None else origin + rotation.dot(self.point)), rotation
