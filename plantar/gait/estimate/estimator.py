"""Floating-base state from encoders, IMU and soles.

The gyro is integrated; gravity, less planned acceleration, corrects roll and pitch, loaded feet the yaw. The material
point at each loaded sole's center of pressure is at rest, which gives position. CoM velocity: observer of x'' = w^2 (x
- p), or `dcm_filter`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.common.record import Record
from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, share
from plantar.common.sides import SIDES
from plantar.errors import InputError
from plantar.gait.estimate.dcm_filter import DcmFilter
from plantar.gait.estimate.encoder_offsets import standing_base
from plantar.gait.estimate.gyro_bias import GyroBias
from plantar.gait.estimate.push_estimate import PushEstimate
from plantar.kernels.gait.floating_base import FloatingBase
from plantar.kernels.gait.gyro_bias import SteadyLoad
from plantar.layouts.layout import Side
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.leg_inertia import LegInertia
from plantar.mechanics.lip import GRAVITY


class Posture(Record, frozen=True):
    """Kinematics of a joint configuration, base (torso) frame.

    `com`: CoM (3,) in m; `positions`: sole origin (3,) of each foot in m; `rotations`: each sole to base (3, 3).
    """

    com: NDArray[np.float64]
    positions: Mapping[Side, NDArray[np.float64]]
    rotations: Mapping[Side, NDArray[np.float64]]


class SoleLoad(Protocol):
    """A sole's load, by taxels (`plantar.Percept`) or ankle (`SoleWrench`)."""

    @property
    def vertical_force(self) -> float:
        """Vertical force in N."""
        ...

    @property
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Center of pressure (2,), sole frame, in m; None without load."""
        ...

    @property
    def wrench_in_sole(self) -> NDArray[np.float64]:
        """Wrench (6,) about the sole's origin in N and N m."""
        ...


class LegKinematics(Protocol):
    """Kinematics that the estimator needs."""

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """Forward kinematics of joint positions (k,) in rad."""
        ...


@runtime_checkable
class LiveKinematics(LegKinematics, Protocol):
    """Kinematics that return the same arrays each call."""

    def live_posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """As `posture`, in arrays valid until the next call of either."""
        ...


