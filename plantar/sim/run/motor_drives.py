"""Leg joints driven by motors with gains and feed-forward torques."""

import numpy as np
from numpy.typing import NDArray

from plantar.errors import SceneError
from plantar.gait.command import Command, JointTargets
from plantar.robots.motors.command_motors import CommandMotors
from plantar.sim.model.world import World
from plantar.sim.plant.draw import TruePlant
from plantar.sim.plant.drives import TorqueCurve, TrueDrives


class MotorDrives:
    """Hands joint targets to motors, and moves angles on between control ticks.

    `world`: its actuators become torque sources with the gains; `plant`: True differences, or None. Attributes
    `out_of_reach_since`: time in s of the first unreachable command, or None; `plain`: None, as torques depend on
    angles.
    """

    def __init__(self, world: World, motors: CommandMotors, plant: TruePlant | None = None) -> None:
        self._world = world
        self._motors = motors
        model = world.model
        servos = world.servos
        self._stiffness = motors.stiffness * (1.0 if plant is None else plant.stiffness_ratio)
        self._damping = motors.damping
        model.actuator_gainprm[servos, 0] = 1.0
        model.actuator_biasprm[servos, 1] = -self._stiffness
        model.actuator_biasprm[servos, 2] = -self._damping
        self._true = TrueDrives(plant, self._stiffness, self._damping)
        speeds = np.array([*world.robot.velocity_limits] * 2)
        self._curve = TorqueCurve(model, servos, speeds, 1.0 if plant is None else plant.corner_speed)
        self._targets = JointTargets(np.zeros(len(servos)), np.zeros(len(servos)))
        self._share = 1.0
        self._elapsed = 0.0
        self.plain: None = None
        self.out_of_reach_since: float | None = None

    def start(self, joints: NDArray[np.float64], torques: NDArray[np.float64]) -> None:
        """Hold `joints` (k,) in rad with `torques` (k,) in N m."""
        self.follow(joints.copy(), torques.copy())
        self.drive()

    def command(self, command: Command) -> NDArray[np.float64]:
        """Follow a command until the next; returns its joint angles (k,) in rad."""
        if command.joints is None:
            raise SceneError("the command has no joint targets; allowed: a controller with control.drives")
        if self._motors.out_of_reach and self.out_of_reach_since is None:
            self.out_of_reach_since = float(self._world.data.time)
        self._targets = command.joints
        self._share = command.stiffness
        self._elapsed = 0.0
        return command.joints.angles

    def follow(self, joints: NDArray[np.float64], torques: NDArray[np.float64]) -> None:
        """Go to `joints` (k,) in rad with `torques` (k,) in N m by the next tick."""
        self._targets = JointTargets(joints, torques)
        self._elapsed = 0.0

    def drive(self) -> None:
        """Write the torques of one physics step."""
        w = self._world
        target = self._targets
        joints = w.data.qpos[w.joint_qpos]
        speeds = w.data.qvel[w.joint_qvel]
        asked = self._stiffness * target.angles + target.torques
        if target.velocities is not None:
            asked += (self._damping + self._stiffness * self._elapsed) * target.velocities
        if self._share < 1.0:
            held = self._stiffness * joints
            asked = held + self._share * (asked - held)
        if self._curve.acts:
            self._curve.limit(speeds)
        w.data.ctrl[w.servos] = self._true.offset(float(w.data.time), asked, joints, speeds)
        self._elapsed += w.period
