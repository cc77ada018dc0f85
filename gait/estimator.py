"""Floating-base state from what the robot has: joint encoders, IMU and the soles' readings.

Orientation: the gyro is integrated; gravity, freed from the acceleration that the plan asks for, corrects roll and
pitch slowly, and the heading of the loaded feet corrects yaw. (The pendulum's own estimate of the acceleration would
not do: a wrong tilt moves the estimated CoM over the feet by just what makes it agree with the accelerometer.)

Position: the material point of each loaded sole that lies at its centre of pressure does not move, so the base moves
by what the leg's kinematics say, weighted by load; a foot that rolls about its edge is followed too.

Velocity of the CoM: an observer of the pendulum x'' = w^2 (x - p) with the taxels' ZMP p as input and the kinematic
CoM as measurement, so that no encoder is differentiated.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gait.lip import GRAVITY
from plantar.force import zmp_of_feet
from plantar.layout import Side

__all__ = [
    "BaseState",
    "EstimatorGains",
    "FloatingBaseEstimator",
    "LegKinematics",
    "Posture",
    "SoleLoad",
    "heading",
    "rotation_from_vector",
]

_SIDES: tuple[Side, Side] = ("left", "right")
_THREE_HALVES = 1.5 * np.eye(3)


@dataclass(frozen=True)
class Posture:
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
    """What a sole carries, by its taxels (`plantar.percept.Percept`) or its ankle (`gait.ankle_sensor.SoleWrench`)."""

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


@dataclass(frozen=True)
class EstimatorGains:
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

    gravity: float = 0.2
    averaging: float = 0.5
    yaw: float = 2.0
    observer: float = 20.0
    tare: float = 0.05
    minimum_load: float = 70.0


@dataclass(frozen=True)
class BaseState:
    """Estimated state, world frame.

    Attributes:
        rotation_base_to_world: Rotation (3, 3).
        position_base: Base position (3,) in m.
        com: CoM (3,) in m.
        com_velocity: CoM velocity (3,) in m/s.
        zmp: Composite ZMP (2,) in m of what the soles carry, or None without load.
        loads: Vertical force on each foot in N, less its tare.
        positions_sole: Sole frame origin (3,) of each foot in m.
        rotations_sole: Rotation (3, 3) from each sole frame to the world frame.
    """

    rotation_base_to_world: NDArray[np.float64]
    position_base: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    zmp: NDArray[np.float64] | None
    loads: Mapping[Side, float]
    positions_sole: Mapping[Side, NDArray[np.float64]]
    rotations_sole: Mapping[Side, NDArray[np.float64]]


def rotation_from_vector(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) of a rotation vector (3,) in rad (Rodrigues)."""
    x, y, z = vector.tolist()
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-6:
        s, c = 1.0, 0.5
    else:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    xx, yy, zz, xy, xz, yz = c * x * x, c * y * y, c * z * z, c * x * y, c * x * z, c * y * z
    x, y, z = s * x, s * y, s * z
    return np.array([[1.0 - yy - zz, xy - z, xz + y], [xy + z, 1.0 - xx - zz, yz - x], [xz - y, yz + x, 1.0 - xx - yy]])


