"""Virtual admittance for robots taking velocities or positions (A 26, T 3.2.3).

The stack's torques drive M_v q'' + D_v q' = tau - bias, whose motion is the servos' set-points.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.errors import InputError
from plantar.wholebody.dynamics import RobotDynamics


class ResolverSettings(Settings):
    """The virtual robot's coupling to the real one.

    Attributes:
        damping: Rate in 1/s: D_v = damping M_v.
        velocity_pull: Rate in 1/s of virtual towards measured velocity (inner loop of A 3.4).
        largest_lag: Set-point's largest difference from the measured position in rad or m.
        largest_acceleration: Every joint's, in rad/s^2 or m/s^2.
    """

    damping: float = number(2.0, "1/s", 0.0, 1e3)
    velocity_pull: float = number(2.0, "1/s", 0.0, 1e3)
    largest_lag: float = number(0.1, "rad", 1e-6, 10.0)
    largest_acceleration: float = number(50.0, "rad/s^2", 1e-3, 1e6)


class SetPoint(NamedTuple):
    """Positions (k,) in rad or m and velocities (k,) for servos."""

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]


class TorqueResolver:
    """Virtual robot, limited so that servos can follow.

    `velocity_limits`: each joint's (k,) in rad/s or m/s; `mass`: M_v (k, k) in kg m^2 or kg; None for the robot's
    current.
    """

    def __init__(
        self,
        velocity_limits: NDArray[np.float64],
        settings: ResolverSettings | None = None,
        mass: NDArray[np.float64] | None = None,
    ) -> None:
        self.velocity_limits = np.array(velocity_limits, dtype=float)
        if not (self.velocity_limits > 0.0).all():
            raise InputError(f"a velocity limit is {self.velocity_limits.min():g}; allowed: above 0")
        if mass is not None and not (np.linalg.eigvalsh(mass) > 0.0).all():
            raise InputError("the virtual mass is not positive definite")
        self.settings = settings or ResolverSettings()
        self.mass = mass
        self._state: SetPoint | None = None

    def step(self, robot: RobotDynamics, torque: NDArray[np.float64], period: float) -> SetPoint:
        """Set-points after a control period of the torques, at first from the real state.

        `robot`: as measured; its bias is subtracted, its motion draws the virtual one; `torque`: stack's (k,) in N m or
        N, with bias; `period` of control in s.
        """
        s = self.settings
        joints = robot.joints
        measured = robot.velocity[joints]
        position = robot.joint_positions
        if self._state is None:
            self._state = SetPoint(position.copy(), np.clip(measured, -self.velocity_limits, self.velocity_limits))
        virtual = self._state.velocity
        mass = robot.mass_matrix[np.ix_(joints, joints)] if self.mass is None else self.mass
        pushed = np.linalg.solve(mass, torque - robot.bias[joints]) + s.velocity_pull * (measured - virtual)
        # Damping is taken implicitly, so that no rate of it makes the period too long.
        wanted = (virtual + period * pushed) / (1.0 + period * s.damping)
        change = period * s.largest_acceleration
        velocity = virtual + np.clip(wanted - virtual, -change, change)
        velocity = np.clip(velocity, -self.velocity_limits, self.velocity_limits)
        moved = self._state.position + period * velocity
        moved = position + np.clip(moved - position, -s.largest_lag, s.largest_lag)
        self._state = SetPoint(moved, velocity)
        return self._state
