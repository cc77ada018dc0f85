"""Walking controller: the one file that wires plan, estimator, swing and balance into a control tick."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gait.ankle_sensor import AnkleSensor, SoleWrench
from gait.balance import BalanceGains, FootAction, FootState
from gait.balance_laws import balance_law
from gait.com_height import CoMHeight
from gait.command_frame import CommandFrame
from gait.compliance_gains import ComplianceGains
from gait.estimator import (
    BaseState,
    EstimatorGains,
    FloatingBaseEstimator,
    LegKinematics,
    SoleLoad,
    heading,
    rotation_from_vector,
)
from gait.feasibility import FeasibilityRules
from gait.foot_motion import FootMotion, Landing, SoleSense
from gait.footholds import FootholdFelt, Footholds, middle_of_sole
from gait.footsteps import Footstep, level_rotation, other_side
from gait.ground_conformity import ConformityGains, GroundConformity
from gait.lip import pendulum_frequency
from gait.phases import Phase, Timing, WalkSchedule
from gait.posture_compensation import PostureCompensation
from gait.skin_load import at_its_limit
from gait.stance_contact import ContactSettings
from gait.step_guard import StepGuard
from gait.support_strip import SupportStrip
from gait.swing_compliance import SwingCompliance
from gait.vrp_plan import LipReference
from gait.walk_plan import WalkPlan
from gait.wrench_cone import FootContact, Rectangle
from plantar.contact_rectangle import safe_rectangle
from plantar.errors import InputError
from plantar.layout import Side, SoleLayout
from plantar.percept import Percept
from plantar.reading import Reading
from plantar.zmp import divergent_component

if TYPE_CHECKING:
    from gait.wrench_balance import WrenchBalanceGains

__all__ = ["Command", "ControllerSettings", "FootTarget", "Sensors", "WalkingController"]

_SIDES: tuple[Side, Side] = ("left", "right")
_CONTACT_OFFSET = 0.01  # m that a foot's centre of pressure keeps from the edge of its contact (T 4.4.4)


@dataclass(frozen=True)
class ControllerSettings:
    """Settings of a walk.

    Attributes:
        com_height: CoM height above the soles in m.
        mass: Robot mass in kg.
        period: Control period in s.
        timing: Durations of the phases.
        swing_height: Clearance of the swing foot in m.
        landing: How a foot lands.
        compliance: Preemptive foot compliance; None lands blindly.
        feasibility: Rules of step feasibility, which need compliance; None steps on everything.
        conformity: Gains of feet that take the ground's shape, which need compliance; None leaves soles as they land.
        trunk_lean: Roll of the torso in rad per metre of the CoM's distance from the middle between the feet.
        lean_reach: Distance in m from which on the torso leans no further.
        alignment_time: Time constant in s with which the command frame follows the real footholds.
        gains: Gains of the balance law; their class says which.
        estimator: Estimator gains.
        contact: How footholds are found from the taxels.
        feedback: False walks the plan in open loop, for comparison.
        zmp_source: What feels the loads and the ZMP that are fed back: "skin", or "force_torque" at the ankles.
        ankles: Force-torque sensor of each ankle, where the robot has them.
        footholds: What tells what a foot stands on: "off" takes every foothold for a whole sole, for comparison;
            "force" goes by the taxels' forces, "skin" by what they see before they touch, too.
    """

    com_height: float
    mass: float
    period: float = 0.005
    timing: Timing = field(default_factory=Timing)
    swing_height: float = 0.05
    landing: Landing = field(default_factory=Landing)
    compliance: ComplianceGains | None = None
    feasibility: FeasibilityRules | None = None
    conformity: ConformityGains | None = None
    trunk_lean: float = 0.0
    lean_reach: float = 0.053
    alignment_time: float = 0.3
    gains: BalanceGains | WrenchBalanceGains = field(default_factory=BalanceGains)
    estimator: EstimatorGains = field(default_factory=EstimatorGains)
    contact: ContactSettings = field(default_factory=ContactSettings)
    feedback: bool = True
    zmp_source: str = "skin"
    ankles: Mapping[Side, AnkleSensor] = field(default_factory=dict)
    footholds: str = "off"


@dataclass(frozen=True)
class Sensors:
    """All that a controller gets to see.

    Attributes:
        time: Time in s.
        joint_positions: Encoder readings (k,) in rad.
        gyro: Angular velocity (3,) of the base in its own frame in rad/s.
        accelerometer: Specific force (3,) of the base in its own frame in m/s^2.
        readings: Latest reading of each sole.
        ankles: Wrench (6,) that each foot exerts on its leg, in the frame of its force-torque sensor in N and N m;
            empty for a robot that has none.
    """

    time: float
    joint_positions: NDArray[np.float64]
    gyro: NDArray[np.float64]
    accelerometer: NDArray[np.float64]
    readings: Mapping[Side, Reading]
    ankles: Mapping[Side, NDArray[np.float64]] = field(default_factory=dict)


@dataclass(frozen=True)
class FootTarget:
    """Where a sole shall be, and what it shall carry.

    Attributes:
        position: Sole frame origin (3,) in the world frame in m.
        rotation: Rotation (3, 3) from the sole to the world frame.
        force: Force (3,) in N that the ground shall exert on it.
        center_of_pressure: Point (2,) in the world frame in m at which it acts.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    force: NDArray[np.float64]
    center_of_pressure: NDArray[np.float64]


