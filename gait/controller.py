"""Walking controller: the one file that wires plan, estimator, swing and balance into a control tick."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from gait.balance import BalanceGains, DcmBalance
from gait.estimator import (
    BaseState,
    EstimatorGains,
    FloatingBaseEstimator,
    LegKinematics,
    heading,
    rotation_from_vector,
)
from gait.footsteps import Footstep, other_side
from gait.lip import pendulum_frequency
from gait.phases import Phase, Timing, WalkSchedule
from gait.posture_compensation import PostureCompensation
from gait.swing import SwingTrajectory
from gait.vrp_plan import LipReference
from gait.walk_plan import plan_vrps
from plantar.layout import Side, SoleLayout
from plantar.percept import Percept
from plantar.polygon import centroid, inner_offset
from plantar.reading import Reading
from plantar.support import feet_support_polygon, polygon_in_world
from plantar.zmp import divergent_component

__all__ = ["Command", "ControllerSettings", "FootTarget", "Sensors", "WalkingController"]

_SIDES: tuple[Side, Side] = ("left", "right")


@dataclass(frozen=True)
class ControllerSettings:
    """Settings of a walk.

    Attributes:
        com_height: CoM height above the soles in m.
        mass: Robot mass in kg.
        period: Control period in s.
        timing: Durations of the phases.
        swing_height: Clearance of the swing foot in m.
        contact_force: Vertical force in N on the swing foot that counts as touchdown (the papers' 70 N).
        landing_force: Vertical force in N up to which a foot that has touched is pressed down.
        landing_depth: Depth in m below the expected ground that the swing aims for, so that the foot rests on it
            with some tens of newtons and does not hover.
        landing_speed: Speed in m/s at which a foot that met no ground yet goes on downwards.
        landing_acceleration: Its acceleration in m/s^2.
        landing_reach: Distance in m that it goes down at most.
        alignment_time: Time constant in s with which the command frame follows the real footholds.
        gains: Balance gains.
        estimator: Estimator gains.
        feedback: False walks the plan in open loop, for comparison.
    """

    com_height: float
    mass: float
    period: float = 0.005
    timing: Timing = field(default_factory=Timing)
    swing_height: float = 0.05
    contact_force: float = 70.0
    landing_force: float = 200.0
    landing_depth: float = 0.0004
    landing_speed: float = 0.03
    landing_acceleration: float = 1.0
    landing_reach: float = 0.03
    alignment_time: float = 0.3
    gains: BalanceGains = field(default_factory=BalanceGains)
    estimator: EstimatorGains = field(default_factory=EstimatorGains)
    feedback: bool = True


@dataclass(frozen=True)
class Sensors:
    """All that a controller gets to see.

    Attributes:
        time: Time in s.
        joint_positions: Encoder readings (k,) in rad.
        gyro: Angular velocity (3,) of the base in its own frame in rad/s.
        accelerometer: Specific force (3,) of the base in its own frame in m/s^2.
        readings: Latest reading of each sole.
    """

    time: float
    joint_positions: NDArray[np.float64]
    gyro: NDArray[np.float64]
    accelerometer: NDArray[np.float64]
    readings: Mapping[Side, Reading]


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
        heading: Heading of the upright torso in rad, same frame.
        feet: Target of each sole, same frame.
        phase: Phase of the walk.
        reference: The plan now.
        zmp_desired: Desired ZMP (2,) in m.
        state: Estimated state.
        dcm: Estimated DCM (2,) in m.
        percepts: What each sole felt.
    """

    com: NDArray[np.float64]
    heading: float
    feet: Mapping[Side, FootTarget]
    phase: Phase
    reference: LipReference
    zmp_desired: NDArray[np.float64]
    state: BaseState
    dcm: NDArray[np.float64]
    percepts: Mapping[Side, Percept]


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
        self._outline = {s: layouts[s].outline for s in _SIDES}
        vrp_in_sole: dict[Side, NDArray[np.float64]] = {}
        for side in _SIDES:
            point = centroid(layouts[side].outline)
            assert point is not None
            vrp_in_sole[side] = point
        self._vrp_in_sole = vrp_in_sole
        self.plan = plan_vrps(feet, self.schedule, vrp_in_sole, self.omega)
        self.balance = DcmBalance(settings.gains, self.omega, settings.period)
        self.estimator = FloatingBaseEstimator(
            kinematics,
            self.omega,
            settings.period,
            {s: (feet[s].x, feet[s].y, feet[s].z, feet[s].yaw) for s in _SIDES},
            settings.estimator,
        )
        self._foothold: dict[Side, tuple[NDArray[np.float64], float]] = {
            s: (feet[s].position.copy(), feet[s].yaw) for s in _SIDES
        }
        self._swing: SwingTrajectory | None = None
        self._swing_step = -1
        self._ticks = 0
        self.replans = 0
        self._compensation = PostureCompensation(settings.period, fade=0.7 * settings.timing.double_support)
        self._landed = True
        self._lowered = self._lowering = 0.0
        self._anchor = feet["left"].position
        self._offset = np.zeros(3)
        self._turn = 0.0
        self._region_of: list[tuple[Side, float, float, float]] = []
        self._region = np.empty((0, 2))
        self._ground = float(np.mean([feet[s].z for s in _SIDES]))

    @property
    def end(self) -> float:
        """Time in s at which the walk is over and the robot has settled."""
        return self.schedule.end

    def step(self, sensors: Sensors) -> Command:
        """One control tick: sensors in, command out."""
        s = self.settings
        percepts = {side: Percept(self.layouts[side], sensors.readings[side]) for side in _SIDES}
        reference = self.plan.at(sensors.time)
        phase = self.schedule.at(sensors.time)
        share = (sensors.time - phase.start) / (phase.end - phase.start) if phase.swing is not None else 0.0
        state = self.estimator.update(
            sensors.joint_positions,
            sensors.gyro,
            sensors.accelerometer,
            percepts,
            reference.com_acceleration,
            phase.swing if 0.2 < share < 0.5 else None,
        )
        self._ticks += 1
        feedback = s.feedback and self._ticks * s.period > s.estimator.averaging
        if feedback:
            self._align(state)
        self._move_feet(phase, sensors.time, state)
        xi = divergent_component(state.com[:2], state.com_velocity[:2], self.omega)
        if feedback:
            balance = self.balance.update(reference, xi, state.zmp, self._zmp_region(phase))
            com, zmp, acceleration = balance.com, balance.zmp_desired, balance.com_acceleration
        else:
            com, zmp, acceleration = reference.com, reference.vrp, reference.com_acceleration
        height = self._com_height(phase, sensors.time)
        yaws = [self._foothold[side][1] for side in _SIDES]
        target = np.array([*self._to_command(com), height])
        torso = yaws[0] + 0.5 * math.remainder(yaws[1] - yaws[0], 2.0 * math.pi)
        feet = self._foot_targets(phase, self._to_command(zmp), acceleration)
        if feedback and self._swing is not None:
            self._compensate(feet, phase, target, torso, state)
        return Command(
            com=target,
            heading=torso,
            feet=feet,
            phase=phase,
            reference=reference,
            zmp_desired=zmp,
            state=state,
            dcm=xi,
            percepts=percepts,
        )

    def _compensate(
        self, feet: dict[Side, FootTarget], phase: Phase, com: NDArray[np.float64], torso: float, state: BaseState
    ) -> None:
        """Correct the target of the foot that swings, or has just landed, for the body's lean."""
        side = self.schedule.steps[self._swing_step].side
        foot = feet[side]
        dx, dy, dz = (foot.position - self._anchor).tolist()
        c, s = math.cos(self._turn), math.sin(self._turn)
        place = self._anchor + self._offset + np.array([c * dx - s * dy, s * dx + c * dy, dz])
        command = Footstep(side, 0.0, 0.0, torso).rotation_sole_to_world
        back = Footstep(side, 0.0, 0.0, torso - heading(state.rotation_base_to_world)).rotation_sole_to_world
        # The world's heading differs from the command frame's by the alignment; only the lean is corrected here.
        aligned = Footstep(side, 0.0, 0.0, -self._turn).rotation_sole_to_world
        shift, turn = self._compensation.update(
            phase.swing == side,
            foot.position,
            state.com + aligned @ (place - state.com),
            com,
            state.com,
            command,
            back @ state.rotation_base_to_world,
        )
        rotation = rotation_from_vector(turn) @ foot.rotation
        feet[side] = replace(foot, position=foot.position + shift, rotation=rotation)

    def _align(self, state: BaseState) -> None:
        """Follow where the loaded foot really stands: servos give a little, so a commanded foothold and the real one
        drift apart by a millimetre or two a step. World and command frame differ by this (filtered) offset."""
        s = self.settings
        side: Side = "left" if state.loads["left"] >= state.loads["right"] else "right"
        position, yaw = self._foothold[side]
        if state.loads[side] <= s.estimator.minimum_load:
            return
        share = min(1.0, s.period / s.alignment_time)
        # The anchor moves as slowly: a jump from foot to foot would turn the CoM reference about another point.
        self._anchor = self._anchor + share * (position - self._anchor)
        self._offset += share * (state.positions_sole[side] - position - self._offset)
        turn = math.remainder(heading(state.rotations_sole[side]) - yaw, 2.0 * math.pi)
        self._turn += share * (turn - self._turn)

    def _to_command(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A horizontal point (2,) of the world in the frame of the commanded footholds."""
        dx, dy = (point - self._anchor[:2] - self._offset[:2]).tolist()
        c, s = math.cos(self._turn), math.sin(self._turn)
        return np.array([self._anchor[0] + c * dx + s * dy, self._anchor[1] - s * dx + c * dy])

    def _move_feet(self, phase: Phase, time: float, state: BaseState) -> None:
        """Advance the swing foot; stop it at touchdown, lower it further while it has met no ground or bounced off."""
        s = self.settings
        if phase.swing is not None and self._swing_step != phase.step:
            step = self.schedule.steps[phase.step]
            position, yaw = self._foothold[phase.swing]
            ground = self._foothold[other_side(phase.swing)][0][2]
            target = np.array([*self._to_command(step.position[:2]), ground - s.landing_depth])
            self._swing = SwingTrajectory(
                position.copy(), target, yaw, step.yaw - self._turn, s.swing_height, phase.end - phase.start
            )
            self._swing_step = phase.step
            self._compensation.start()
            self._landed = False
            self._lowered = self._lowering = 0.0
        if self._swing is None:
            return
        side = self.schedule.steps[self._swing_step].side
        position, yaw = self._foothold[side]
        if phase.swing is not None:
            elapsed = time - phase.start
            if elapsed > 0.5 * self._swing.duration and state.loads[side] > s.contact_force:
                self._landed = True
            if not self._landed:
                self._foothold[side] = self._swing.at(elapsed)
                return
        self._landed = True  # it touched, or the plan puts weight on it now
        # Press down the more gently the more it carries; a switch at one force would make the foot tap.
        missing = 1.0 - state.loads[side] / s.landing_force
        wanted = s.landing_speed * missing if missing > 0.0 and self._lowered < s.landing_reach else 0.0
        self._lowering = min(wanted, self._lowering + s.landing_acceleration * s.period)
        if self._lowering > 0.0:
            drop = self._lowering * s.period
            self._lowered += drop
            self._foothold[side] = (position - np.array([0.0, 0.0, drop]), yaw)

    def _zmp_region(self, phase: Phase) -> NDArray[np.float64]:
        """Where the desired ZMP may lie: the support polygon of the feet that the plan stands on, at their commanded
        places, moved inwards by the offset. It is made anew only when a foot comes, goes or moves."""
        standing = [s for s in _SIDES if self._landed or phase.swing != s]
        places = []
        for side in standing:
            position, yaw = self._foothold[side]
            places.append((side, float(position[0]), float(position[1]), yaw))
        if places != self._region_of:
            parts = [
                polygon_in_world(
                    self._outline[side],
                    Footstep(side, x, y, yaw).rotation_sole_to_world,
                    np.array([x, y, 0.0]) + self._offset,
                )
                for side, x, y, yaw in places
            ]
            self._region = inner_offset(feet_support_polygon(parts), self.settings.gains.zmp_offset)
            self._region_of = places
        return self._region

    def _com_height(self, phase: Phase, time: float) -> float:
        """CoM height above the feet: follows the stance foot, blends in double support."""
        heights = {side: float(self._foothold[side][0][2]) for side in _SIDES}
        target = heights[phase.stance] if phase.stance is not None else 0.5 * (heights["left"] + heights["right"])
        rate = min(1.0, 5.0 * self.settings.period)
        self._ground += rate * (target - self._ground)
        return self._ground + self.settings.com_height

    def _foot_targets(
        self, phase: Phase, zmp: NDArray[np.float64], acceleration: NDArray[np.float64]
    ) -> dict[Side, FootTarget]:
        """Pose of each sole, and the share of the pendulum's force that it shall carry at which point."""
        s = self.settings
        force = s.mass * np.array([acceleration[0], acceleration[1], 9.81])
        centers: dict[Side, NDArray[np.float64]] = {}
        rotations: dict[Side, NDArray[np.float64]] = {}
        for side in _SIDES:
            position, yaw = self._foothold[side]
            rotations[side] = Footstep(side, 0.0, 0.0, yaw).rotation_sole_to_world
            centers[side] = position[:2] + rotations[side][:2, :2] @ self._vrp_in_sole[side]
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
            side: FootTarget(self._foothold[side][0], rotations[side], share[side] * force, centers[side] + rest)
            for side in _SIDES
        }
