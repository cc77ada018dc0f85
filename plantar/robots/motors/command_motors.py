"""A walking controller's command as targets, torques and gains of the leg joints' own motors.

With "own" drives the torques are those of the planned motion, by inverse dynamics along the joint solutions with the
ground forces that the balance law plans: tau = M(q*) a* + h(q*, v*) - sum J^T w, so that the gains have to correct
only what the plan does not know. With "torque" they are those of `plantar.robots.motors.torque_control`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Command, JointTargets, Sensors
from plantar.robots.kinematics.command_joints import follow_command
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.motors.body_dynamics import BodyDynamics
from plantar.robots.motors.planned_motion import PlannedMotion
from plantar.robots.robot import Robot
from plantar.robots.walk import Control
from plantar.settings.body_scale import BodyScale
from plantar.sides import SIDES, Side

__all__ = ["CommandMotors", "MotorGains", "command_motors", "motor_gains", "planned_wrenches"]

_REACH_ERROR = 0.02  # rad, or m on a leg of 0.6 m, of a joint solution, as of `plantar.sim.run.servos`
_SLOW = 0.0247  # rad/beat from which a joint moves against its friction


class MotorGains(NamedTuple):
    """Gains of the leg joints' motors.

    Attributes:
        stiffness: Position gains (k,) in N m/rad.
        damping: Velocity gains (k,) in N m s/rad.
    """

    stiffness: NDArray[np.float64]
    damping: NDArray[np.float64]


def motor_gains(robot: Robot, stiffness: float) -> MotorGains:
    """Returns gains of a robot's own motors.

    Args:
        robot: The robot.
        stiffness: Stiffness in N m/rad of every joint instead, damped as near to critical as its own; 0 for its own.
    """
    own, damping = np.array([*robot.own_stiffness] * 2), np.array([*robot.own_damping] * 2)
    if not stiffness:
        return MotorGains(own, damping)
    return MotorGains(np.full(len(own), stiffness), damping * np.sqrt(stiffness / np.maximum(own, 1.0)))


def planned_wrenches(command: Command) -> dict[Side, NDArray[np.float64]]:
    """Wrench (6,) on each sole that a command loads, about its target's origin, in the frame of the command."""
    wrenches = {}
    for side in SIDES:
        foot = command.feet[side]
        if foot.force.item(2) > 0.0:
            lever = np.array([*foot.center_of_pressure.tolist(), foot.position.item(2)]) - foot.position
            wrenches[side] = np.concatenate([foot.force, np.cross(lever, foot.force)])
    return wrenches


class CommandMotors:
    """Solves commands for the motors (`plantar.gait.command.Motors`).

    Args:
        robot: The robot.
        legs: Kinematics of its legs.
        body: How large it is.
        gains: Gains of the motors.
        period: Control period in s.

    Attributes:
        stiffness: Position gains (k,) in N m/rad of the motors.
        damping: Velocity gains (k,) in N m s/rad of the motors.
        out_of_reach: Whether the legs did not reach the last command.
    """

    def __init__(self, robot: Robot, legs: LegModel, body: BodyScale, gains: MotorGains, period: float) -> None:
        self.stiffness, self.damping = gains
        self.out_of_reach = False
        self._legs = legs
        model = legs.model
        names = [*robot.legs["left"].joints, *robot.legs["right"].joints]
        self._dofs = np.array([model.joint(name).dofadr[0] for name in names], dtype=np.intp)
        sites: dict[Side, int] = {s: model.site(robot.legs[s].sole_site).id for s in SIDES}
        self.dynamics = BodyDynamics(model, self._dofs, sites)
        self.motion = PlannedMotion(model, self.dynamics.rows, period, body.beat)
        self._friction = model.dof_frictionloss[self._dofs]
        self._slow = _SLOW / body.beat

    def targets(self, command: Command, sensors: Sensors) -> JointTargets:
        """Returns targets for the `command` that answers the `sensors` (`plantar.gait.command.Motors`)."""
        self.out_of_reach = not follow_command(self._legs, command) <= _REACH_ERROR
        self.motion.update(self._legs.configuration)
        velocity = self.motion.velocity[6:]
        torques = self.torques(command, sensors) + self._friction * np.tanh(velocity / self._slow)
        angles = self._legs.joints.copy()
        if command.joint_offsets is not None:
            angles += command.joint_offsets
        return JointTargets(angles, torques, velocity, self.stiffness, self.damping)

    def torques(self, command: Command, sensors: Sensors) -> NDArray[np.float64]:
        """Returns feed-forward torques (k,) in N m for the `command` that answers the `sensors`."""
        self.dynamics.place(self._legs.configuration, self.motion.velocity)
        return self.dynamics.forces(self.motion.acceleration, planned_wrenches(command))[6:]


def command_motors(
    robot: Robot, legs: LegModel, body: BodyScale, control: Control, period: float
) -> CommandMotors | None:
    """What drives a robot as a scene's `[control]` table asks for.

    Takes `robot`, its `legs`, `body`, `control` and the control `period` in s; returns None for position servos."""
    if control.drives == "servo":
        return None
    return CommandMotors(robot, legs, body, motor_gains(robot, control.joint_stiffness), period)