def _orthonormal(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """First-order re-orthonormalisation, enough for a rotation that is updated at every tick."""
    return np.asarray(rotation.dot(_THREE_HALVES - 0.5 * rotation.T.dot(rotation)))


def heading(rotation: NDArray[np.float64]) -> float:
    """Yaw in rad of a rotation (3, 3) to the world."""
    return math.atan2(rotation[1, 0], rotation[0, 0])


@dataclass
class FloatingBaseEstimator:
    """Estimator of the floating base.

    Attributes:
        kinematics: Forward kinematics of the robot.
        omega: Pendulum frequency in rad/s.
        period: Control period in s.
        feet: Known standing pose (x, y, z, yaw) of each sole at the start.
        gains: Gains.
    """

    kinematics: LegKinematics
    omega: float
    period: float
    feet: Mapping[Side, tuple[float, float, float, float]]
    gains: EstimatorGains = field(default_factory=EstimatorGains)

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

    def update(
        self,
        joint_positions: NDArray[np.float64],
        gyro: NDArray[np.float64],
        accelerometer: NDArray[np.float64],
        soles: Mapping[Side, SoleLoad],
        planned_acceleration: NDArray[np.float64] | None = None,
        airborne: Side | None = None,
    ) -> BaseState:
        """One control tick.

        Args:
            joint_positions: Encoder readings (k,) in rad.
            gyro: Angular velocity (3,) of the base in the base frame in rad/s.
            accelerometer: Specific force (3,) of the base in the base frame in m/s^2.
            soles: What each sole carries.
            planned_acceleration: Horizontal CoM acceleration (2,) in m/s^2 that the plan asks for; 0 where None.
            airborne: Foot that is high in the air by plan: what it reads there becomes its tare.

        Returns:
            The estimated state.
        """
        posture = self.kinematics.posture(joint_positions)
        if airborne is not None:
            share = min(1.0, self.period / self.gains.tare)
            self._tare[airborne] += share * (soles[airborne].vertical_force - self._tare[airborne])
        loads = {s: max(0.0, soles[s].vertical_force - self._tare[s]) for s in _SIDES}
        cops = {s: soles[s].position_cop_in_sole for s in _SIDES}
        if self._rotation is None or self._last is None:
            self._start(posture, accelerometer)
        else:
            self._turn(posture, gyro, accelerometer, loads, planned_acceleration)
            self._move(posture, loads, cops)
        rotation = self._rotation
        assert rotation is not None
        self._last, self._last_rotation = posture, rotation
        positions = {s: self._position + rotation.dot(posture.positions[s]) for s in _SIDES}
        rotations = {s: rotation.dot(posture.rotations[s]) for s in _SIDES}
        points: list[NDArray[np.float64] | None] = []
        for s in _SIDES:
            cop = cops[s]
            points.append(None if cop is None else (positions[s] + rotations[s][:, :2].dot(cop))[:2])
        zmp = zmp_of_feet(points, [loads[s] for s in _SIDES])
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
        up = accelerometer / float(np.linalg.norm(accelerometer))
        forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
        forward /= float(np.linalg.norm(forward))
        level = np.vstack([forward, np.cross(up, forward), up])
        turn = math.atan2(
            sum(math.sin(self.feet[s][3] - heading(level @ posture.rotations[s])) for s in _SIDES),
            sum(math.cos(self.feet[s][3] - heading(level @ posture.rotations[s])) for s in _SIDES),
        )
        c, s = math.cos(turn), math.sin(turn)
        self._rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ level
        self._position = np.mean(
            [np.array(self.feet[s][:3]) - self._rotation @ posture.positions[s] for s in _SIDES], axis=0
        )
        self._com = self._position + self._rotation @ posture.com
        for side in _SIDES:
            self._heading[side] = self.feet[side][3]

    def _turn(
        self,
        posture: Posture,
        gyro: NDArray[np.float64],
        accelerometer: NDArray[np.float64],
        loads: Mapping[Side, float],
        planned_acceleration: NDArray[np.float64] | None,
    ) -> None:
        assert self._rotation is not None
        rotation = self._rotation
        rate = gyro.copy()
        # Gravity: the specific force minus the body's acceleration points up.
        specific = rotation.dot(accelerometer)
        if planned_acceleration is not None:
            specific[:2] -= planned_acceleration
        size = math.sqrt(float(specific.dot(specific)))
        if 0.7 * GRAVITY < size < 1.3 * GRAVITY:
            x, y, _ = specific.tolist()
            tilt = np.array([y / size, -x / size, 0.0])  # specific x up
            # While the robot holds still, the running mean of what came so far; then a slow filter. (Balance control
            # has to wait that long: it would sway the robot by a wrong tilt and the sway would look like more tilt.)
            self._samples += 1
            since = self.period * (self._samples + 1)
            gain = 1.0 / since if since < self.gains.averaging else self.gains.gravity
            rate += gain * rotation.T.dot(tilt)
        total = 0.0
        error = 0.0
        for side in _SIDES:
            if loads[side] <= self.gains.minimum_load:
                self._heading[side] = None
                continue
            yaw = heading(rotation.dot(posture.rotations[side]))
            held = self._heading[side]
            if held is None:
                self._heading[side] = held = yaw
            weight = loads[side] - self.gains.minimum_load
            error += weight * math.remainder(held - yaw, 2.0 * math.pi)
            total += weight
        if total > 0.0:
            rate += (self.gains.yaw * error / total) * rotation[2]
        self._rotation = _orthonormal(rotation.dot(rotation_from_vector(rate * self.period)))

    def _move(
        self,
        posture: Posture,
        loads: Mapping[Side, float],
        cops: Mapping[Side, NDArray[np.float64] | None],
    ) -> None:
        assert self._rotation is not None
        assert self._last is not None
        shift = np.zeros(3)
        total = 0.0
        for side in _SIDES:
            cop = cops[side]
            weight = loads[side] - self.gains.minimum_load
            if cop is None or weight <= 0.0:
                continue
            before = self._last.positions[side] + self._last.rotations[side][:, :2].dot(cop)
            now = posture.positions[side] + posture.rotations[side][:, :2].dot(cop)
            shift += weight * (self._last_rotation.dot(before) - self._rotation.dot(now))
            total += weight
        if total > 0.0:
            self._position = self._position + shift / total
        else:
            self._position = self._position + self.period * self._velocity

    def _observe(self, com: NDArray[np.float64], zmp: NDArray[np.float64] | None) -> None:
        acceleration = np.zeros(3)
        if zmp is not None:
            acceleration[:2] = self.omega**2 * (self._com[:2] - zmp)
        self._com = self._com + self.period * self._velocity
        self._velocity = self._velocity + self.period * acceleration
        error = com - self._com
        b = self.gains.observer
        self._com = self._com + min(1.0, 2.0 * b * self.period) * error
        self._velocity = self._velocity + min(1.0, b * b * self.period) * error
