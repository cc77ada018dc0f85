"""From a tick's readings to the body's state."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record
from plantar.common.sides import SIDES, Side
from plantar.gait.command import Sensors
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.estimate.dcm_filter import DcmFilter
from plantar.gait.estimate.estimator import FloatingBaseEstimator, LegKinematics, SoleLoad
from plantar.gait.estimate.gyro_bias import GyroBias
from plantar.gait.estimate.identified_body import IdentifiedBody
from plantar.gait.estimate.push_estimate import PushEstimate
from plantar.gait.estimate.skin_load import percept_to_its_limit
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import UP, Phase, PhaseKind
from plantar.kernels.gait.gyro_bias import SteadyLoad
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.external_wrench import external_acceleration
from plantar.mechanics.lip import GRAVITY, pendulum_frequency
from plantar.percepts.percept import Percept
from plantar.sensing.net_wrench import net_wrench


class Sensed(Record, frozen=True):
    """A reading that all parts share: of a `time` in s, its joints `sampled` then or before."""

    time: float
    sampled: float
    phase: Phase
    percepts: Mapping[Side, Percept]
    ankles: Mapping[Side, SoleWrench]
    soles: Mapping[Side, SoleLoad]


class Estimation:
    """Body state, and the robot's differences from its model.

    `omega`: pendulum's in rad/s; `body`: identified differences; None believes the model; `stands`: whether still
    averaging the initial stand, before feedback.
    """

    def __init__(
        self,
        settings: ControllerSettings,
        feet: Mapping[Side, Footstep],
        layouts: Mapping[Side, SoleLayout],
        kinematics: LegKinematics,
    ) -> None:
        self._settings = settings
        self._layouts = layouts
        period = settings.period
        self.omega = pendulum_frequency(settings.com_height, 2.0 * settings.leg_inertia.turning)
        self.stands = True
        self._ticks = 0
        self._state: BaseState | None = None
        self._rotations: Mapping[str, NDArray[np.float64]] = {s: feet[s].rotation_sole_to_world for s in SIDES}
        places: Mapping[Side, tuple[float, float, float, float]] = {
            s: (feet[s].x, feet[s].y, feet[s].z, feet[s].yaw) for s in SIDES
        }
        self.body: IdentifiedBody | None = None
        bias = None
        steady = None
        rules = settings.identification
        if rules is not None:
            self.body = IdentifiedBody(kinematics, settings.mass * GRAVITY, places, rules, period)
            if rules.gyro:
                bias = GyroBias(period, rules.gyro_time, rules.gyro_largest, rules.gyro_piece, rules.gyro_slip)
                steady = SteadyLoad(rules.steady_share, min(1.0, period / rules.steady_time), rules.steady_band)
        self.estimator = FloatingBaseEstimator(
            kinematics if self.body is None else self.body,
            self.omega,
            period,
            places,
            settings.estimator,
            bias,
            steady,
            None if settings.push_estimate is None else PushEstimate(settings.push_estimate, period),
            None if settings.dcm_filter is None else DcmFilter(settings.dcm_filter, self.omega, period),
            settings.leg_inertia,
        )

    def summary(self) -> dict[str, object]:
        """The robot's identified differences from its model."""
        bias = self.estimator.gyro_bias
        found: dict[str, object] = {} if bias is None else {"gyro_bias_rad_s": bias.value.round(6).tolist()}
        return found if self.body is None else {**found, **self.body.summary()}

    def sense(self, sensors: Sensors, phase: Phase) -> Sensed:
        """Returns what `sensors` of soles and ankles measure in a phase, taxel forces clipped at their limit."""
        readings = sensors.readings
        layouts = self._layouts
        percepts: dict[Side, Percept] = {
            "left": percept_to_its_limit(readings["left"], layouts["left"]),
            "right": percept_to_its_limit(readings["right"], layouts["right"]),
        }
        ankles: dict[Side, SoleWrench] = {}
        if sensors.ankles:
            for side, sensor in self._settings.ankles.items():
                if side in sensors.ankles:
                    ankles[side] = sensor.sole_wrench(sensors.ankles[side], self._rotations[side])
        soles: Mapping[Side, SoleLoad] = ankles if self._settings.zmp_source == "force_torque" else percepts
        sampled = sensors.time if sensors.sampled is None else sensors.sampled
        return Sensed(sensors.time, sampled, phase, percepts, ankles, soles)

    def update(
        self, sensors: Sensors, sensed: Sensed, acceleration: NDArray[np.float64], swing: NDArray[np.float64]
    ) -> BaseState:
        """Returns the state by `sensors`, `sensed` and planned `acceleration` (2,) in m/s^2 of CoM and `swing` foot."""
        s = self._settings
        phase = sensed.phase
        self._ticks += 1
        self.stands = self._ticks * s.period <= s.estimator.averaging
        if self.body is not None:
            self._identify(self.body, sensors, sensed)
        # Of its usual length: a single support that is made longer holds a foot that has landed.
        share = (sensors.time - phase.start) / s.timing.single_support if phase.swing is not None else 0.0
        state = self.estimator.update(
            sensors.joint_positions,
            sensors.gyro,
            sensors.accelerometer,
            sensed.soles,
            acceleration,
            phase.swing if UP[0] < share < UP[1] and s.zmp_source == "skin" else None,  # in the air: it finds its zero
            self.push_on_skin(sensors),
            swing,
        )
        if self.body is not None and self.body.known and phase.kind == PhaseKind.STANDING:
            self.body.rest(state)
        self._rotations = state.rotations_sole
        self._state = state
        return state

    def _identify(self, body: IdentifiedBody, sensors: Sensors, sensed: Sensed) -> None:
        if self.stands:
            body.stand(sensors.joint_positions, sensors.accelerometer, sensed.soles)
        elif body.known:
            body.advance()
        else:
            body.conclude()
            self.estimator.stand_again(sensors.joint_positions)

    def push_on_skin(self, sensors: Sensors) -> NDArray[np.float64] | None:
        """CoM acceleration (2,) in m/s^2 by the upper body's skin, or None."""
        s = self._settings
        state = self._state
        if s.push_felt is None or s.skin is None or sensors.skin is None or state is None:
            return None
        # Where the body was a tick ago: it has moved by a millimetre since.
        place = state.position_base
        turn = state.rotation_base_to_world
        poses = dict.fromkeys(s.skin.links, (place, turn))
        poses |= {link: (place + turn @ at, turn @ rotation) for link, (at, rotation) in sensors.links.items()}
        push = net_wrench(s.skin, sensors.skin, poses, state.com, s.push_felt)
        return external_acceleration(push.wrench, s.mass, self.omega) if len(push.taxels) else None
