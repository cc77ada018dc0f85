"""Whole-body torque control of a walk: the measured body follows the command by inverse dynamics.

Tasks, as accelerations: CoM by the pendulum c'' = w^2 (c - p) with the balance law's ZMP p, and its height; base
orientation; swing leg; standing soles with planned wrenches. Without a solution, or before a walk without feedback,
torques are those of the planned motion.
"""

import math
from collections.abc import Mapping
from types import MappingProxyType

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import InputError
from plantar.gait.command import Command, Sensors
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.wrench_cone import Rectangle
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.motors.body_dynamics import BodyDynamics
from plantar.robots.motors.command_motors import CommandMotors, Gains, MotorGains, motor_gains, planned_wrenches
from plantar.robots.motors.torque_program import Standing, Torques, Wish, torques_of
from plantar.robots.robot import Robot
from plantar.robots.walk import Control

_FRICTION = 0.6
_SMOOTH = 0.03  # beat, time constant of the low pass on the encoders' rates: 7 ms on a leg of 0.6 m
# 1/beat: how fast height, base, swing leg and soles are corrected
_HEIGHT = 2.5
_TILT = 3.5
_SWING = 5.0
_STANCE = 5.0
_COM_WEIGHT = 10.0
_TILT_WEIGHT = 0.1
_SWING_WEIGHT = 0.01
_STANCE_WEIGHT = 1e-5
# weight: a sole that carries stays while the one to carry next has less than the former
_LOADED = 0.03
_CARRIES = 0.2
# weight that a sole may carry at most: so much to find the ground, and times its load
_SEEKS = 0.08
_GROWS = 3.0
# beat, in which a load that was there is forgotten; chosen: 24 ms on a leg of 0.6 m, the delay of sensors and drives.
# By the last load alone the weight can go from sole to sole and back at every tick
_FORGETS = 0.1
_EDGE = 0.015  # sole: that centres of pressure keep from its edge
# s in which the way to a limit may be crossed, and a speed beyond it brought back
_SLOW_DOWN = 0.1
_REACH = 0.02
_SPEED_SHARE = 0.95  # of a joint's speed limit, which it overshoots
_FASTEST = 300.0  # rad/s^2 of a joint
_LEAK = 5.0  # 1/beat: how fast the motion that the motors' gains follow returns to the measured one


