"""Floating-base state from what the robot has: joint encoders, IMU and the soles' readings.

Orientation: the gyro is integrated, less its bias where that is identified; gravity, freed from the acceleration that
the plan asks for, corrects roll and pitch slowly, and the heading of the loaded feet corrects yaw. (The pendulum's own
estimate of the acceleration would not do: a wrong tilt moves the estimated CoM over the feet by just what makes it
agree with the accelerometer.)

Position: the material point of each loaded sole that lies at its centre of pressure does not move, so the base moves
by what the leg's kinematics say, weighted by load; a foot that rolls about its edge is followed too.

Velocity of the CoM: an observer of the pendulum x'' = w^2 (x - p) with the taxels' ZMP p as input and the kinematic
CoM as measurement, so that no encoder is differentiated. A push on the body, felt or estimated, is another input. A
Kalman filter (`gait.estimate.dcm_filter`) may do the same in its place, horizontally.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from gait.estimate.dcm_filter import DcmFilter
from gait.estimate.encoder_offsets import standing_base
from gait.estimate.gyro_bias import GyroBias
from gait.estimate.push_estimate import PushEstimate
from gait.estimate.steady_load import SteadyLoad
from plantar.layouts.layout import Side
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.rotation import heading, orthonormalised, rotation_from_vector
from plantar.mechanics.zmp import zmp_of_feet
from plantar.settings.schema import Settings, share
from plantar.sides import SIDES

__all__ = [
    "EstimatorGains",
    "FloatingBaseEstimator",
    "LegKinematics",
    "Posture",
    "SoleLoad",
]


class Posture(NamedTuple):
    """Kinematics of a joint configuration in the base (torso) frame.

    Attributes:
        com: CoM (3,) in m.
        positions: Sole frame origin (3,) of each foot in m.
        rotations: Rotation (3, 3) from each sole frame to the base frame.
    """

    com: NDArray[np.float64]
    positions: Mapping[Side, NDArray[np.float64]]
    rotations: Mapping[Side, NDArray[np.float64]]


class SoleLoad(Protocol):
    """What a sole carries, by its taxels (`plantar.Percept`) or its ankle (`SoleWrench`)."""

    @property
    def vertical_force(self) -> float:
        """Vertical force in N."""
        ...

    @property
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Centre of pressure (2,) in the sole frame in m, None without load."""
        ...

    @property
    def wrench_in_sole(self) -> NDArray[np.float64]:
        """Wrench (6,) about the sole frame's origin."""
        ...


class LegKinematics(Protocol):
    """What the estimator needs of a robot model."""

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """Forward kinematics of joint positions (k,) in rad."""
        ...


class EstimatorGains(Settings):
    """Gains of the estimator.

    Attributes:
        gravity: Roll and pitch correction by the accelerometer in 1/s.
        averaging: Time in s for which the robot holds still at the start and gravity is averaged.
        yaw: Heading correction by the loaded feet in 1/s.
        observer: Bandwidth of the CoM velocity observer in rad/s.
        tare: Time constant in s with which a foot in the air finds its zero.
        minimum_load: Vertical force in N that a foot must exceed to count as loaded; above the noise that many unloaded
            taxels add up to. Feet weigh in with what they carry beyond it.
    """

    gravity: float = share(0.0495, "1/beat", 0, 50)
    averaging: float = share(2.02, "beat", 0.01, 10)
    yaw: float = share(0.495, "1/beat", 0, 50)
    observer: float = share(4.95, "rad/beat", 0.1, 100)
    tare: float = share(0.202, "beat", 0.005, 10)
    minimum_load: float = share(0.083, "weight", 0, 10000)


