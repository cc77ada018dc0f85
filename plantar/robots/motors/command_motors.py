"""A walking command as targets, torques and gains of the leg motors.

"own" drives take the torques of planned ground forces and of the planned motion; "torque" drives
`plantar.robots.motors.torque_control`.
"""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.gait.command import Command, JointTargets, Sensors
from plantar.robots.kinematics.command_joints import REACH_ERROR, SLOW, SPEED_SHARE, follow_command
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.motors.planned_motion import PlannedMotion
from plantar.robots.robot import Robot

_MOST_GAIN = 1e6  # N m/rad and N m s/rad, as in a robot's file


class MotorGains(NamedTuple):
    """Gains of the leg joints' motors.

    `stiffness`: position gains (k,) in N m/rad; `damping`: velocity gains (k,) in N m s/rad.
    """

    stiffness: NDArray[np.float64]
    damping: NDArray[np.float64]


Gains = Mapping[str, float | Sequence[float]]
"""Gains of joints by name: stiffness in N m/rad, or (stiffness, damping in N m s/rad)."""


def motor_gains(robot: Robot, stiffness: float, given: Gains = MappingProxyType({})) -> MotorGains:
    """Returns gains of a robot's own motors.

    `stiffness` in N m/rad of every joint instead; 0 for its own; `given`: of single joints instead. Where no damping is
    given, it stays the same share of critical.

    Raises:
        InputError: A joint that is not of the legs, or gains that are not allowed.
    """
    own = np.array([*robot.own_stiffness] * 2)
    damping = np.array([*robot.own_damping] * 2)
    names = [*robot.legs["left"].joints, *robot.legs["right"].joints]
    for name in given:
        if name not in names:
            raise InputError(f"gains name joint {name!r}; allowed: {', '.join(names)}")
    wanted = np.full(len(own), stiffness) if stiffness else own.copy()
    damped = np.full(len(own), math.nan)
    for place, name in enumerate(names):
        if name in given:
            wanted[place], damped[place] = _checked_gains(name, given[name])
    scaled = np.where(wanted == own, damping, damping * np.sqrt(wanted / np.maximum(own, 1.0)))
    return MotorGains(wanted, np.where(np.isnan(damped), scaled, damped))


def _checked_gains(name: str, given: float | Sequence[float]) -> tuple[float, float]:
    """A joint's stiffness and damping; the latter is NaN where it is not given."""
    values = list(given) if isinstance(given, Sequence) and not isinstance(given, str) else [given]
    numbers = [v for v in values if isinstance(v, (int, float)) and not isinstance(v, bool) and 0.0 <= v <= _MOST_GAIN]
    if not 1 <= len(values) <= 2 or len(numbers) != len(values):
        raise InputError(
            f"gains of joint {name!r} are {given!r}; allowed: stiffness in N m/rad, or (stiffness, damping in N m "
            f"s/rad), each from 0 to {_MOST_GAIN:g}"
        )
    return float(numbers[0]), float(numbers[1]) if len(numbers) == 2 else math.nan


def planned_wrenches(command: Command) -> dict[Side, NDArray[np.float64]]:
    """Wrench (6,) on each loaded sole about its target's origin, command frame."""
    wrenches = {}
    for side in SIDES:
        foot = command.feet[side]
        if foot.force.item(2) > 0.0:
            fx, fy, fz = foot.force.tolist()
            x, y, _ = foot.position.tolist()
            px, py = foot.center_of_pressure
            dx = px - x
            dy = py - y
            wrenches[side] = np.array([fx, fy, fz, dy * fz, -dx * fz, dx * fy - dy * fx])
    return wrenches


class CommandMotors:
    """Solves commands for the motors (`plantar.gait.command.Motors`).

    `period`: control period in s. Attributes `stiffness`: position gains (k,) in N m/rad; `damping`: velocity gains
    (k,) in N m s/rad; `out_of_reach`: whether the legs missed the last command.
    """

    def __init__(self, robot: Robot, legs: LegModel, body: BodyScale, gains: MotorGains, period: float) -> None:
        self.stiffness, self.damping = gains
        self.out_of_reach = False
        self._legs = legs
        model = legs.model
        dofs = legs.rows[6:]
        self.motion = PlannedMotion(legs, period, body.beat, whole=True)
        self._period = period
        self._angles: NDArray[np.float64] | None = None
        self._limits = np.array([*(robot.velocity_limits or (1e3,) * (len(dofs) // 2))] * 2)
        self._farthest = SPEED_SHARE * period * self._limits  # rad in a control period
        self._friction = model.dof_frictionloss[dofs]
        self._damping = model.dof_damping[dofs]
        self._slow = SLOW / body.beat

    def targets(self, command: Command, sensors: Sensors) -> JointTargets:
        """Returns targets for the `command` that answers the `sensors` (`plantar.gait.command.Motors`)."""
        self.out_of_reach = not follow_command(self._legs, command) <= REACH_ERROR
        self.motion.update()
        torques = self.torques(command, sensors)
        angles, velocity = self.followed()
        torques = torques + self._friction * np.tanh(velocity / self._slow)
        if command.joint_offsets is not None:
            angles += command.joint_offsets
        return JointTargets(angles, torques, velocity, self.stiffness, self.damping)

    def torques(self, command: Command, sensors: Sensors) -> NDArray[np.float64]:
        """Returns feed-forward torques (k,) in N m for the `command` answering the `sensors`."""
        self.motion.carry(command)
        return np.asarray(self._legs.torques + self._damping * self.motion.velocity[6:])

    def followed(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Angles (k,) in rad and rates (k,) in rad/s that the gains follow.

        Beyond a limit, all joints move by the same smaller share and catch up later.
        """
        last = self._legs.joints.copy() if self._angles is None else self._angles
        way = self._legs.joints - last
        way /= max(1.0, float((np.abs(way) / self._farthest).max()))
        self._angles = last + way
        return self._angles.copy(), way / self._period
