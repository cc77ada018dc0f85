"""Walking controller: the one file that wires the rooms into a control tick.

    sense -> estimate -> swing -> propose -> decide -> apply -> balance -> feet

The swing foot is advanced before anybody proposes, since most of what is proposed follows from its touchdown.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.arrays import read_only
from plantar.errors import InputError
from plantar.gait.balance.balance_laws import balance_law
from plantar.gait.balance.law import Feet, FootAction, FootState
from plantar.gait.balance.open_loop import OpenLoop
from plantar.gait.command import Command, FootTarget, Sensors
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.foot_contacts import FootContacts, middle_of_sole
from plantar.gait.contact.support_strip import SupportStrip
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.estimate.body_sensors import BodySensors
from plantar.gait.estimate.com_height import CoMHeight
from plantar.gait.estimate.command_frame import CommandFrame
from plantar.gait.estimate.dcm_filter import DcmFilter
from plantar.gait.estimate.estimator import FloatingBaseEstimator, LegKinematics, SoleLoad
from plantar.gait.estimate.gyro_bias import GyroBias
from plantar.gait.estimate.identified_body import IdentifiedBody
from plantar.gait.estimate.push_estimate import PushEstimate
from plantar.gait.estimate.skin_load import percept_to_its_limit
from plantar.gait.estimate.sole_slope import SoleSlope
from plantar.gait.estimate.steady_load import SteadyLoad
from plantar.gait.estimate.wrench_filter import WrenchFilter
from plantar.gait.feet.foot_motion import FootMotion, SoleSense
from plantar.gait.feet.ground_conformity import GroundConformity
from plantar.gait.feet.landing_compliance import DampingGains, LandingCompliance
from plantar.gait.feet.posture_compensation import PostureCompensation
from plantar.gait.feet.swing_compliance import SwingCompliance
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase, PhaseKind, WalkSchedule
from plantar.gait.plan.plan_change import AppliedChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.decide import decide
from plantar.gait.propose.double_support_timing import DoubleSupportTiming
from plantar.gait.propose.edge_beside import EdgeBeside
from plantar.gait.propose.foothold_found import FootholdCarries
from plantar.gait.propose.foothold_refused import StepGuard
from plantar.gait.propose.foothold_seen import FootholdSeenAhead
from plantar.gait.propose.learned_stride import LearnedStride
from plantar.gait.propose.proposer import Pendulum, Proposer, Tick
from plantar.gait.propose.slope_inside import SlopeInside, inward_distance
from plantar.gait.propose.ssp_opt import touching_distance
from plantar.gait.propose.step_adjustment import StepAdjustment
from plantar.gait.propose.step_timing import StepTiming
from plantar.gait.safety.shell import SafetyShell
from plantar.gait.safety.standing_command import standing_command
from plantar.geometry.contact_rectangle import safe_rectangle
from plantar.kernels.base.vectors import matrix, vector, vector2
from plantar.kernels.gait import lean_correction
from plantar.kernels.gait.sole_targets import risen, turned
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.contact import Contact
from plantar.mechanics.external_wrench import external_acceleration
from plantar.mechanics.lip import GRAVITY, pendulum_frequency
from plantar.mechanics.rotation import heading, level_rotation
from plantar.mechanics.wrench_cone import Rectangle
from plantar.percepts.percept import Percept
from plantar.record import Record
from plantar.sensing.net_wrench import net_wrench
from plantar.sides import SIDES, Side, other_side

__all__ = ["Command", "FootTarget", "Sensors", "Start", "WalkingController"]

_CONTACT_OFFSET = 0.0433  # sole that a foot's centre of pressure keeps from the edge of its contact: 10 mm in T 4.4.4
_NOWHERE = read_only(np.zeros(2))  # no push
_ANYWHERE = np.empty((0, 2))  # a region that leaves the desired ZMP free
_PROBING = 0.0237  # weight on a foot that probes the ground from which its centre of pressure turns it
_NO_GROUND = 0.8  # of the taxels' sensing range: a sole that stands sees this far only where it stands on nothing
_FOLLOWS_GROUND = 1.98  # rad/beat, natural frequency of the CoM's height over ground that goes up and down
_BRIDGED = 0.2  # beats without encoders or IMU: a DCM that nobody follows is a fifth farther off by then
_BESIDE = 0.25  # leg that a foot that has landed beside its place is commanded away from it at most
_NO_WAY = 1 / 12  # leg: a walk that is shorter has no direction of its own


@dataclass(frozen=True)
class Start:
    """How a walk begins.

    Attributes:
        feet: Where the feet stand.
        steps: The footsteps that are known, in order; others may come later.
        time: Time in s at which it begins.
        commands: Who else may change the plan while it is walked, such as a user's velocity command.
    """

    feet: Mapping[Side, Footstep]
    steps: tuple[Footstep, ...] = ()
    time: float = 1.0
    commands: tuple[Proposer, ...] = ()


class _Sensed(Record, frozen=True):
    """One reading, which all parts of a tick share."""

    time: float
    phase: Phase
    percepts: Mapping[Side, Percept]
    ankles: Mapping[Side, SoleWrench]
    soles: Mapping[Side, SoleLoad]


class WalkingController:
    """Walks a footstep plan on plantar feedback.

    Args:
        settings: Settings.
        start: How the walk begins.
        layouts: Sole layout of each side.
        kinematics: Forward kinematics of the robot.
    """

    def __init__(
        self,
        settings: ControllerSettings,
        start: Start,
        layouts: Mapping[Side, SoleLayout],
        kinematics: LegKinematics,
    ) -> None:
        self.settings = settings
        self.layouts = layouts
        self.omega = pendulum_frequency(settings.com_height)
        self.replans = 0
        feet, period = start.feet, settings.period
        middles = {side: middle_of_sole(layouts[side], settings.ankle_reach) for side in SIDES}
        self.plan = WalkPlan(feet, start.steps, settings.timing, middles, self.omega, start.time)
        self.balance = balance_law(settings.gains, self.omega, settings.mass, period)
        self._open_loop = OpenLoop(settings.mass)
        self._rectangle_of: dict[Side, tuple[NDArray[np.float64], Rectangle]] = {}
        self._contact_of: dict[Side, tuple[NDArray[np.float64], tuple[object, ...], Contact]] = {}
        stands: Mapping[Side, tuple[float, float, float, float]] = {
            s: (feet[s].x, feet[s].y, feet[s].z, feet[s].yaw) for s in SIDES
        }
        self.body: IdentifiedBody | None = None
        if settings.identification is not None:
            weight = settings.mass * GRAVITY
            self.body = IdentifiedBody(kinematics, weight, stands, settings.identification, period)
        self.estimator = FloatingBaseEstimator(
            kinematics if self.body is None else self.body,
            self.omega,
            period,
            stands,
            settings.estimator,
            *self._gyro_bias(),
            None if settings.push is None else PushEstimate(settings.push, period),
            None if settings.dcm_filter is None else DcmFilter(settings.dcm_filter, self.omega, period),
        )
        self._state: BaseState | None = None
        self._hearing = BodySensors(period, _BRIDGED * settings.body.beat)
        self._last: Command | None = None
        self._lost = False
        self._fine = 6000.0 / settings.body.leg
        adjustment = settings.step_adjustment
        self._least_lean = max(settings.trunk_lean, 0.0 if adjustment is None else adjustment.lean)
        self._push = WrenchFilter(settings.push_expected, self.omega, period)
        gains, loads = settings.compliance, settings.touchdown
        compliance = None
        if gains is not None:
            compliance = {s: SwingCompliance(layouts[s], gains, loads, settings.ground_map) for s in SIDES}
        self.motion = FootMotion(feet, period, settings.swing_height, settings.landing, compliance, settings.swing_fit)
        reach, sight = settings.ankle_reach, settings.ground_map.sensing_range
        self.contacts = FootContacts(settings.contact, layouts, reach, self._ankle_limits(), sight)
        damping = DampingGains().for_body(settings.body)
        self._damping = {side: LandingCompliance(period, damping) for side in SIDES}
        blind = settings.footholds == "force" and settings.compliance is None
        self._slope = SoleSlope(settings.estimator.minimum_load) if blind else None
        self._frame = CommandFrame(feet["left"].position, period, settings.alignment_time)
        self._ticks = 0
        self._rotations_sole: Mapping[str, NDArray[np.float64]] = {s: feet[s].rotation_sole_to_world for s in SIDES}
        self._compensation = PostureCompensation.for_body(settings.body, period, 0.7 * settings.timing.double_support)
        ground = float(np.mean([feet[s].z for s in SIDES]))
        self._ground = CoMHeight(ground, period, _FOLLOWS_GROUND / settings.body.beat)
        self.guard, self.conformity = self._for_unknown_ground(middles)
        self._proposers = self._asked(start, middles)
        self.shell: SafetyShell | None = self._guarded(start)

    def _guarded(self, start: Start) -> SafetyShell:
        """What guards the tick; a controller whose `shell` is None runs without."""
        s, layouts = self.settings, self.layouts
        stands = standing_command(start.feet, self.plan, layouts, s.mass * GRAVITY, s.com_height, start.time - 1.0)
        return SafetyShell(self._ticked, stands, layouts, None, s.period, s.mass, s.body.leg, s.com_height)

    def identified(self) -> dict[str, object]:
        """What was identified of the robot's differences from its model, for a run's summary."""
        bias = self.estimator.gyro_bias
        found: dict[str, object] = {} if bias is None else {"gyro_bias_rad_s": bias.value.round(6).tolist()}
        return found if self.body is None else {**found, **self.body.summary()}

    def _ankle_limits(self) -> Mapping[Side, AnkleLimits]:
        margin = self.settings.gains.zmp_offset
        return {side: AnkleLimits(strips, margin) for side, strips in self.settings.ankle_limits.items()}

    def _gyro_bias(self) -> tuple[GyroBias | None, SteadyLoad | None]:
        """What identifies the gyro's bias, and which feet it goes by, where the settings want it."""
        rules, period = self.settings.identification, self.settings.period
        if rules is None or not rules.gyro:
            return None, None
        bias = GyroBias(period, rules.gyro_time, rules.gyro_largest, rules.gyro_piece, rules.gyro_slip)
        return bias, SteadyLoad(period, rules.steady_share, rules.steady_time, rules.steady_band)

    def _for_unknown_ground(
        self, middles: Mapping[Side, NDArray[np.float64]]
    ) -> tuple[StepGuard | None, GroundConformity | None]:
        """Who checks footholds, and who turns soles to the ground's shape, where the settings want them."""
        s = self.settings
        if s.feasibility is not None and s.compliance is None:
            raise InputError("step feasibility needs preemptive foot compliance; give its gains too")
        if s.conformity is not None and s.compliance is None:
            raise InputError("feet that take the ground's shape need preemptive foot compliance; give its gains too")
        guard = None if s.feasibility is None else StepGuard(s.feasibility, self.layouts)
        conformity = None
        if s.conformity is not None:
            turns_stance = not self.balance.wants_contacts
            conformity = GroundConformity(s.conformity, self.layouts, middles, s.period, turns_stance)
        return guard, conformity

    def _asked(self, start: Start, middles: Mapping[Side, NDArray[np.float64]]) -> Sequence[Proposer]:
        """Who may propose changes of the plan, in the order in which they are asked."""
        body = self.settings.body
        begin = self.plan.at(start.time - 1.0).com
        way = self.plan.end - begin
        length = float(np.hypot(*way))
        forward = np.array([math.cos(start.feet["left"].yaw), math.sin(start.feet["left"].yaw)])
        strip = SupportStrip.for_body(body, begin, way / length if length > _NO_WAY * body.leg else forward)
        rules, outlines = self.settings.foothold, {side: self.layouts[side].outline for side in SIDES}
        on_ground: list[Proposer] = [
            SlopeInside(),
            FootholdSeenAhead(rules),
            FootholdCarries(rules, middles, outlines, strip, self.settings.ankle_reach),
        ]
        if self.settings.compliance is not None and self.settings.footholds == "off":
            drop = _NO_GROUND * self.settings.ground_map.sensing_range
            on_ground.append(EdgeBeside(self.layouts, drop, rules.largest_shift))
        on_ground += self._for_balance()
        return (*([] if self.guard is None else [self.guard]), *on_ground, *start.commands)

    def _for_balance(self) -> list[Proposer]:
        """Who may propose other footsteps, or other times of them, by where the DCM is."""
        s = self.settings
        if s.step_adjustment is None:
            return [] if s.step_timing is None else [StepTiming(s.step_timing, s.period)]
        touching = touching_distance({side: layout.outline for side, layout in self._soles()})
        timing = None if s.step_timing is None else StepTiming(s.step_timing, s.period)
        rules = s.step_adjustment, s.step_region, touching, s.step_weights, s.ankle_strategy
        steps = StepAdjustment(*rules, s.period, timing)
        found: list[Proposer] = [steps]
        if s.step_adjustment.double_support:
            confidence = s.step_adjustment.confidence
            found.append(DoubleSupportTiming(s.double_support_timing, s.dsp_weights, confidence, s.period))
        if s.learned_stride is not None:
            found.append(LearnedStride(s.learned_stride))
        return found

    @property
    def schedule(self) -> WalkSchedule:
        """The phases of the walk as planned now."""
        return self.plan.schedule

    @property
    def end(self) -> float:
        """Time in s at which the walk is over and the robot has settled."""
        return self.schedule.end

    @property
    def stopped(self) -> bool:
        """Whether it has stopped the walk for good; `safe_state` says why."""
        return self.safe_state is not None

    @property
    def safe_state(self) -> str | None:
        """The state in which it stays because it cannot go on, None while it walks (docs/safety.md).

        "no way on": no footstep is left that may be stepped on, and it stands; "blind": encoders, IMU or soles cannot
        be taken, and "lost": the CoM would have to be farther beside the feet than it is high: it holds its last
        command; "late": times are no numbers; "fallen": its feet are let go of.
        """
        if self.shell is not None and self.shell.state is not None:
            return self.shell.state
        if self._hearing.blind:
            return "blind"
        if self._lost:
            return "lost"
        return "no way on" if self.guard is not None and self.guard.stopped else None

    @property
    def proximity_sides(self) -> tuple[Side, ...]:
        """Feet whose proximity it wants to have at the next tick."""
        sides = self.motion.proximity_sides
        last = self.motion.last_side
        looks = self.settings.footholds == "skin" and not self.motion.landed and self.motion.comes_down
        return (*sides, last) if looks and last is not None and last not in sides else sides

    def step(self, sensors: Sensors) -> Command:
        """One control tick: sensors in, command out; it never raises while its `shell` guards it."""
        return self._ticked(sensors) if self.shell is None else self.shell.step(sensors)

    def _ticked(self, sensors: Sensors) -> Command:
        """A tick of sensors that can be; one that is blind or lost commands what it did last."""
        told = (sensors.joint_positions, sensors.gyro, sensors.accelerometer)
        heard = self._hearing.heard(told)
        if heard is None or self._lost:
            return self._held()
        if heard is not told:
            joints, gyro, accelerometer = heard
            sensors = sensors.changed(joint_positions=joints, gyro=gyro, accelerometer=accelerometer)
        command = self._stepped(sensors)
        self._lost = self._last is not None and self._is_lost(command)
        if self._lost:
            return self._held()
        self._last = command
        return command

    def _held(self) -> Command:
        """What was commanded last, without what was new then."""
        assert self._last is not None
        return self._last.changed(footholds=(), moved_steps=())

    def _is_lost(self, command: Command) -> bool:
        """Whether the CoM is to be farther beside the feet than it is high: no leg holds that."""
        left, right = command.feet["left"].position, command.feet["right"].position
        (x, y, _), (lx, ly, _), (rx, ry, _) = command.com.tolist(), left.tolist(), right.tolist()
        away = math.hypot(x - 0.5 * (lx + rx), y - 0.5 * (ly + ry))
        return away > self.settings.com_height

    def _stepped(self, sensors: Sensors) -> Command:
        """A tick whose encoders and IMU are there."""
        time = sensors.time
        sensed = self._sense(sensors)
        self._ticks += 1
        stands = self._ticks * self.settings.period <= self.settings.estimator.averaging
        if self.body is not None:
            self._identify(self.body, stands, sensors, sensed)
        state = self._estimate(sensors, sensed)
        feedback = self.settings.feedback and not stands
        if feedback:
            self._align(state)
        feet, inward = self._swing(sensed, state, feedback)
        (x, y, _), (vx, vy, _) = state.com.tolist(), state.com_velocity.tolist()
        xi = vector2(x + vx / self.omega, y + vy / self.omega)  # T 4.27, of an omega that is known to be sound
        tick, region = self._perceive(sensed, state, feet, inward, xi if feedback else None)
        change = decide(self._proposers, tick)
        applied = None
        if change is not None:
            applied = self.plan.apply(change, time, region)
            feet = self._take_over(applied)
        phase, reference = tick.phase, self.plan.at(time)
        if applied is not None:
            phase = self.schedule.at(time)
            region = self._zmp_region(phase, feet)
        law = self.balance if feedback else self._open_loop
        balanced = law.update(reference, xi, state.zmp, region if feedback else _ANYWHERE)
        if feedback:
            self._conform(phase, balanced.zmp_desired, state, sensed)
        com, torso, posture = self._body(phase, balanced.com)
        # Before the first step the feet stand as they were put, and press against each other by nothing.
        rests = feedback and phase.kind == PhaseKind.STANDING and phase.step > 0
        stand = self._feet(phase, sensed.soles, law.wants_contacts, rests)
        targets = self._targets(stand, law.act(balanced, stand))
        if feedback:
            self._compensate(targets, phase, com, torso, posture, state)
        return Command(
            com=com if self.body is None else com - posture.dot(self.body.com_shift),
            rotation_torso=posture,
            feet=targets,
            phase=phase,
            reference=reference,
            zmp_desired=balanced.zmp_desired,
            state=state,
            dcm=xi,
            percepts=sensed.percepts,
            ankle_loads=sensed.ankles,
            footholds=tick.found,
            moved_steps=() if applied is None else applied.moved,
            joint_offsets=None if self.body is None else self.body.joint_offsets,
        )

    def _identify(self, body: IdentifiedBody, stands: bool, sensors: Sensors, sensed: _Sensed) -> None:
        """Find out in the opening stand how the robot differs from its model, and go by that afterwards."""
        if stands:
            body.stand(sensors.joint_positions, sensors.accelerometer, sensed.soles)
        elif body.known:
            body.advance()
        else:
            body.conclude()
            self.estimator.stand_again(sensors.joint_positions)

    def _sense(self, sensors: Sensors) -> _Sensed:
        """What soles and ankles say, with each taxel's force clipped at its limit."""
        s = self.settings
        readings, layouts = sensors.readings, self.layouts
        percepts: dict[Side, Percept] = {
            "left": percept_to_its_limit(readings["left"], layouts["left"]),
            "right": percept_to_its_limit(readings["right"], layouts["right"]),
        }
        ankles: dict[Side, SoleWrench] = {}
        if sensors.ankles:
            for side, sensor in s.ankles.items():
                if side in sensors.ankles:
                    ankles[side] = sensor.sole_wrench(sensors.ankles[side], self._rotations_sole[side])
        soles: Mapping[Side, SoleLoad] = ankles if s.zmp_source == "force_torque" else percepts
        return _Sensed(sensors.time, self.schedule.at(sensors.time), percepts, ankles, soles)

    def _soles(self) -> list[tuple[Side, SoleLayout]]:
        return [(side, self.layouts[side]) for side in SIDES]

    def _estimate(self, sensors: Sensors, sensed: _Sensed) -> BaseState:
        """The floating base; a foot that is high in the air by plan finds its zero."""
        s, phase = self.settings, sensed.phase
        # Of its usual length: a single support that is made longer holds a foot that has landed.
        share = (sensors.time - phase.start) / s.timing.single_support if phase.swing is not None else 0.0
        state = self.estimator.update(
            sensors.joint_positions,
            sensors.gyro,
            sensors.accelerometer,
            sensed.soles,
            self.plan.at(sensors.time).com_acceleration,
            phase.swing if 0.2 < share < 0.5 and s.zmp_source == "skin" else None,
            self._felt(sensors),
        )
        self._rotations_sole = state.rotations_sole
        self._state = state
        return state

    def _felt(self, sensors: Sensors) -> NDArray[np.float64] | None:
        """Acceleration (2,) of the CoM in m/s^2 by what skin on the upper body feels; None where it feels nothing."""
        s, state = self.settings, self._state
        if s.push_felt is None or s.skin is None or sensors.skin is None or state is None:
            return None
        # Where the body was a tick ago: it has moved by a millimetre since.
        place, turn = state.position_base, state.rotation_base_to_world
        poses = dict.fromkeys(s.skin.links, (place, turn))
        poses |= {link: (place + turn @ at, turn @ rotation) for link, (at, rotation) in sensors.links.items()}
        felt = net_wrench(s.skin, sensors.skin, poses, state.com, s.push_felt)
        return external_acceleration(felt.wrench, s.mass, self.omega) if len(felt.taxels) else None

    def _swing(self, sensed: _Sensed, state: BaseState, feedback: bool) -> tuple[FeetView, float]:
        """Advance the swing foot; where the feet are then, and by how much in m one that has just landed shall carry
        further inside."""
        phase, percepts = sensed.phase, sensed.percepts
        senses = None
        if self.settings.compliance is not None:
            senses = {s: SoleSense(percepts[s], state.positions_sole[s], state.rotations_sole[s]) for s in SIDES}
        target = None if phase.swing is None else self.plan.view.foothold(phase.step)
        heights = None
        if phase.kind == PhaseKind.STANDING:  # feet relax then
            heights = {s: state.positions_sole[s].item(2) for s in SIDES}
        self.motion.update(phase, sensed.time, target, state.loads, self._frame, senses, self._press(), heights)
        feet, slope = self.motion.view, self.settings.slope
        if feet.touchdown and feedback and self.settings.step_adjustment is not None:
            self._stand_beside(feet, state)
            feet = self.motion.view
        if feet.lift_off and feet.side is not None:
            self._compensation.start()
            self.contacts.lift_off(feet.side, phase.step)
            self._damping[feet.side].reset()
        inward = 0.0
        if feet.touchdown and feet.side is not None and self.settings.compliance is not None:
            rise = self.motion.outward_rise(feet.side)
            inward = inward_distance(feet.side, rise, slope.ankle_reach, self.settings.com_height)
            if inward:
                self.contacts.bear_inside(feet.side, inward)
        return feet, inward

    def _stand_beside(self, feet: FeetView, state: BaseState) -> None:
        """Command a foot that has landed beside its place to where it stands, where steps move for balance."""
        rules = self.settings.step_adjustment
        if rules is None or feet.side is None:
            return
        if state.loads[feet.side] <= self.settings.landing.contact_force:  # only the plan has it down
            return
        side, other, soles = feet.side, other_side(feet.side), state.positions_sole
        x, y = self._frame.to_command(soles[side][:2]).tolist()
        # A pelvis that sinks puts the foot down before its path does: it stands lower than it is commanded.
        z = feet.footholds[other][0].item(2) + (soles[side] - soles[other]).item(2)
        place, commanded = vector(x, y, z), feet.footholds[side][0]
        away = math.dist(place, commanded)
        if away > rules.misplaced:
            # Of a body that falls, or by encoders that err by degrees, a foot may seem to be anywhere.
            place = commanded + min(1.0, _BESIDE * self.settings.body.leg / away) * (place - commanded)
            self.motion.stand_at(side, place, heading(state.rotations_sole[side]) - self._frame.turn)
            self._compensation.keep(commanded - place)

    def _press(self) -> float | None:
        """Force in N that a foot that sees the ground holds in single support; None leaves it to its gains. A foot that
        probes presses as the probe wants it, whatever the ground's shape."""
        if self.guard is not None and self.guard.press is not None:
            return self.guard.press
        return None if self.conformity is None or not self.settings.feedback else self.conformity.gains.press

    def _perceive(
        self, sensed: _Sensed, state: BaseState, feet: FeetView, inward: float, dcm: NDArray[np.float64] | None
    ) -> tuple[Tick, NDArray[np.float64]]:
        """What the feet stand on, and all else that who proposes gets to know, by the DCM (2,) where balance is fed
        back; and where the desired ZMP may lie."""
        time, phase, percepts, settings = sensed.time, sensed.phase, sensed.percepts, self.settings
        looks = dcm is not None and settings.footholds != "off"
        self._damp(phase, sensed, state, feet, looks)
        found = self.contacts.find(phase, time, feet, state, percepts, self._slope) if looks else ()
        seen = self.contacts.find_ahead(phase, time, feet, state, percepts) if looks else None
        region, pendulum = self._zmp_region(phase, feet), None
        if dcm is not None and (settings.step_timing is not None or settings.step_adjustment is not None):
            pendulum = self._pendulum(phase, time, dcm, region)
        tick = Tick(
            time=time,
            phase=phase,
            plan=self.plan.view,
            feet=feet,
            frame=self._frame.now(),
            readings={side: percept.reading for side, percept in percepts.items()},
            loads=state.loads,
            moments={side: ankle.wrench_in_sole[3:5] for side, ankle in sensed.ankles.items()},
            found=found,
            seen=seen,
            inward=inward,
            pendulum=pendulum,
            firm=self.contacts.firm(phase.step),
        )
        return tick, region

    def _pendulum(self, phase: Phase, time: float, dcm: NDArray[np.float64], region: NDArray[np.float64]) -> Pendulum:
        """The pendulum now, with what a push is expected to do until the phase ends."""
        offset = pushed = _NOWHERE
        if self.settings.push is not None and self.settings.step_adjustment is not None:
            expected = self._push.update(self.estimator.push_acceleration / self.omega**2)
            if self._push.acts and phase.swing:
                offset = self._push.mean(max(0.0, phase.end - time))
                # xi' = w u_w, summed over the time that the low pass remembers.
                pushed = expected * (self.omega * self.settings.push_expected.time_constant)
        return Pendulum(self.omega, dcm, self.plan.at(time), self.plan.dcm_after(phase), region, offset, pushed)

    def _level(self, slope: SoleSlope, phase: Phase, state: BaseState) -> None:
        """Turn a foot that comes down blindly, or has just landed, parallel to the one that stands."""
        standing = phase.kind == PhaseKind.STANDING and phase.step == 0
        slope.update(state.rotations_sole, state.loads, standing)
        side = self.motion.last_side
        if side is None or not self.motion.comes_down:
            return
        landing, load = self.settings.landing, state.loads[side]
        if not landing.probing or load <= self.settings.estimator.minimum_load:
            self._damping[side].level(load, slope.slope(side), landing.levelling)

    def _damp(self, phase: Phase, sensed: _Sensed, state: BaseState, feet: FeetView, looks: bool) -> None:
        """Foot damping of feet that come to carry, once each: on its edge a sole shows no foothold, and makes a moment
        on the best of ground. One that does not see the ground comes down level, and is turned by its load from then
        on: towards the middle of what it is believed to stand on, so that all of that is loaded, or denied."""
        damped: dict[Side, tuple[SoleLoad, float]] = {}
        if looks and self._slope is not None:
            self._level(self._slope, phase, state)
        if looks and (self._slope is None or self.settings.landing.probing):
            coming = self.contacts.coming_to_carry(phase, sensed.time, feet)
            damped = {side: (sensed.percepts[side], self.settings.estimator.minimum_load) for side in coming}
        if self.guard is not None and self.guard.probing and phase.swing is not None:
            damped[phase.swing] = (sensed.soles[phase.swing], _PROBING * self.settings.body.weight)
        for side, (sole, least) in damped.items():
            cop = sole.position_cop_in_sole
            if cop is not None and state.loads[side] > least:
                self._damping[side].update(state.loads[side], cop, self.contacts.center(side))

    def _zmp_region(self, phase: Phase, feet: FeetView) -> NDArray[np.float64]:
        """Where the desired ZMP may lie: convex polygon (k, 2) in the world in m."""
        return self.contacts.zmp_region(phase, feet, self._frame.offset, self.settings.gains.zmp_offset)

    def _take_over(self, applied: AppliedChange) -> FeetView:
        """Let the feet follow a plan that has changed."""
        if not applied.change.following:  # steps that come one by one are no other plan
            self.replans += 1
        phase = self.schedule.at(applied.time)
        if phase.swing is not None:
            self.motion.aim(phase, applied.time, self.plan.view.foothold(phase.step), self._frame)
        return self.motion.view

    def _conform(self, phase: Phase, zmp: NDArray[np.float64], state: BaseState, sensed: _Sensed) -> None:
        """Turn the soles that stand to the ground's shape."""
        if self.conformity is None:
            return
        incoming = self._incoming(phase)
        turned = self.conformity.update(phase, incoming, zmp, state, sensed.percepts, self.motion.landed)
        for side, turn in turned.items():
            self.motion.turn_standing(side, *turn)

    def _incoming(self, phase: Phase) -> Side | None:
        """The standing foot that takes the weight over: not at the two ends of the walk."""
        plan = self.plan.view
        if not 0 < phase.step < plan.count:
            return None
        return phase.swing or other_side(plan.foothold(phase.step).side)

    def _body(self, phase: Phase, com: NDArray[np.float64]) -> tuple[NDArray[np.float64], float, NDArray[np.float64]]:
        """CoM (3,) in m, heading in rad and rotation (3, 3) of the torso in the command frame."""
        left, right = self.motion.footholds["left"][1], self.motion.footholds["right"][1]
        x, y = self._frame.to_command(com).tolist()
        target = vector(x, y, self._com_height(phase))
        torso = left + 0.5 * math.remainder(right - left, 2.0 * math.pi)
        return target, torso, self._posture(target, torso)

    def _feet(self, phase: Phase, soles: Mapping[Side, SoleLoad], contacts: bool, rests: bool) -> Feet:
        """The feet as a balance law sees them: those on the ground with contacts if it wants them, and with wrenches
        if it does or the robot rests."""
        states: dict[Side, FootState] = {}
        motion, crept = self.motion, self._crept() if contacts else ()
        for side in SIDES:
            level = rotation = motion.rotation(side)
            x, y = self._damping[side].turn.tolist()
            if x or y:
                rotation = turned(level, x, y)
            contact = wrench = None
            if (contacts or rests) and (phase.swing != side or motion.landed):
                contact = self._contact(side, crept) if contacts else None
                wrench = soles[side].wrench_in_sole
            center = self.contacts.center(side)
            states[side] = FootState(motion.footholds[side][0], level, rotation, center, contact, wrench)
        return Feet(states, phase.stance, self._frame, rests)

    def _targets(self, feet: Feet, actions: Mapping[Side, FootAction]) -> dict[Side, FootTarget]:
        """Pose and load of each sole: turned about its centre and shifted as the balance law has it give way."""
        targets: dict[Side, FootTarget] = {}
        for side, action in actions.items():
            foot, roll, pitch, shift = feet.states[side], action.roll, action.pitch, action.shift
            position, rotation = foot.position, foot.rotation
            if roll or pitch or shift:
                x, y = self._damping[side].turn.tolist()
                rotation = turned(foot.level, x + roll, y + pitch)
                position = risen(position, foot.center, roll, pitch, shift)
            targets[side] = FootTarget(position, rotation, action.force, action.center_of_pressure)
        return targets

    def _compensate(
        self,
        feet: dict[Side, FootTarget],
        phase: Phase,
        com: NDArray[np.float64],
        torso: float,
        posture: NDArray[np.float64],
        state: BaseState,
    ) -> None:
        """Correct the target of the foot that swings, or has just landed, for the body's lean."""
        side = self.motion.last_side
        if side is None:
            return
        foot = feet[side]
        (x, y, z), (cx, cy, _) = self._frame.to_world(foot.position).tolist(), state.com.tolist()
        # The world's heading differs from the command frame's by the alignment; only the lean is corrected here.
        c, s = math.cos(self._frame.turn), math.sin(self._frame.turn)
        aligned = vector(cx + c * (x - cx) + s * (y - cy), cy - s * (x - cx) + c * (y - cy), z)
        shift, turn = self._compensation.update(
            phase.swing == side,
            foot.position,
            aligned,
            com,
            state.com,
            posture,
            lean_correction.headed(state.rotation_base_to_world, torso),
        )
        rotation = lean_correction.turned(turn, foot.rotation)
        feet[side] = FootTarget(foot.position + shift, rotation, foot.force, foot.center_of_pressure)

    def _posture(self, com: NDArray[np.float64], torso: float) -> NDArray[np.float64]:
        """Rotation (3, 3) of the torso: along the feet, and leaning over the foot that the CoM moves to.

        A pelvis that stays level carries the body on the stance leg's hip roll joint at a lever of half its width; the
        lean brings hip and CoM together, as people do whose hip abductors are weak.
        """
        s = self.settings
        footholds = self.motion.footholds
        (lx, ly, _), (rx, ry, _) = footholds["left"][0].tolist(), footholds["right"][0].tolist()
        x, y, _ = com.tolist()
        c, d = math.cos(torso), math.sin(torso)
        dx, dy = x - 0.5 * (lx + rx), y - 0.5 * (ly + ry)
        left = -d * dx + c * dy
        lean = self._least_lean if self.body is None else max(self._least_lean, self.body.lean)
        roll = -lean * min(s.lean_reach, max(-s.lean_reach, left))
        e, f = math.cos(roll), math.sin(roll)
        return matrix(c, -d * e, d * f, d, c * e, -c * f, 0.0, f, e)

    def _align(self, state: BaseState) -> None:
        """Let the command frame follow where the carrying foot really stands."""
        side: Side = "left" if state.loads["left"] >= state.loads["right"] else "right"
        if state.loads[side] <= self.settings.estimator.minimum_load:
            return
        position, yaw = self.motion.footholds[side]
        turn = math.remainder(heading(state.rotations_sole[side]) - yaw, 2.0 * math.pi)
        self._frame.update(position, state.positions_sole[side], turn)

    def _crept(self) -> tuple[int, ...]:
        """How far the command frame has crept, in 1/6000 of the leg (0.1 mm for H1) and 0.1 mrad."""
        frame, fine = self._frame, self._fine
        x, y, z = frame.offset
        return round(x * fine), round(y * fine), round(z * fine), round(frame.turn * 1e4)

    def _contact(self, side: Side, crept: tuple[int, ...]) -> Contact:
        """Contact of a foot that stands; the same object until the frame has crept by a step of `_crept`."""
        polygon = self.contacts.polygon(side)
        rectangle = self._rectangle_of.get(side)
        if rectangle is None or rectangle[0] is not polygon:
            (x0, y0), _, (x1, y1), _ = safe_rectangle(polygon, _CONTACT_OFFSET * self.settings.body.sole).tolist()
            rectangle = self._rectangle_of[side] = (polygon, Rectangle(x0, x1, y0, y1))
        position, yaw = self.motion.footholds[side]
        place = (rectangle[1], yaw, crept)
        known = self._contact_of.get(side)
        if known is None or known[0] is not position or known[1] != place:
            x, y = self.contacts.center(side).tolist()
            turn = level_rotation(yaw + self._frame.turn)
            contact = Contact(self._frame.to_world(position), turn, rectangle[1], preferred=(x, y))
            known = self._contact_of[side] = (position, place, contact)
        return known[2]

    def _com_height(self, phase: Phase) -> float:
        """CoM height above the feet: follows the stance foot, blends in double support, and is higher over a foothold
        that carries a part of the sole."""
        heights = {side: self.motion.footholds[side][0].item(2) for side in SIDES}
        target = heights[phase.stance] if phase.stance is not None else 0.5 * (heights["left"] + heights["right"])
        if self.settings.partial_rise and any(self.contacts.partial(side) for side in SIDES):
            target += self.settings.partial_rise
        return self._ground.update(target) + self.settings.com_height