@dataclass
class FloatingBaseEstimator:
    """Estimator of the floating base.

    Attributes:
        kinematics: Forward kinematics of the robot.
        omega: Pendulum frequency in rad/s.
        period: Control period in s.
        feet: Known standing pose (x, y, z, yaw) of each sole at the start.
        gains: Gains.
        gyro_bias: Identifies the gyro's bias; None takes the gyro at its word.
        steady: Tells which feet stand still enough to hold the gyro against; None takes all that are loaded.
        push: Estimates a push on the body from the soles and the IMU; None expects none.
        dcm_filter: Estimates the horizontal CoM and its velocity; None leaves them to the observer.
        push_acceleration: Acceleration (2,) of the CoM in m/s^2 that a push gives it at this tick.
    """

    kinematics: LegKinematics
    omega: float
    period: float
    feet: Mapping[Side, tuple[float, float, float, float]]
    gains: EstimatorGains = field(default_factory=EstimatorGains)
    gyro_bias: GyroBias | None = None
    steady: SteadyLoad | None = None
    push: PushEstimate | None = None
    dcm_filter: DcmFilter | None = None

    def __post_init__(self) -> None:
        self._rotation: NDArray[np.float64] | None = None
        self._position = np.zeros(3)
        self._com = np.zeros(3)
        self._velocity = np.zeros(3)
        self._last: Posture | None = None
        self._samples = 0
        self._tare: dict[Side, float] = {"left": 0.0, "right": 0.0}
        self._last_rotation = np.eye(3)
        self._heading: dict[Side, float | None] = {"left": None, "right": None}
        self._astray = 0.0
        self.push_acceleration = np.zeros(2)

    def update(
        self,
        joint_positions: NDArray[np.float64],
        gyro: NDArray[np.float64],
        accelerometer: NDArray[np.float64],
        soles: Mapping[Side, SoleLoad],
        planned_acceleration: NDArray[np.float64] | None = None,
        airborne: Side | None = None,
        felt: NDArray[np.float64] | None = None,
    ) -> BaseState:
        """One control tick.

        Args:
            joint_positions: Encoder readings (k,) in rad.
            gyro: Angular velocity (3,) of the base in the base frame in rad/s.
            accelerometer: Specific force (3,) of the base in the base frame in m/s^2.
            soles: What each sole carries.
            planned_acceleration: Horizontal CoM acceleration (2,) in m/s^2 that the plan asks for; 0 where None.
            airborne: Foot that is high in the air by plan: what it reads there becomes its tare.
            felt: Acceleration (2,) of the CoM in m/s^2 by a push that skin on the body feels; None goes by the soles.
                Heeded where there is a `push` estimate beside it.

        Returns:
            The estimated state.
        """
        posture = self.kinematics.posture(joint_positions)
        if airborne is not None:
            # The foot is in the air: all that it measures is drift, which is taken off the loads to come.
            share = min(1.0, self.period / self.gains.tare)
            self._tare[airborne] += share * (soles[airborne].vertical_force - self._tare[airborne])
        # Ground never pulls; what the tare leaves below zero is noise.
        loads: dict[str, float] = {s: max(0.0, soles[s].vertical_force - self._tare[s]) for s in SIDES}
        cops = {s: soles[s].position_cop_in_sole for s in SIDES}
        if self._rotation is None or self._last is None:
            self._start(posture, accelerometer)
        else:
            self._turn(posture, gyro, accelerometer, loads, planned_acceleration)
            self._move(posture, loads, cops)
        rotation = self._rotation
        assert rotation is not None
        self._last, self._last_rotation = posture, rotation
        positions: dict[str, NDArray[np.float64]] = {
            s: self._position + rotation.dot(posture.positions[s]) for s in SIDES
        }
        rotations: dict[str, NDArray[np.float64]] = {s: rotation.dot(posture.rotations[s]) for s in SIDES}
        points: list[NDArray[np.float64] | None] = []
        for s in SIDES:
            cop = cops[s]
            points.append(None if cop is None else (positions[s] + rotations[s][:, :2].dot(cop))[:2])
        zmp = zmp_of_feet(points, [loads[s] for s in SIDES])
        if self.push is not None:
            self.push_acceleration = self._pushed(self.push, rotation.dot(accelerometer)[:2], zmp, felt)
        self._observe(self._position + rotation.dot(posture.com), zmp)
        return BaseState(
            rotation,
            self._position.copy(),
            self._com.copy(),
            self._velocity.copy(),
            zmp,
            loads,
            positions,
            rotations,
        )

    def _start(self, posture: Posture, accelerometer: NDArray[np.float64]) -> None:
        """Level the base by gravity, head it along the feet, and stand on the known footholds."""
        # The robot stands still at the start, so the specific force is gravity alone.
        self._stand(posture, accelerometer / float(np.linalg.norm(accelerometer)))

    def stand_again(self, joint_positions: NDArray[np.float64]) -> None:
        """Take the robot to stand on the known footholds again: it has not moved, but its kinematics are known better.

        Args:
            joint_positions: Encoder readings (k,) in rad.
        """
        if self._rotation is None:
            return
        self._last = self.kinematics.posture(joint_positions)
        self._stand(self._last, self._rotation[2])
        self._last_rotation = self._rotation
        self._velocity = np.zeros(3)
        self._astray = 0.0

    def _stand(self, posture: Posture, up: NDArray[np.float64]) -> None:
        """Stand on the known footholds, with a unit vector (3,) against gravity in the base frame."""
        self._rotation, self._position = standing_base(posture, up, self.feet)
        self._com = self._position + self._rotation @ posture.com
        if self.dcm_filter is not None:
            self.dcm_filter.reset()
        for side in SIDES:
            self._heading[side] = self.feet[side][3]

    def _turn(
        self,
        posture: Posture,
        gyro: NDArray[np.float64],
        accelerometer: NDArray[np.float64],
        loads: Mapping[str, float],
        planned_acceleration: NDArray[np.float64] | None,
    ) -> None:
        assert self._rotation is not None
        assert self._last is not None
        rotation = self._rotation
        weights = {side: max(0.0, loads[side] - self.gains.minimum_load) for side in SIDES}
        rate = gyro.copy()
        if self.gyro_bias is not None:
            still = weights if self.steady is None else self.steady.update(weights)
            rate -= self.gyro_bias.update(gyro, self._last.rotations, posture.rotations, still)
        # Gravity: the specific force minus the body's acceleration points up.
        specific = rotation.dot(accelerometer)
        if planned_acceleration is not None:
            specific[:2] -= planned_acceleration
        size = math.sqrt(float(specific.dot(specific)))
        # An impact says nothing of what is up.
        if 0.7 * GRAVITY < size < 1.3 * GRAVITY:
            x, y, _ = specific.tolist()
            tilt = np.array([y / size, -x / size, 0.0])  # specific x up
            # While the robot holds still, the running mean of what came so far; then a slow filter. (Balance control
            # has to wait that long: it would sway the robot by a wrong tilt and the sway would look like more tilt.)
            self._samples += 1
            since = self.period * (self._samples + 1)
            gain = 1.0 / since if since < self.gains.averaging else self.gains.gravity
            rate += gain * rotation.T.dot(tilt)
        error = self._heading_error(posture, weights)
        rate -= (self.gains.yaw * error) * rotation[2]
        if self.gyro_bias is not None:
            self._astray -= self.period * self.gains.yaw * error
        # Rounding would make the product of thousands of rotations shrink or shear.
        self._rotation = orthonormalised(rotation.dot(rotation_from_vector(rate * self.period)))

    def _heading_error(self, posture: Posture, weights: Mapping[Side, float]) -> float:
        """How far in rad the heading is ahead of that by the feet that carry.

        Where the gyro's bias is identified, it is what the heading has turned more than the legs since the start while
        feet stood still, so that nothing stays of what a bias turned it before it was known; in between it goes by the
        gyro less its bias. Else a foot counts from when it comes to carry.
        """
        assert self._rotation is not None
        if self.gyro_bias is not None:
            if self.gyro_bias.missed is not None:
                self._astray -= float(self._rotation[2].dot(self.gyro_bias.missed))
            return self._astray
        total = 0.0
        error = 0.0
        for side, weight in weights.items():
            if weight <= 0.0:
                self._heading[side] = None
                continue
            yaw = heading(self._rotation.dot(posture.rotations[side]))
            held = self._heading[side]
            if held is None:
                # The heading that the foot has when it comes to carry is held against the gyro, which drifts about the
                # vertical.
                self._heading[side] = held = yaw
            # Weights begin at zero, so that a foot joins and leaves without a jump.
            error += weight * math.remainder(yaw - held, 2.0 * math.pi)
            total += weight
        return error / total if total > 0.0 else 0.0

    def _move(
        self,
        posture: Posture,
        loads: Mapping[str, float],
        cops: Mapping[Side, NDArray[np.float64] | None],
    ) -> None:
        assert self._rotation is not None
        assert self._last is not None
        shift = np.zeros(3)
        total = 0.0
        for side in SIDES:
            cop = cops[side]
            weight = loads[side] - self.gains.minimum_load
            if cop is None or weight <= 0.0:
                continue
            # The point of the sole that carries does not move while it rolls over the ground: its apparent move is the
            # base's.
            before = self._last.positions[side] + self._last.rotations[side][:, :2].dot(cop)
            now = posture.positions[side] + posture.rotations[side][:, :2].dot(cop)
            shift += weight * (self._last_rotation.dot(before) - self._rotation.dot(now))
            total += weight
        if total > 0.0:
            self._position = self._position + shift / total
        else:
            # No foot carries: the body goes on as it went.
            self._position = self._position + self.period * self._velocity

    def _pushed(
        self,
        push: PushEstimate,
        acceleration: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        felt: NDArray[np.float64] | None,
    ) -> NDArray[np.float64]:
        """The push at this tick: what skin on the body feels of it, else what the soles tell."""
        estimated = push.update(acceleration, None if zmp is None else self.omega**2 * (self._com[:2] - zmp))
        return estimated if felt is None else felt

    def _observe(self, com: NDArray[np.float64], zmp: NDArray[np.float64] | None) -> None:
        acceleration = np.zeros(3)
        if zmp is not None:
            # Predicted by the pendulum over the measured ZMP; the kinematics corrects it.
            acceleration[:2] = self.omega**2 * (self._com[:2] - zmp)
        acceleration[:2] += self.push_acceleration
        self._com = self._com + self.period * self._velocity
        self._velocity = self._velocity + self.period * acceleration
        error = com - self._com
        # Both poles of the observer lie at -b: gains 2 b and b^2.
        b = self.gains.observer
        self._com = self._com + min(1.0, 2.0 * b * self.period) * error
        self._velocity = self._velocity + min(1.0, b * b * self.period) * error
        if self.dcm_filter is not None:
            offset = self.push_acceleration / self.omega**2
            told = self.dcm_filter.update(com[:2], None, zmp, offset)
            self._com[:2], self._velocity[:2] = told.com, self.omega * (told.dcm - told.com)