@runtime_checkable
class MovingKinematics(LegKinematics, Protocol):
    """Kinematics that know how the soles move with the joints."""

    def sole_motions(self, joint_positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns what `encoder_offsets.SoleMotions` does, at joint positions (k,) in rad."""
        ...


def live_kinematics(kinematics: LegKinematics) -> Callable[[NDArray[np.float64]], Posture]:
    """A model's fastest kinematics, for callers that keep no posture."""
    return kinematics.live_posture if isinstance(kinematics, LiveKinematics) else kinematics.posture


_STILL = read_only(np.zeros(2))
# derived: leg, between two footholds of one height as they are estimated: twice the error of a step
_SAME_HEIGHT = 1 / 200
_ANCHOR = 0.5  # 1/beat, at which the base is drawn back to the height of its feet; chosen: 2 1/s on h1


class EstimatorGains(Part, table="estimator"):
    """Gains of the estimator.

    Attributes:
        gravity: Roll and pitch by the accelerometer in 1/s.
        yaw: Heading by the loaded feet in 1/s.
        observer: CoM velocity observer's bandwidth in rad/s, above the pendulum's.
    """

    # chosen: 0.2 1/s: a sway of a trunk averages out, a gyro's bias of 1e-3 rad/s leaves 5 mrad
    gravity: float = share(0.0495, "1/beat", 0, 50)
    # Initial time in s of standing still and averaging gravity; derived: 0.5 s, the noise of a hundred ticks
    averaging: float = fixed(2.02, "beat")
    yaw: float = share(0.495, "1/beat", 0, 50)  # chosen: 2 1/s on h1; bounded by soles that slip
    observer: float = share(4.95, "rad/beat", 0.1, 100)  # chosen: 20 rad/s on h1, above the pendulum's 3.5
    # Time constant in s of the zero of a foot in the air; chosen: 50 ms: ten ticks of noise
    tare: float = fixed(0.202, "beat")
    # Vertical force in N of a loaded foot, above the summed noise of unloaded taxels; feet are weighted by load beyond
    # it
    minimum_load: float = fixed(0.083, "weight")  # derived: `contact_force` of a landing, 70 N on h1


@dataclass
class FloatingBaseEstimator:
    """Estimator of the floating base.

    Attributes:
        omega: Pendulum's in rad/s.
        period: Of control in s.
        feet: Initial standing pose (x, y, z, yaw) of each sole.
        gyro_bias: Gyro bias, correcting earlier heading too; None disables both.
        steady: Selects still feet for the gyro; None takes all loaded.
        push: Push by soles and IMU; None disables it.
        dcm_filter: Horizontal CoM and velocity; None uses the observer.
        push_acceleration: CoM's (2,) in m/s^2 by a push now.
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
    legs: LegInertia = field(default_factory=LegInertia)

    def __post_init__(self) -> None:
        gains = self.gains
        if not gains.observer > self.omega:  # its poles lie at -observer +- omega
            raise InputError(
                f"estimator.observer is {gains.observer:g} rad/s; allowed: more than {self.omega:.3g} rad/s, as fast "
                "as a pendulum of this height falls: what is slower runs away with it"
            )
        self._rotation = np.eye(3)
        self._position = np.zeros(3)
        self._com = np.zeros(3)
        self._velocity = np.zeros(3)
        self._places = np.zeros((2, 3))
        # The kernel writes the state into these arrays.
        state = (
            *(self._rotation, self._position, self._com, self._velocity),
            *(self._places, np.zeros((2, 3, 3)), np.zeros(2), np.zeros(3)),
        )
        self._base = FloatingBase(
            self.omega,
            self.period,
            GRAVITY,
            (gains.averaging, gains.gravity, gains.yaw, gains.observer, gains.minimum_load),
            state,
            None if self.gyro_bias is None else self.gyro_bias.kernel,
            self.steady,
            None if self.push is None else self.push.kernel,
            (self.legs.share, self.omega**2 * self.legs.turning),
            (_SAME_HEIGHT * gains.body.leg, min(1.0, self.period * _ANCHOR / gains.body.beat)),
        )
        self._begun = False
        self._posture = live_kinematics(self.kinematics)
        self._watched: Posture | None = None
        self._tare: dict[Side, float] = {"left": 0.0, "right": 0.0}
        self.push_acceleration = np.zeros(2)
        self._turning = self.omega**2 * self.legs.turning

    def update(
        self,
        joint_positions: NDArray[np.float64],
        gyro: NDArray[np.float64],
        accelerometer: NDArray[np.float64],
        soles: Mapping[Side, SoleLoad],
        planned_acceleration: NDArray[np.float64] = _STILL,
        airborne: Side | None = None,
        felt: NDArray[np.float64] | None = None,
        swing: NDArray[np.float64] = _STILL,
    ) -> BaseState:
        """Estimated state after a tick.

        Args:
            joint_positions: Encoders (k,) in rad.
            gyro: Angular velocity (3,) of the base, base frame, in rad/s.
            accelerometer: Specific force (3,) of the base, base frame, in m/s^2.
            planned_acceleration: CoM's (2,) in m/s^2.
            airborne: Foot high in the air by plan: its reading becomes its tare.
            felt: CoM's by a push on skin, for `push`; None: soles.
            swing: That (2,) of the swinging foot.
        """
        posture = self._posture(joint_positions)
        if airborne is not None:
            # The foot is in the air: all that it measures is drift, which is taken off the loads to come.
            share = min(1.0, self.period / self.gains.tare)
            self._tare[airborne] += share * (soles[airborne].vertical_force - self._tare[airborne])
        base = self._base
        left_sole = soles["left"]
        right_sole = soles["right"]
        tare = self._tare
        loads: dict[str, float] = {
            "left": base.load(0, left_sole.vertical_force, tare["left"], left_sole.position_cop_in_sole),
            "right": base.load(1, right_sole.vertical_force, tare["right"], right_sole.position_cop_in_sole),
        }
        if posture is not self._watched:
            self._watch(posture)
        if self._begun:
            zmp = base.step(gyro, accelerometer, planned_acceleration, swing)
        else:
            self._begun = True
            # The robot stands still at the start, so the specific force is gravity alone.
            base.take()
            self._stand(posture, accelerometer / float(np.linalg.norm(accelerometer)))
            zmp = base.place()
        base.settle(accelerometer, planned_acceleration, swing, felt)
        if self.push is not None:
            self.push_acceleration = self.push.acceleration if felt is None else felt
        if self.dcm_filter is not None:
            self._filter(self.dcm_filter, posture, zmp, self._turning * swing)
        rotation, position, com, velocity, left, right, turn_left, turn_right = base.snapshot()
        return BaseState(
            rotation,
            position,
            com,
            velocity,
            zmp,
            loads,
            {"left": left, "right": right},
            {"left": turn_left, "right": turn_right},
        )

    def stand_again(self, joint_positions: NDArray[np.float64]) -> None:
        """Reset to the known footholds after corrected kinematics; `joint_positions` (k,) in rad."""
        if not self._begun:
            return
        posture = self.kinematics.posture(joint_positions)
        self._watch(posture)
        self._base.take()
        self._stand(posture, self._rotation[2].copy())
        self._base.rest()

    def _watch(self, posture: Posture) -> None:
        self._watched = posture
        places = posture.positions
        turns = posture.rotations
        self._base.watch(posture.com, places["left"], places["right"], turns["left"], turns["right"])

    def _stand(self, posture: Posture, up: NDArray[np.float64]) -> None:
        """Level the base by a unit vector (3,) against gravity, over the known footholds."""
        rotation, position = standing_base(posture, up, self.feet)
        self._base.stand(rotation, position, *(self.feet[side][3] for side in SIDES))
        if self.dcm_filter is not None:
            self.dcm_filter.reset()

    def _filter(
        self, dcm_filter: DcmFilter, posture: Posture, zmp: NDArray[np.float64] | None, swinging: NDArray[np.float64]
    ) -> None:
        com = self._position + self._rotation.dot(posture.com)
        filtered = dcm_filter.update(com[:2], zmp, (self.push_acceleration + swinging) / self.omega**2)
        self._com[:2] = filtered.com
        self._velocity[:2] = self.omega * (filtered.dcm - filtered.com)
