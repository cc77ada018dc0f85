"""Swing and perceive: feet as commanded, landing, and their footholds."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import InputError
from plantar.gait.balance.ankle_strategy import shrunk_support, within_support
from plantar.gait.balance.dcm_regulation import phase_goal, regulated_vrp
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.foot_contacts import FootContacts
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.estimator import SoleLoad
from plantar.gait.estimate.push_estimate import NO_PUSH
from plantar.gait.estimate.sole_slope import SoleSlope
from plantar.gait.estimate.wrench_filter import WrenchFilter
from plantar.gait.feet.foot_motion import FootMotion, SoleSense
from plantar.gait.feet.ground_conformity import GroundConformity
from plantar.gait.feet.landing_compliance import DampingGains, LandingCompliance
from plantar.gait.feet.posture_compensation import PostureCompensation
from plantar.gait.feet.swing_compliance import SwingCompliance
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.gait.plan.vrp_plan import LipReference
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.foothold_refused import StepGuard
from plantar.gait.propose.proposer import Pendulum, Tick
from plantar.gait.tick.estimation import Estimation, Sensed
from plantar.kernels.base.vectors import vector
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.rotation import heading

# derived: weight on a foot that probes the ground from which its centre of pressure turns it; `touch_force`
_PROBING = 0.0237
_MAX_LANDING_OFFSET = 0.25  # chosen: leg that a foot that has landed off its place is commanded away from it at most


class Footing:
    """A walk's feet.

    `frame`: command frame of the footholds; `damping`: each foot's yielding to load; `compensation`: swing foot's
    correction for body lean; `guard`: checks footholds; None allows all; `conformity`: turns soles to the ground; None
    leaves them.
    """

    def __init__(
        self,
        settings: ControllerSettings,
        feet: Mapping[Side, Footstep],
        layouts: Mapping[Side, SoleLayout],
        plan: WalkPlan,
        estimation: Estimation,
        middles: Mapping[Side, NDArray[np.float64]],
        limits: Mapping[Side, AnkleLimits],
        turns_stance: bool,
    ) -> None:
        s = settings
        self._settings = settings
        self._plan = plan
        self._estimation = estimation
        for part in ("feasibility", "conformity"):
            if getattr(s, part) is not None and s.compliance is None:
                raise InputError(f"{part} needs preemptive foot compliance; give its gains too")
        compliance = None
        if s.compliance is not None:
            gains = s.compliance, s.touchdown, s.ground_map
            compliance = {side: SwingCompliance(layouts[side], *gains, s.timing.double_support) for side in SIDES}
        self.frame = CommandFrame(feet["left"].position, s.period, s.alignment_time)
        self.motion = FootMotion(feet, s.period, s.swing_height, s.landing, compliance, s.swing)
        self.contacts = FootContacts(s.contact, layouts, s.ankle_reach, limits, s.ground_map.sensing_range, s.outward)
        damping = DampingGains().for_body(s.body)
        self.damping = {side: LandingCompliance(s.period, damping) for side in SIDES}
        # chosen: gone before the next swing begins
        self.compensation = PostureCompensation.for_body(s.body, s.period, 0.7 * s.timing.double_support)
        self.guard = None if s.feasibility is None else StepGuard(s.feasibility, layouts, s.period)
        self.conformity = None
        if s.conformity is not None:
            self.conformity = GroundConformity(s.conformity, layouts, middles, s.period, turns_stance)
        blind = s.footholds == "force" and s.compliance is None
        self._slope = SoleSlope(s.estimator.minimum_load) if blind else None
        self._push = WrenchFilter(s.push_expected, estimation.omega, s.period)
        self._regulates = s.step_adjustment is not None and s.ankle_strategy.law == "regulation"

    @property
    def proximity_sides(self) -> tuple[Side, ...]:
        """Sides whose proximity the next tick needs."""
        motion = self.motion
        sides = motion.proximity_sides
        last = motion.last_side
        looks = self._settings.footholds == "skin" and not motion.landed and motion.comes_down
        return (*sides, last) if looks and last is not None and last not in sides else sides

    def align(self, state: BaseState) -> None:
        """Let the command frame follow the real carrying foot."""
        loads = state.loads
        side: Side = "left" if loads["left"] >= loads["right"] else "right"
        if loads[side] > self._settings.estimator.minimum_load:
            position, yaw = self.motion.footholds[side]
            self.frame.follow(position, yaw, state.positions_sole[side], state.rotations_sole[side])

    def swing(self, sensed: Sensed, state: BaseState, feedback: bool) -> FeetView:
        """Advance the swing foot. `feedback`: whether balance is fed back."""
        phase = sensed.phase
        percepts = sensed.percepts
        s = self._settings
        motion = self.motion
        senses: Mapping[Side, SoleSense] | None = None
        heights = None
        if s.compliance is not None:
            places = state.positions_sole
            turns = state.rotations_sole
            senses = {
                "left": SoleSense(percepts["left"], places["left"], turns["left"], sensed.sampled),
                "right": SoleSense(percepts["right"], places["right"], turns["right"], sensed.sampled),
            }
        target = None if phase.swing is None else self._plan.view.foothold(phase.step)
        if phase.kind == PhaseKind.STANDING:  # feet relax then
            heights = {side: state.positions_sole[side].item(2) for side in SIDES}
        motion.update(phase, sensed.time, target, state.loads, self.frame, senses, self._press(), heights)
        feet = motion.view
        if feet.touchdown and feedback:
            self._stand_at_landing(feet, state)
            feet = motion.view
        if feet.lift_off and feet.side is not None:
            self.compensation.start()
            self.contacts.lift_off(feet.side, phase.step)
        if phase.swing is not None and not motion.landed and not motion.comes_down:
            self.damping[phase.swing].fade()
        if feet.touchdown and self._estimation.body is not None:
            self.contacts.mass_ratio = self._estimation.body.mass_ratio
        if feet.touchdown and feet.side is not None and s.compliance is not None and s.footholds == "skin":
            self.contacts.touchdown(feet.side)
        return feet

    def _stand_at_landing(self, feet: FeetView, state: BaseState) -> None:
        """Command a landed foot where it is: a stance that is 4 mm wider or longer than the command is 100 N between
        the feet, and a hip at its limit.
        """
        side = feet.side
        if side is None or (self._settings.compliance is None and not self._carries(state, side)):
            return  # only the plan has it down
        adjustment = self._settings.step_adjustment
        other = other_side(side)
        soles = state.positions_sole
        x, y = self.frame.to_command(soles[side][:2]).tolist()
        commanded = feet.footholds[side][0]
        yaw = feet.footholds[side][1]
        # How deep it presses follows from its load.
        place = vector(x, y, commanded.item(2))
        if adjustment is not None and self._carries(state, side):
            # A pelvis that sinks puts the foot down before its path does: it stands lower than it is commanded.
            lower = vector(x, y, feet.footholds[other][0].item(2) + (soles[side] - soles[other]).item(2))
            if math.dist(lower, commanded) > adjustment.misplaced:
                place = lower
                yaw = heading(state.rotations_sole[side]) - self.frame.turn
        away = math.dist(place, commanded)
        if away > 0.0:
            # Of a body that falls, or by encoders that err by degrees, a foot may seem to be anywhere.
            place = commanded + min(1.0, _MAX_LANDING_OFFSET * self._settings.body.leg / away) * (place - commanded)
            self.motion.stand_at(side, place, yaw)
            self.compensation.keep(commanded - place)

    def _carries(self, state: BaseState, side: Side) -> bool:
        """Whether a foot has the load of a touchdown."""
        return state.loads[side] > self._settings.landing.contact_force

    def _press(self) -> float | None:
        if self.guard is not None and self.guard.press is not None:
            return self.guard.press  # a probe, on ground of any shape
        return None if self.conformity is None or not self._settings.feedback else self.conformity.gains.press

    def perceive(
        self, sensed: Sensed, state: BaseState, feet: FeetView, dcm: NDArray[np.float64] | None
    ) -> tuple[Tick, NDArray[np.float64]]:
        """Footholds for proposers, and the desired ZMP's region (`zmp_region`).

        `dcm` (2,) in m; None without feedback.
        """
        time = sensed.time
        phase = sensed.phase
        percepts = sensed.percepts
        s = self._settings
        looks = dcm is not None and s.footholds != "off"
        coming = self.contacts.coming_to_carry(phase, time, feet) if looks else ()
        self._damp(phase, sensed, state, coming, looks)
        found = self.contacts.find(coming, state, percepts, self._slope) if coming else ()
        # On its way up a sole sees the ground that it leaves.
        sees = looks and self.motion.comes_down
        seen = self.contacts.find_ahead(phase, time, feet, state, percepts) if sees else None
        region = self.zmp_region(phase, feet)
        pendulum = None
        if dcm is not None and (s.step_timing is not None or s.step_adjustment is not None):
            pendulum = self._pendulum(phase, time, dcm, region)
        tick = Tick(
            time=time,
            phase=phase,
            plan=self._plan.view,
            feet=feet,
            frame=self.frame.now(),
            readings={"left": percepts["left"].reading, "right": percepts["right"].reading},
            loads=state.loads,
            moments={side: ankle.wrench_in_sole[3:5] for side, ankle in sensed.ankles.items()} if sensed.ankles else {},
            found=found,
            seen=seen,
            pendulum=pendulum,
            firm=self.contacts.firm(phase.step) and (self.guard is None or self.guard.firm(phase.step)),
        )
        return tick, region

    def zmp_region(self, phase: Phase, feet: FeetView) -> NDArray[np.float64]:
        """Returns the desired ZMP's region in a phase with such feet: polygon (k, 2), world frame, in m."""
        margin = 0.0 if self._regulates else self._settings.balance.zmp_offset  # f(c) S is a share of the whole S
        return self.contacts.zmp_region(phase, feet, self.frame.offset, margin)

    def _pendulum(self, phase: Phase, time: float, dcm: NDArray[np.float64], region: NDArray[np.float64]) -> Pendulum:
        offset = NO_PUSH
        pushed = NO_PUSH
        omega = self._estimation.omega
        plan = self._plan
        if self._settings.push_estimate is not None and self._settings.step_adjustment is not None:
            push = self._estimation.estimator.push_acceleration
            expected = NO_PUSH
            if push is not NO_PUSH or self._push.acts:  # else there is none, and none is expected
                expected = self._push.update(push / omega**2)
            if self._push.acts and (phase.swing or self._regulates):  # K 20 has it in double support, too
                offset = self._push.mean(max(0.0, phase.end - time))
                # xi' = w u_w, summed over the time that the low pass remembers.
                pushed = expected * (omega * self._settings.push_expected.time_constant)
        goal = phase_goal(plan.view, phase, offset, omega) if self._regulates else None
        return Pendulum(
            omega, dcm, plan.at(time), plan.dcm_after(phase) if goal is None else goal, region, offset, pushed
        )

    def regulated(
        self,
        phase: Phase,
        time: float,
        reference: LipReference,
        pendulum: Pendulum | None,
        region: NDArray[np.float64],
    ) -> tuple[LipReference, NDArray[np.float64]]:
        """Returns the plan and the ZMP's region, or u* with its share of that (K 25-27).

        `time` in s; `reference`: the plan now; `pendulum`: before the plan changed; None hands over the plan;
        `region`: desired ZMP's (k, 2) in m.
        """
        if not self._regulates or pendulum is None or not len(region):
            return reference, region
        plan = self._plan.view
        yaw = self.motion.footholds[phase.stance or "left"][1] + self.frame.turn
        middle = region.mean(axis=0) if phase.stance is None else plan.stance_vrp(phase.step)
        region = shrunk_support(region, self._settings.ankle_strategy, middle, yaw)
        goal = phase_goal(plan, phase, pendulum.offset, pendulum.omega)
        goal = self._plan.dcm_after(phase) if goal is None else goal
        wanted = regulated_vrp(plan, phase, time, pendulum.dcm, goal, pendulum.offset, pendulum.omega)
        if wanted is None:
            return reference, region
        return reference.changed(vrp=within_support(wanted, region).vrp, dcm=pendulum.dcm), region

    def _level(self, slope: SoleSlope, phase: Phase, state: BaseState) -> None:
        """Turn a blind or just landed foot parallel to the stance foot."""
        standing = phase.kind == PhaseKind.STANDING and phase.step == 0
        slope.update(state.rotations_sole, state.loads, standing)
        side = self.motion.last_side
        if side is None or not self.motion.comes_down:
            return
        landing = self._settings.landing
        load = state.loads[side]
        if not landing.probing or load <= self._settings.estimator.minimum_load:
            self.damping[side].level(load, slope.slope(side), landing.levelling)

    def _damp(self, phase: Phase, sensed: Sensed, state: BaseState, coming: Sequence[Side], looks: bool) -> None:
        """Damp feet `coming` to carry, once."""
        damped: dict[Side, tuple[SoleLoad, float]] = {}
        if looks and self._slope is not None:
            self._level(self._slope, phase, state)
        if coming and (self._slope is None or self._settings.landing.probing):
            damped = {side: (sensed.percepts[side], self._settings.estimator.minimum_load) for side in coming}
        if self.guard is not None and self.guard.probing and phase.swing is not None:
            damped[phase.swing] = (sensed.soles[phase.swing], _PROBING * self._settings.body.weight)
        for side, (sole, least) in damped.items():
            cop = sole.position_cop_in_sole
            if cop is not None and state.loads[side] > least:
                self.damping[side].update(state.loads[side], cop, self.contacts.center(side))

    def follow(self, phase: Phase, time: float) -> FeetView:
        """Returns feet that follow a changed plan in a phase, at a time in s."""
        if phase.swing is not None:
            lifts = self.guard is not None and self.guard.lifts
            landed = self.motion.landed or lifts
            self.motion.aim(phase, time, self._plan.view.foothold(phase.step), self.frame, lifts)
            if landed and not self.motion.landed:  # it takes its step once more
                self.contacts.lift_off(phase.swing, phase.step)
        return self.motion.view

    def conform(self, phase: Phase, zmp: NDArray[np.float64], state: BaseState, sensed: Sensed) -> None:
        """Turn a phase's standing soles to the ground, by `sensed`, `state` and desired `zmp`."""
        if self.conformity is None or (self.motion.hurried and phase.kind != PhaseKind.STANDING):
            return
        plan = self._plan.view
        incoming = None
        if 0 < phase.step < plan.count:  # not at the two ends of the walk
            incoming = phase.swing or other_side(plan.foothold(phase.step).side)
        parts = self.contacts.parts
        turned = self.conformity.update(phase, incoming, zmp, state, sensed.percepts, self.motion.landed, parts)
        for side, turn in turned.items():
            self.motion.turn_standing(side, *turn)