class TorqueControl(CommandMotors):
    """Torques by a whole-body program (`plantar.gait.command.Motors`).

    Takes what `CommandMotors` takes.

    `unsolved`: ticks without a solution.
    """

    def __init__(self, robot: Robot, legs: LegModel, body: BodyScale, gains: MotorGains, period: float) -> None:
        super().__init__(robot, legs, body, gains, period)
        model = legs.model
        beat = body.beat
        names = [*robot.legs["left"].joints, *robot.legs["right"].joints]
        self.unsolved = 0
        self.dynamics = BodyDynamics(model, legs.rows[6:], {s: model.site(robot.legs[s].sole_site).id for s in SIDES})
        self._beat = beat
        self._weight = body.mass * GRAVITY
        self._share = -math.expm1(-period / (_SMOOTH * beat))
        joints = [model.joint(n).id for n in names]
        self._places = model.jnt_qposadr[joints]
        low, high = model.jnt_range[joints].T
        free = model.jnt_limited[joints] == 0
        self._low = np.where(free, -np.inf, low)
        self._high = np.where(free, np.inf, high)
        self._fastest = _SPEED_SHARE * self._limits
        motors = [list(model.actuator_trnid[:, 0]).index(j) for j in joints]
        self._torque = np.where(model.actuator_forcelimited[motors] > 0, model.actuator_forcerange[motors, 1], np.inf)
        edge = _EDGE * body.sole
        self._rectangles: dict[Side, Rectangle] = {}
        for side in SIDES:
            (x, y), (length, width) = robot.sole_rectangle(side)
            self._rectangles[side] = Rectangle(x - length + edge, x + length - edge, y - width + edge, y + width - edge)
        self._sides = {"left": slice(6, 6 + len(names) // 2), "right": slice(6 + len(names) // 2, 6 + len(names))}
        self._last: NDArray[np.float64] | None = None
        self._speeds = np.zeros(len(names))
        self._keeps = math.exp(-period / (_FORGETS * beat))
        self._borne: dict[Side, float] = dict.fromkeys(SIDES, 0.0)  # weight that each sole has lately carried
        self._followed = np.zeros((2, len(names)))  # angles and rates that the motors' gains follow

    def torques(self, command: Command, sensors: Sensors) -> NDArray[np.float64]:
        """Returns torques (k,) in N m for the `command` answering the `sensors`."""
        solved = None
        if np.isfinite(sensors.joint_positions).all() and np.isfinite(sensors.gyro).all():
            offsets = command.joint_offsets
            angles = sensors.joint_positions if offsets is None else sensors.joint_positions - offsets
            if self._last is not None:
                self._speeds += self._share * ((angles - self._last) / self._period - self._speeds)
            self._last = angles
            if command.zmp_desired is not command.reference.vrp:  # else the robot stands without feedback
                solved = self._solved(command, sensors.gyro, angles)
        if solved is None:
            self.unsolved += command.zmp_desired is not command.reference.vrp
            self._followed[:] = self._legs.joints, self.motion.velocity[6:]
            return np.clip(super().torques(command, sensors), -self._torque, self._torque)
        leak = min(1.0, self._period * _LEAK / self._beat)
        self._followed += leak * (np.array([self._last, self._speeds]) - self._followed)
        self._followed += self._period * np.array([self._followed[1], solved.acceleration[6:]])
        return solved.torques

    def followed(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self._followed[0].copy(), self._followed[1].copy()

    def _solved(self, command: Command, gyro: NDArray[np.float64], angles: NDArray[np.float64]) -> Torques | None:
        state = command.state
        dynamics = self.dynamics
        beat = self._beat
        configuration = self._legs.configuration
        planned_base = configuration[3:7].copy()
        configuration[:3] = state.position_base
        mujoco.mju_mat2Quat(configuration[3:7], state.rotation_base_to_world.ravel())
        configuration[self._places] = angles
        velocity = np.concatenate([np.zeros(3), gyro, self._speeds])
        dynamics.place(configuration)
        velocity[:3] = state.com_velocity - dynamics.mass[:3] @ velocity / dynamics.mass[0, 0]
        dynamics.move(velocity)
        loads = state.loads
        carrying: Side = "left" if loads["left"] >= loads["right"] else "right"
        foot = command.feet[carrying]
        between = state.rotations_sole[carrying] @ foot.rotation.T
        turn = math.atan2(between[1, 0] - between[0, 1], between[0, 0] + between[1, 1])
        lowest = state.positions_sole[carrying].item(2)
        wished = np.zeros(len(velocity))
        weights = np.full(len(velocity), _STANCE_WEIGHT)
        # The base: its orientation alone; where it is follows from the CoM.
        wished[3:6] = self._upright(planned_base, turn, state.rotation_base_to_world, velocity[3:6])
        weights[:3] = 0.0
        weights[3:6] = _TILT_WEIGHT
        standing = {}
        wrenches = self._on_ground(planned_wrenches(command), loads)
        for side in SIDES:
            wrench = wrenches.get(side)
            at = self._sides[side]
            joints = slice(at.start - 6, at.stop - 6)
            error = self._legs.joints[joints] - angles[joints]
            lag = self.motion.velocity[at] - velocity[at]
            rate = _SWING / beat
            wished[at] = self.motion.acceleration[at] + rate * rate * error + 2.0 * rate * lag
            load = loads[side] / self._weight
            other = loads[other_side(side)] / self._weight
            if wrench is not None or (load > _CARRIES and other < _LOADED):
                rest = -_STANCE / beat * (dynamics.soles[side] @ velocity)
                own = np.zeros(6)
                if wrench is not None:
                    turned = command.feet[side].rotation.T
                    own[:3] = turned @ wrench[:3]
                    own[3:] = turned @ wrench[3:]
                most = (_SEEKS + _GROWS * self._borne[side]) * self._weight
                standing[side] = Standing(
                    state.rotations_sole[side],
                    self._rectangles[side],
                    _FRICTION,
                    rest,
                    own,
                    most,
                )
            else:
                weights[at] = _SWING_WEIGHT
        height = command.com.item(2) - foot.position.item(2) - (state.com.item(2) - lowest)
        rate = _HEIGHT / beat
        slowest, fastest = self._bounds(angles)
        wish = Wish(
            wished,
            weights,
            np.array([*self._pendulum(command), rate * rate * height - 2.0 * rate * state.com_velocity.item(2)]),
            _COM_WEIGHT,
            self._torque,
            slowest,
            fastest,
            standing,
        )
        return torques_of(dynamics, wish, GRAVITY)

    def _on_ground(
        self, planned: Mapping[Side, NDArray[np.float64]], loads: Mapping[str, float]
    ) -> Mapping[Side, NDArray[np.float64]]:
        """Returns the `planned` wrenches of soles that carry, of all if none does.

        A sole that is late has still to come down: held where the plan has it stand, it hangs above the ground.
        """
        for side in SIDES:
            self._borne[side] = max(loads[side] / self._weight, self._keeps * self._borne[side])
        carry = {side: wrench for side, wrench in planned.items() if self._borne[side] > _LOADED}
        return carry or planned

    def _pendulum(self, command: Command) -> NDArray[np.float64]:
        square = GRAVITY / (command.com.item(2) - min(f.position.item(2) for f in command.feet.values()))
        return np.asarray(square * (command.state.com[:2] - command.zmp_desired + command.momentum))

    def _upright(
        self, planned: NDArray[np.float64], turn: float, rotation: NDArray[np.float64], speed: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Angular acceleration (3,) towards the planned orientation, base frame."""
        wanted = np.zeros(4)
        inverse = np.zeros(4)
        error = np.zeros(4)
        way = np.zeros(3)
        mujoco.mju_mulQuat(wanted, np.array([math.cos(0.5 * turn), 0.0, 0.0, math.sin(0.5 * turn)]), planned)
        mujoco.mju_mat2Quat(inverse, rotation.T.ravel())
        mujoco.mju_mulQuat(error, inverse, wanted)
        mujoco.mju_quat2Vel(way, error, 1.0)
        rate = _TILT / self._beat
        return np.asarray(rate * rate * way + 2.0 * rate * (self.motion.velocity[3:6] - speed))

    def _bounds(self, angles: NDArray[np.float64]) -> NDArray[np.float64]:
        """Least and largest accelerations (2, k) within limits of angle and speed."""
        least = np.maximum(-self._fastest, (self._low - angles) / _SLOW_DOWN)
        most = np.minimum(self._fastest, (self._high - angles) / _SLOW_DOWN)
        return np.asarray(np.clip((np.array([least, most]) - self._speeds) / _REACH, -_FASTEST, _FASTEST))


def command_motors(
    robot: Robot,
    legs: LegModel,
    body: BodyScale,
    control: Control,
    period: float,
    gains: Gains = MappingProxyType({}),
) -> CommandMotors | None:
    """What drives a robot.

    Takes `robot`, `legs`, `body`, `control`, control `period` in s and `gains` of single joints; returns None for
    position servos.

    Raises:
        InputError: `gains` that no drive takes, or that are not allowed.
    """
    if control.drives == "servo":
        if gains:
            raise InputError("gains are given, but drives 'servo' has its own; allowed: drives 'own' or 'torque'")
        return None
    kind = TorqueControl if control.drives == "torque" else CommandMotors
    return kind(robot, legs, body, motor_gains(robot, control.joint_stiffness, gains), period)