@dataclass(frozen=True)
class Command:
    """What the controller asks of the body, for inverse kinematics and servos.

    Attributes:
        com: CoM reference (3,) in m in the frame of the commanded footholds, which joints are solved in.
        rotation_torso: Rotation (3, 3) from the torso to the same frame.
        feet: Target of each sole, same frame.
        phase: Phase of the walk.
        reference: The plan now.
        zmp_desired: Desired ZMP (2,) in m.
        state: Estimated state.
        dcm: Estimated DCM (2,) in m.
        percepts: What each sole felt.
        ankle_loads: What each ankle's force-torque sensor says that its sole carries; empty without such sensors.
        footholds: What feet have been found to stand on at this tick.
    """

    com: NDArray[np.float64]
    rotation_torso: NDArray[np.float64]
    feet: Mapping[Side, FootTarget]
    phase: Phase
    reference: LipReference
    zmp_desired: NDArray[np.float64]
    state: BaseState
    dcm: NDArray[np.float64]
    percepts: Mapping[Side, Percept]
    ankle_loads: Mapping[Side, SoleWrench] = field(default_factory=dict)
    footholds: tuple[FootholdFelt, ...] = ()


class WalkingController:
    """Walks a footstep plan on plantar feedback.

    Args:
        settings: Settings.
        feet: Where the feet stand at the start.
        steps: The footsteps in order.
        layouts: Sole layout of each side.
        kinematics: Forward kinematics of the robot.
        begin: Time in s at which the walk begins.
    """

    def __init__(
        self,
        settings: ControllerSettings,
        feet: Mapping[Side, Footstep],
        steps: tuple[Footstep, ...],
        layouts: Mapping[Side, SoleLayout],
        kinematics: LegKinematics,
        begin: float = 1.0,
    ) -> None:
        self.settings = settings
        self.layouts = layouts
        self.omega = pendulum_frequency(settings.com_height)
        self.schedule = WalkSchedule(steps, settings.timing, begin)
        vrp_in_sole = {side: middle_of_sole(layouts[side]) for side in _SIDES}
        self.plan = WalkPlan(feet, self.schedule, vrp_in_sole, self.omega)
        self.balance = balance_law(settings.gains, self.omega, settings.mass, settings.period)
        self._rectangle_of: dict[Side, tuple[NDArray[np.float64], Rectangle]] = {}
        self._contact_of: dict[Side, tuple[NDArray[np.float64], tuple[object, ...], FootContact]] = {}
        self.estimator = FloatingBaseEstimator(
            kinematics,
            self.omega,
            settings.period,
            {s: (feet[s].x, feet[s].y, feet[s].z, feet[s].yaw) for s in _SIDES},
            settings.estimator,
        )
        gains = settings.compliance
        compliance = None if gains is None else {s: SwingCompliance(layouts[s], gains) for s in _SIDES}
        self.motion = FootMotion(
            feet, self.schedule, settings.period, settings.swing_height, settings.landing, compliance
        )
        self.guard: StepGuard | None = None
        if settings.feasibility is not None:
            if compliance is None:
                raise InputError("step feasibility needs preemptive foot compliance; give its gains too")
            self.guard = StepGuard(settings.feasibility, self.motion, self.plan, compliance, vrp_in_sole)
        self._frame = CommandFrame(feet["left"].position, settings.period, settings.alignment_time)
        self._ticks = 0
        self._rotations_sole: Mapping[Side, NDArray[np.float64]] = {s: feet[s].rotation_sole_to_world for s in _SIDES}
        self._detours = 0
        self._compensation = PostureCompensation(settings.period, fade=0.7 * settings.timing.double_support)
        way = self.plan.end - self.plan.at(begin - 1.0).com
        length = float(np.hypot(*way))
        forward = np.array([math.cos(feet["left"].yaw), math.sin(feet["left"].yaw)])
        strip = SupportStrip(self.plan.at(begin - 1.0).com, way / length if length > 0.05 else forward)
        self.footholds = Footholds(
            settings.contact,
            layouts,
            vrp_in_sole,
            self.plan,
            self.motion,
            self._frame,
            strip,
            period=settings.period,
            minimum_load=settings.estimator.minimum_load,
            zmp_offset=settings.gains.zmp_offset,
        )
        self.conformity: GroundConformity | None = None
        if settings.conformity is not None:
            if compliance is None:
                raise InputError(
                    "feet that take the ground's shape need preemptive foot compliance; give its gains too"
                )
            self.conformity = GroundConformity(
                settings.conformity,
                layouts,
                self.schedule,
                self.motion,
                vrp_in_sole,
                settings.period,
                turns_stance=not self.balance.wants_feet,
            )
        self._ground = CoMHeight(float(np.mean([feet[s].z for s in _SIDES])), settings.period)

    @property
    def end(self) -> float:
        """Time in s at which the walk is over and the robot has settled."""
        return self.schedule.end

    @property
    def replans(self) -> int:
        """How often the plan was changed: for a foothold that was found, or for one that was refused."""
        return self.footholds.replans + self._detours

    @property
    def proximity_sides(self) -> tuple[Side, ...]:
        """Feet whose proximity it wants to have at the next tick."""
        sides = self.motion.proximity_sides
        last = self.motion.last_side
        looks = self.settings.footholds == "skin" and not self.motion.landed and self.motion.comes_down
        return (*sides, last) if looks and last is not None and last not in sides else sides

    def step(self, sensors: Sensors) -> Command:
        """One control tick: sensors in, command out."""
        s = self.settings
        layouts = self.layouts
        percepts = {
            side: Percept(layouts[side], at_its_limit(sensors.readings[side], layouts[side])) for side in _SIDES
        }
        ankles = {
            side: sensor.sole_wrench(sensors.ankles[side], self._rotations_sole[side])
            for side, sensor in s.ankles.items()
            if side in sensors.ankles
        }
        soles: Mapping[Side, SoleLoad] = ankles if s.zmp_source == "force_torque" else percepts
        reference = self.plan.at(sensors.time)
        phase = self.schedule.at(sensors.time)
        # Of its usual length: a single support that is made longer holds a foot that has landed.
        share = (sensors.time - phase.start) / s.timing.single_support if phase.swing is not None else 0.0
        state = self.estimator.update(
            sensors.joint_positions,
            sensors.gyro,
            sensors.accelerometer,
            soles,
            reference.com_acceleration,
            phase.swing if 0.2 < share < 0.5 and s.zmp_source == "skin" else None,
        )
        self._ticks += 1
        self._rotations_sole = state.rotations_sole
        self.footholds.felt.clear()
        feedback = s.feedback and self._ticks * s.period > s.estimator.averaging
        if feedback:
            self._align(state)
        senses = {s: SoleSense(percepts[s], state.positions_sole[s], state.rotations_sole[s]) for s in _SIDES}
        landed = self.motion.landed
        if self.motion.update(phase, sensors.time, state.loads, self._frame, senses):
            self._compensation.start()
            self.footholds.lift(phase)
        if self.motion.landed and not landed and s.compliance is not None:
            self._keep_inside(phase, sensors.time)
        if self.guard is not None:
            moments = {side: ankle.wrench_in_sole[3:5] for side, ankle in ankles.items()}
            region = self.footholds.zmp_region(phase)
            side = phase.swing
            if self.guard.probing and side is not None:  # a sole on its edge makes a moment on the best of ground
                cop = soles[side].position_cop_in_sole
                if cop is not None and state.loads[side] > 20.0:
                    self.footholds.let_turn(side, state.loads[side], cop)
            if self.guard.update(phase, sensors.time, self._frame, sensors.readings, moments, state.loads, region):
                self._detours += 1
                phase, reference = self.schedule.at(sensors.time), self.plan.at(sensors.time)
        if (
            feedback
            and s.footholds != "off"
            and self.footholds.update(phase, sensors.time, sensors.readings, state, percepts)
        ):
            reference = self.plan.at(sensors.time)
        xi = divergent_component(state.com[:2], state.com_velocity[:2], self.omega)
        if feedback:
            standing = self._foot_states(phase, soles) if self.balance.wants_feet else {}
            balance = self.balance.update(reference, xi, state.zmp, self.footholds.zmp_region(phase), standing)
            com, zmp, acceleration = balance.com, balance.zmp_desired, balance.com_acceleration
            actions = balance.feet
        else:
            actions = {}
            com, zmp, acceleration = reference.com, reference.vrp, reference.com_acceleration
        if feedback and self.conformity is not None:
            self.conformity.update(phase, zmp, state, percepts)
        height = self._com_height(phase)
        yaws = [self.motion.footholds[side][1] for side in _SIDES]
        target = np.array([*self._frame.to_command(com).tolist(), height])
        torso = yaws[0] + 0.5 * math.remainder(yaws[1] - yaws[0], 2.0 * math.pi)
        posture = self._posture(target, torso)
        if actions:
            feet = self._shared_targets(actions)
        else:
            feet = self._foot_targets(phase, self._frame.to_command(zmp), acceleration)
        if feedback:
            self._compensate(feet, phase, target, torso, posture, state)
        return Command(
            com=target,
            rotation_torso=posture,
            feet=feet,
            phase=phase,
            reference=reference,
            zmp_desired=zmp,
            state=state,
            dcm=xi,
            percepts=percepts,
            ankle_loads=ankles,
            footholds=tuple(self.footholds.felt),
        )

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
        place = self._frame.to_world(foot.position)
        back = level_rotation(torso - heading(state.rotation_base_to_world))
        # The world's heading differs from the command frame's by the alignment; only the lean is corrected here.
        aligned = level_rotation(-self._frame.turn)
        shift, turn = self._compensation.update(
            phase.swing == side,
            foot.position,
            state.com + aligned.dot(place - state.com),
            com,
            state.com,
            posture,
            back.dot(state.rotation_base_to_world),
        )
        rotation = rotation_from_vector(turn).dot(foot.rotation)
        feet[side] = FootTarget(foot.position + shift, rotation, foot.force, foot.center_of_pressure)

    def _posture(self, com: NDArray[np.float64], torso: float) -> NDArray[np.float64]:
        """Rotation (3, 3) of the torso: along the feet, and leaning over the foot that the CoM moves to.

        A pelvis that stays level carries the body on the stance leg's hip roll joint at a lever of half its width; the
        lean brings hip and CoM together, as people do whose hip abductors are weak.
        """
        s = self.settings
        middle = 0.5 * (self.motion.footholds["left"][0] + self.motion.footholds["right"][0])
        c, d = math.cos(torso), math.sin(torso)
        dx, dy, _ = (com - middle).tolist()
        left = -d * dx + c * dy
        roll = -s.trunk_lean * min(s.lean_reach, max(-s.lean_reach, left))
        e, f = math.cos(roll), math.sin(roll)
        return np.array([[c, -d * e, d * f], [d, c * e, -c * f], [0.0, f, e]])

    def _align(self, state: BaseState) -> None:
        """Let the command frame follow where the carrying foot really stands."""
        side: Side = "left" if state.loads["left"] >= state.loads["right"] else "right"
        if state.loads[side] <= self.settings.estimator.minimum_load:
            return
        position, yaw = self.motion.footholds[side]
        turn = math.remainder(heading(state.rotations_sole[side]) - yaw, 2.0 * math.pi)
        self._frame.follow(position, state.positions_sole[side], turn)

    def _keep_inside(self, phase: Phase, time: float) -> None:
        """On a slope that rises outwards more than the ankle can follow, stand further inside."""
        side, gains = self.motion.last_side, self.settings.compliance
        if side is None or gains is None:
            return
        excess = self.motion.outward_rise(side) - gains.ankle_reach
        if excess > 0.0:
            step = phase.step if phase.swing is not None else phase.step - 1
            inward = self.settings.com_height * excess * (-1.0 if side == "left" else 1.0)
            self.footholds.move_inward(side, step, inward, phase, time)

    def _foot_states(self, phase: Phase, soles: Mapping[Side, SoleLoad]) -> dict[Side, FootState]:
        """The feet that stand, for a balance law that shares the ground's wrench between them."""
        states: dict[Side, FootState] = {}
        for side in _SIDES:
            if phase.swing == side and not self.motion.landed:
                continue
            states[side] = FootState(self._contact(side), soles[side].wrench_in_sole)
        return states

    def _contact(self, side: Side) -> FootContact:
        """Contact of a foot that stands; the same object until it is 0.1 mm or 0.1 mrad off, as the frame creeps."""
        polygon = self.footholds.polygon(side)
        rectangle = self._rectangle_of.get(side)
        if rectangle is None or rectangle[0] is not polygon:
            (x0, y0), _, (x1, y1), _ = safe_rectangle(polygon, _CONTACT_OFFSET).tolist()
            rectangle = self._rectangle_of[side] = (polygon, Rectangle(x0, x1, y0, y1))
        position, yaw = self.motion.footholds[side]
        x, y, z = self._frame.offset.tolist()
        place = (rectangle[1], yaw, round(x, 4), round(y, 4), round(z, 4), round(self._frame.turn, 4))
        known = self._contact_of.get(side)
        if known is None or known[0] is not position or known[1] != place:
            center = self.footholds.center(side)
            contact = FootContact(
                self._frame.to_world(position),
                level_rotation(yaw + self._frame.turn),
                rectangle[1],
                preferred=(float(center[0]), float(center[1])),
            )
            known = self._contact_of[side] = (position, place, contact)
        return known[2]

    def _shared_targets(self, actions: Mapping[Side, FootAction]) -> dict[Side, FootTarget]:
        """Feet as a balance law wants them: turned about their centres, shifted, each with a wrench of its own."""
        targets: dict[Side, FootTarget] = {}
        for side, action in actions.items():
            position = self.motion.footholds[side][0]
            level = rotation = self.motion.rotation(side)
            center, (x, y) = self.footholds.center(side), self.footholds.turn(side).tolist()
            if action.roll or action.pitch or action.shift or x or y:
                rotation = level.dot(rotation_from_vector(np.array([x + action.roll, y + action.pitch, 0.0])))
                # About the centre: it stays at its height, to first order.
                rise = action.shift + action.pitch * center[0] - action.roll * center[1]
                position = position + np.array([0.0, 0.0, rise])
            fx, fy, fz, tx, ty, _ = action.wrench.tolist()
            cop = np.array([-ty / fz, tx / fz]) if fz > 0.0 else center
            place = self.motion.footholds[side][0][:2] + level[:2, :2].dot(cop)
            targets[side] = FootTarget(position, rotation, level.dot(np.array([fx, fy, fz])), place)
        return targets

    def _com_height(self, phase: Phase) -> float:
        """CoM height above the feet: follows the stance foot, blends in double support."""
        heights = {side: float(self.motion.footholds[side][0][2]) for side in _SIDES}
        target = heights[phase.stance] if phase.stance is not None else 0.5 * (heights["left"] + heights["right"])
        return self._ground.follow(target) + self.settings.com_height

    def _foot_targets(
        self, phase: Phase, zmp: NDArray[np.float64], acceleration: NDArray[np.float64]
    ) -> dict[Side, FootTarget]:
        """Pose of each sole, and the share of the pendulum's force that it shall carry at which point."""
        s = self.settings
        force = s.mass * np.array([acceleration[0], acceleration[1], 9.81])
        centers: dict[Side, NDArray[np.float64]] = {}
        rotations: dict[Side, NDArray[np.float64]] = {}
        for side in _SIDES:
            position = self.motion.footholds[side][0]
            x, y = self.footholds.turn(side).tolist()
            rotation = self.motion.rotation(side)
            if x or y:
                rotation = rotation.dot(rotation_from_vector(np.array([x, y, 0.0])))
            rotations[side] = rotation
            centers[side] = position[:2] + rotations[side][:2, :2].dot(self.footholds.center(side))
        if phase.stance is not None:
            share = {phase.stance: 1.0, other_side(phase.stance): 0.0}
        else:
            line = centers["left"] - centers["right"]
            left = float((zmp - centers["right"]) @ line / (line @ line))
            left = min(1.0, max(0.0, left))
            share = {"left": left, "right": 1.0 - left}
        # What is left of the desired ZMP after sharing is realised by each foot's own centre of pressure.
        rest = zmp - (share["left"] * centers["left"] + share["right"] * centers["right"])
        return {
            side: FootTarget(self.motion.footholds[side][0], rotations[side], share[side] * force, centers[side] + rest)
            for side in _SIDES
        }
