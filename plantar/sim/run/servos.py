"""Position servos with velocity and torque feed-forward, interpolated at their own rate."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Command
from plantar.kernels.joints.setpoints import Setpoints
from plantar.robots.kinematics.command_joints import REACH_ERROR, SLOW, SPEED_SHARE, follow_command
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.motors.planned_motion import PlannedMotion
from plantar.sim.model.world import World
from plantar.sim.plant.draw import TruePlant
from plantar.sim.plant.drives import TorqueCurve, TrueDrives

_LOW_PASS = 0.0202  # beat, time constant of each of two stages at the servo's own rate: 5 ms on a leg of 0.6 m

_CATCHES_UP = 0.08  # beat, time constant in which a leg slowed to a joint's speed limit catches up: 20 ms


class LegServos:
    """Turns walking commands into servo set-points.

    A servo computes torque = kp (u - q) - kv q'. With u = q_d + ((kv + d) q'_d + tau_ff) / kp, d the joint's damping
    and friction a load, it follows q_d without lag. Between ticks u moves at q'_d, and a tick's changes are low-passed:
    held set-points would make a saw tooth of kp q'_d dt in torque. At a speed limit all joints of a leg move by the
    same share of their way.

    `world`: the world; `period`: control period in s; `plant`: True differences, or None. Attributes `drive`: writes
    the set-points of one physics step; `plain`: the kernel that alone does so, or None; `out_of_reach_since`: time in s
    of the first unreachable command, or None.
    """

    def __init__(self, world: World, legs: LegModel, period: float, plant: TruePlant | None = None) -> None:
        self._world = world
        self._legs = legs
        self._motion = PlannedMotion(legs, period, world.body.beat)
        self._friction = world.joint_friction
        self._rubs = bool(world.joint_friction.any())
        self._slow = SLOW / world.body.beat
        limits = np.array([*world.robot.velocity_limits] * 2)
        self._setpoints = Setpoints(
            world.data.ctrl,
            world.servos,
            world.stiffness,
            world.damping + world.joint_damping,
            1.0 / (SPEED_SHARE * limits * period),
            period,
            world.period,
            world.period / (_LOW_PASS * world.body.beat + world.period),
            1.0 - period / (_CATCHES_UP * world.body.beat + period),
            *(legs.joints, legs.torques),
        )
        self._true = world.stiffness * (1.0 if plant is None else plant.stiffness_ratio)
        self._drives = None if plant is None else TrueDrives(plant, self._true, world.damping)
        corner = 1.0 if plant is None else plant.corner_speed
        self._curve = TorqueCurve(world.model, world.servos, limits, corner)
        self._velocity = np.asarray(self._setpoints.velocity)  # views of what the kernel writes
        self._reference = np.asarray(self._setpoints.reference)
        self._stiffness = 1.0
        self.plain: Setpoints | None = None
        self.drive = self._choose_drive()
        self.out_of_reach_since: float | None = None

    def start(self, joints: NDArray[np.float64], torques: NDArray[np.float64]) -> None:
        """Hold `joints` (k,) in rad with feed-forward `torques` (k,) in N m."""
        self._setpoints.hold(joints, torques)
        self._write()

    def command(self, command: Command) -> NDArray[np.float64]:
        """Returns a command's joint references (k,) in rad, within speed limits."""
        missed = follow_command(self._legs, command)
        if not missed <= REACH_ERROR and self.out_of_reach_since is None:
            self.out_of_reach_since = float(self._world.data.time)
        self._motion.update()
        self._motion.carry(command)
        if command.stiffness != self._stiffness:
            self._stiffness = command.stiffness
            self.drive = self._choose_drive()
        self._go_on(command.joint_offsets)
        return self._reference.copy()

    def follow(self, joints: NDArray[np.float64], torques: NDArray[np.float64]) -> None:
        """Go to `joints` (k,) in rad by the next tick with feed-forward `torques` (k,) in N m."""
        self._legs.joints[:] = joints
        self._legs.torques[:] = torques
        self._go_on(None)

    def _go_on(self, offsets: NDArray[np.float64] | None) -> None:
        """Set the goal of the next tick."""
        self._setpoints.go_to()
        # Turns with the velocity gradually: at rest, where its sign is noise, a jump would make the joint chatter.
        friction = self._friction * np.tanh(self._velocity / self._slow) if self._rubs else None
        self._setpoints.load(friction, offsets)

    def _choose_drive(self) -> Callable[[], None]:
        """The kernel alone writes set-points of drives as modelled."""
        as_modelled = self._drives is None and self._stiffness == 1.0
        self.plain = self._setpoints if as_modelled else None
        plain: Callable[[], None] = self._setpoints.drive
        return plain if as_modelled else self._drive_drawn

    def _drive_drawn(self) -> None:
        if self._curve.acts:
            self._curve.limit(self._world.data.qvel[self._world.joint_qvel])
        self._write()
        self._setpoints.advance()

    def _write(self) -> None:
        data = self._world.data
        w = self._world
        if self._drives is None:
            self._setpoints.write()
            if self._stiffness < 1.0:  # kp (u - q) as a share: a set-point on the way from where the joint is
                at = data.qpos[w.joint_qpos]
                data.ctrl[w.servos] = at + self._stiffness * (data.ctrl[w.servos] - at)
            return
        asked = self._true * np.asarray(self._setpoints.setpoint)
        joints = data.qpos[w.joint_qpos]
        speeds = data.qvel[w.joint_qvel]
        data.ctrl[w.servos] = self._drives.offset(float(data.time), asked, joints, speeds) / self._true
