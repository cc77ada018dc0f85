"""Demands of a walk's plan on the legs, without physics."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.feet.swing import SwingTrajectory
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.leg_momentum import LegMomentum
from plantar.gait.plan.phases import Phase, PhaseKind, Timing
from plantar.gait.plan.walk_plan import WalkPlan, vrp_of_step
from plantar.mechanics.lip import GRAVITY, pendulum_frequency
from plantar.mechanics.rotation import rotation_from_angles
from plantar.robots.kinematics.body import pitching_joints, stood
from plantar.robots.kinematics.command_joints import SPEED_SHARE
from plantar.robots.kinematics.leg_inertia import angular_momentum, leg_inertia
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.standing_posture import posture_of
from plantar.robots.robot import Robot
from plantar.robots.survey.first_posture import knees_ahead
from plantar.robots.survey.servo_gains import floating_inertia

_INSTANTS = 24  # that are looked at in a single support; a swing foot moves by a twelfth of a step meanwhile at most
_FIRST = 40  # Newton steps for the standing posture
_ARRIVES = 0.94  # of a swing, after which its foot only descends
_EACH = 3  # Newton steps for each later instant
_BEGIN = 0.5  # s: standing time before the walk
_SWINGING = 0.1  # of what a swinging foot misses counts
_LANDING = 0.1  # of a swing, at its end, in which all of it counts
_HOPELESS = 0.05  # m or rad by which the legs miss what is asked of them: the rest of the plan is not looked at
# Mean distance of a rectangle's points from its middle, over its diagonal: 0.25 of a line, 0.27 of a square
_ARM = 0.26
_FRICTION = 0.8  # of the ground that scenes lay unless they state another (`terrain.friction`)
_STEP = 0.15  # rad: largest change in a Newton step, see plantar.robots.kinematics.inverse_kinematics

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Walked:
    """A walk to be examined.

    `swing_height`: clearance in m; `com_height`: above the soles in m; `lean`: roll of torso over stance foot in rad
    per metre of lateral CoM motion; `approach_height`: height in m above ground where a slow approach begins;
    `approach_speed` in m/s.
    """

    feet: Mapping[Side, Footstep]
    steps: Sequence[Footstep]
    timing: Timing
    swing_height: float
    com_height: float
    lean: float = 0.0
    approach_height: float = 0.0
    approach_speed: float = 0.06


@dataclass(frozen=True)
class PlanReach:
    """Demands of a plan on the legs.

    Attributes:
        missed: Largest distance in m by which CoM or a standing sole misses its place, or a tenth of a swinging one's.
        low: How far in m a swinging foot stays below its path at most.
        knee: Least bend of a knee in rad, the way the posture bends it; negative the other way.
        straightest: Time in s of that.
        spare: Least distance in rad of each joint of a carrying leg to its limits, over both legs.
        torque: Largest torque in N m of each joint, over both legs: to carry, against damping and inertia, and against
            what a swinging leg takes.
        speed: Largest speed in rad/s of each joint, over both legs.
        shift: Largest share of the way to the sole's edge by which a swinging leg moves the ZMP along it.
        turn: Largest share of friction's moment by which it turns the sole that carries.
        roll: Largest angle in rad off level of a sole that carries alone.
    """

    missed: float
    low: float
    knee: float
    straightest: float
    spare: Array
    torque: Array
    carrying: Array
    speed: Array
    shift: float
    turn: float
    roll: float


def speed_shares(robot: Robot, reach: PlanReach) -> Array:
    """Returns the share of its usable speed that each joint of a `robot` takes in a `reach`; 0 without limits."""
    return np.asarray(reach.speed / (SPEED_SHARE * np.array(robot.velocity_limits or np.inf)))


def settled(robot: Robot, legs: LegModel, feet: Mapping[Side, Footstep], com_height: float) -> float:
    """Stand the `legs` of a `robot` on `feet`, CoM at `com_height` in m; returns the error in m or rad."""
    middle = np.mean([vrp_of_step(feet[s], robot.middle_of_sole(s)) for s in SIDES], axis=0)
    com = np.array([middle[0], middle[1], feet["left"].z + com_height])
    posture = posture_of(robot, legs)
    positions = {s: feet[s].position for s in SIDES}
    rotations = {s: feet[s].rotation_sole_to_world for s in SIDES}
    legs.set_configuration(com, np.array([1.0, 0.0, 0.0, 0.0]), posture)
    given = (com, posture, *positions.values(), *rotations.values())
    key = ("settled", *(np.asarray(values, dtype=float).tobytes() for values in given))
    if key in legs.known:
        error, configuration = legs.known[key]
        legs.restore(configuration)
        return float(error)
    error = legs.follow(com, np.eye(3), positions, rotations, iterations=_FIRST, largest_step=_STEP)
    legs.known[key] = (error, legs.configuration)
    return error


def missed_aside(robot: Robot, legs: LegModel, aside: float) -> float:
    """Returns the error in m or rad of a `robot`'s left foot set `aside` in m, the CoM over the other, which ankles of
    short range do not reach; its `legs` are left so.
    """
    feet, _ = straight_plan(0, width=robot.stance_width)
    settled(robot, legs, feet, robot.com_height)
    feet["left"] = replace(feet["left"], y=feet["left"].y + aside)
    x, y = vrp_of_step(feet["right"], robot.middle_of_sole("right")).tolist()
    return legs.follow(
        np.array([x, y, feet["right"].z + robot.com_height]),
        rotation_from_angles(0.0, roll=-robot.trunk_lean * (y - 0.5 * (feet["left"].y + feet["right"].y))),
        {s: feet[s].position for s in SIDES},
        {s: feet[s].rotation_sole_to_world for s in SIDES},
        iterations=_FIRST,
        largest_step=_STEP,
    )


def plan_reach(
    robot: Robot, legs: LegModel, walked: Walked, bears: Callable[[float, float, Array], bool] = lambda *_: True
) -> PlanReach:
    """Go through a planned walk on level ground.

    `bears`: given `missed`, `knee` and `spare` so far, which only worsen; False ends the pass. Returns demands on the
    legs; infinite torques if ended early.
    """
    found = _Pass(robot, legs, walked)
    if not bears(found.missed, found.knee, found.spare):
        return found.broken_off()
    found.set_out(robot)
    return found.result() if found.go_through(bears) else found.broken_off()


class _Held(NamedTuple):
    """A standing foot: sole origin (3,) in m, rotation (3, 3), VRP (2,) and the point (3,) on the ground under it."""

    position: Array
    rotation: Array
    vrp: Array
    point: Array


class _Pass:
    def __init__(self, robot: Robot, legs: LegModel, walked: Walked) -> None:
        self.legs = legs
        self.walked = walked
        self.middles = {s: robot.middle_of_sole(s) for s in SIDES}
        self.outline = robot.layouts["left"].outline
        self.every = walked.timing.single_support / _INSTANTS
        self.missed = settled(robot, legs, walked.feet, walked.com_height)
        self.low = 0.0
        self.probe = _Probe(robot, legs)
        self.knee = self.probe.knees(legs)
        self.straightest = 0.0
        self.spare = self.probe.spare(legs, SIDES)
        self.roll = 0.0
        self.seen: list[tuple[Array, ...]] = []
        self.held: dict[Footstep, _Held] = {}
        self.swings: dict[int, SwingTrajectory] = {}
        self.feet = dict(walked.feet)
        self.ground = float(np.mean([foot.z for foot in walked.feet.values()]))

    def set_out(self, robot: Robot) -> None:
        """Plan the walk from the standing posture."""
        walked = self.walked
        self.inertia = leg_inertia(robot, self.legs, walked.com_height).turning
        frequency = pendulum_frequency(walked.com_height, 2.0 * self.inertia)
        self.plan = WalkPlan(walked.feet, walked.steps, walked.timing, self.middles, frequency, begin=_BEGIN)
        self.momentum = LegMomentum(self.plan, frequency, self.inertia, _ARRIVES)
        settled(robot, self.legs, walked.feet, walked.com_height)  # the legs moved to find their inertia

    def go_through(self, bears: Callable[[float, float, Array], bool]) -> bool:
        """Look at each instant; returns whether the walk goes on to its end. Known legs are not moved again."""
        walked = self.walked
        key = (
            *("walked", *walked.feet.items(), *walked.steps, walked.timing, walked.swing_height, walked.com_height),
            *(walked.lean, walked.approach_height, walked.approach_speed, self.inertia, bears),
            *(values.tobytes() for values in (self.legs.configuration, *self.middles.values())),
        )
        if key not in self.legs.known:
            before = dict(vars(self))
            ends = self._looked(bears)
            found = {name: value for name, value in vars(self).items() if value is not before[name]}
            self.legs.known[key] = (ends, {**found, "seen": self.seen}, self.legs.configuration)
        ends, found, configuration = self.legs.known[key]
        vars(self).update(found)
        self.legs.restore(configuration)
        return bool(ends)

    def _looked(self, bears: Callable[[float, float, Array], bool]) -> bool:
        for time in np.arange(_BEGIN, self.plan.schedule.walking_end + self.every, self.every).tolist():
            self.look(time)
            if not (self.missed < _HOPELESS and bears(self.missed, self.knee, self.spare)):
                return False
        return True

    def look(self, time: float) -> None:
        walked = self.walked
        legs = self.legs
        feet = self.feet
        phase = self.plan.schedule.at(time)
        shift = self.momentum.at(time)
        reference = self.plan.at(time).plus(shift)
        for foot in walked.steps[: phase.step]:
            feet[foot.side] = foot
        held = {s: self._held(feet[s]) for s in SIDES}
        positions = {s: held[s].position for s in SIDES}
        rotations = {s: held[s].rotation for s in SIDES}
        if phase.kind == PhaseKind.SINGLE_SUPPORT and phase.swing is not None:
            share = {s: 0.0 if s == phase.swing else 1.0 for s in SIDES}
            path = self._swing(phase, feet[phase.swing])
            positions[phase.swing], yaw = path.at(time - phase.start)
            if walked.approach_height > 0.0:  # the path goes on below level ground, which stops the foot
                positions[phase.swing][2] = max(positions[phase.swing][2], walked.steps[phase.step].z)
            rotations[phase.swing] = rotation_from_angles(yaw)
        else:
            share = _shares(reference.vrp, held["left"].vrp, held["right"].vrp)
        com = np.array([*reference.com, self.ground + walked.com_height])
        middle = 0.5 * (positions["left"] + positions["right"])  # of where the feet are: steps aside move it
        torso = rotation_from_angles(0.0, roll=-walked.lean * float(reference.com[1] - middle[1]))
        carrying = [s for s in SIDES if share[s] > 0.0]
        yielding = [s for s in SIDES if share[s] == 0.0]
        legs.follow(com, torso, positions, rotations, iterations=_EACH, yielding=yielding, largest_step=_STEP)
        bend = self.probe.knees(legs)
        if bend < self.knee:
            self.knee = bend
            self.straightest = time - _BEGIN
        for s in SIDES:  # what a swinging foot misses in the air is made up for before it lands
            lands = s in carrying or phase.end - time < _LANDING * (phase.end - phase.start)
            self.missed = max(self.missed, (1.0 if lands else _SWINGING) * self.probe.off(s, positions[s]))
        for s in yielding:
            self.low = max(self.low, self.probe.below(s, positions[s]))
        self.missed = max(self.missed, self.probe.com_off(com))
        self.spare = np.minimum(self.spare, self.probe.spare(legs, carrying))
        points = {s: held[s].point for s in SIDES}
        alone = carrying if len(carrying) == 1 else []
        for s in alone:
            points[s] = np.array([*reference.vrp, feet[s].z])
            self.roll = max(self.roll, self.probe.tilt(s))
        force = legs.mass * np.array([*reference.com_acceleration, GRAVITY])
        x, y = (-shift.vrp - 2.0 * self.inertia * reference.com_acceleration).tolist()
        given = legs.mass * GRAVITY * np.array([y, -x, 0.0])  # N m about the CoM by the feet's forces
        legs.carry({s: share[s] * force for s in SIDES}, points)
        lone = np.repeat([float(alone == [s]) for s in SIDES], len(self.spare))  # 1 for joints that carry alone
        self.seen.append((legs.configuration, lone, self.probe.axes(), legs.torques.copy(), given))

    def _held(self, foot: Footstep) -> _Held:
        """Where a standing foot is: computed once a step."""
        if foot not in self.held:
            vrp = vrp_of_step(foot, self.middles[foot.side])
            self.held[foot] = _Held(foot.position, foot.rotation_sole_to_world, vrp, np.array([*vrp, foot.z]))
        return self.held[foot]

    def _swing(self, phase: Phase, start: Footstep) -> SwingTrajectory:
        if phase.step not in self.swings:
            walked = self.walked
            target = walked.steps[phase.step]
            duration = phase.end - phase.start
            self.swings[phase.step] = SwingTrajectory(
                *(start.position, target.position, start.yaw, target.yaw, walked.swing_height, duration),
                approach_height=walked.approach_height,
                approach_speed=walked.approach_speed,
            )
        return self.swings[phase.step]

    def broken_off(self) -> PlanReach:
        never = np.full(len(self.spare), math.inf)
        spare = self.spare if self.missed < _HOPELESS else -never
        return PlanReach(
            self.missed, self.low, self.knee, self.straightest, spare, never, never, never, math.inf, math.inf, math.pi
        )

    def result(self) -> PlanReach:
        configurations, alone, axes, static, given = map(np.array, zip(*self.seen, strict=True))
        moved = np.gradient(configurations[:, self.probe.places], self.every, axis=0)
        moving = self.probe.damping * moved + self.probe.swinging * np.gradient(moved, self.every, axis=0)
        # The ground gives the swinging leg its angular momentum about the CoM, through the leg that carries.
        moment = np.gradient(self.probe.angular_momenta(configurations, self.every), self.every, axis=0)
        reaction = -alone * np.einsum("tjx,tx->tj", axes, moment - given)
        torque, carrying, speed = (
            np.abs(amount).max(axis=0).reshape(2, -1).max(axis=0)
            for amount in (static + moving + reaction, static, moved)
        )
        _, about_y, about_z = np.abs(moment[alone.any(axis=1)]).max(axis=0, initial=0.0)
        low = self.outline.min(axis=0)
        high = self.outline.max(axis=0)
        weight = self.legs.mass * GRAVITY
        place = self.middles["left"][0]
        shift = about_y / (weight * min(high[0] - place, place - low[0]))
        turn = about_z / (_FRICTION * weight * _ARM * math.hypot(*(high - low)))
        return PlanReach(
            self.missed,
            self.low,
            self.knee,
            self.straightest,
            self.spare,
            torque,
            carrying,
            speed,
            float(shift),
            float(turn),
            self.roll,
        )


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _square_to(axis: Sequence[float], start: Sequence[float], end: Sequence[float]) -> tuple[float, float, float]:
    """The part of the way from `start` to `end` that is square to a unit vector `axis`."""
    x = end[0] - start[0]
    y = end[1] - start[1]
    z = end[2] - start[2]
    along = _dot((x, y, z), axis)
    return x - along * axis[0], y - along * axis[1], z - along * axis[2]


def _shares(vrp: Array, left: Array, right: Array) -> dict[Side, float]:
    along = left - right
    part = float(np.clip((vrp - right) @ along / max(float(along @ along), 1e-12), 0.0, 1.0))
    return {"left": part, "right": 1.0 - part}


class _Probe:
    def __init__(self, robot: Robot, legs: LegModel) -> None:
        model = legs.model
        self._data = stood(robot, model)
        ids = [model.joint(n).id for s in SIDES for n in robot.legs[s].joints]
        self.places = model.jnt_qposadr[ids]
        self._joints = ids
        dofs = model.jnt_dofadr[ids]
        self.damping = model.dof_damping[dofs]
        self.swinging = floating_inertia(model, legs.configuration)[dofs]
        free = model.jnt_limited[ids] == 0
        self._low = np.where(free, -math.inf, model.jnt_range[ids, 0])
        self._high = np.where(free, math.inf, model.jnt_range[ids, 1])
        self._model = model
        self._torso = model.body(robot.torso_body).id
        self._root = int(model.body_rootid[self._torso])
        self._soles = {s: model.site(robot.legs[s].sole_site).id for s in SIDES}
        self._pitch: list[tuple[int, int, int]] = []
        for side in SIDES:
            pitch = pitching_joints(robot, side, model, self._data)
            if len(pitch) >= 3:
                self._pitch.append((pitch[0], pitch[-2], pitch[-1]))
        self._way = -1.0 if knees_ahead(robot, model) else 1.0

    def knees(self, legs: LegModel) -> float:
        """Least bend of a knee in rad, from thigh to shank about the torso's y axis, the way the posture bends it."""
        self._data.qpos[:] = legs.configuration
        mujoco.mj_kinematics(self._model, self._data)
        across = self._data.xmat[self._torso, 1::3].tolist()
        anchors = self._data.xanchor.tolist()
        axes = self._data.xaxis.tolist()
        bends = []
        for hip, knee, ankle in self._pitch:  # in plain numbers: numpy takes three times as long for vectors of three
            axis = axes[knee] if _dot(axes[knee], across) >= 0.0 else [-x for x in axes[knee]]
            a, b, c = _square_to(axis, anchors[hip], anchors[knee])
            d, e, f = _square_to(axis, anchors[knee], anchors[ankle])
            around = [b * f - c * e, c * d - a * f, a * e - b * d]
            bends.append(self._way * math.atan2(_dot(around, axis), a * d + b * e + c * f))
        return min(bends, default=math.pi)

    def off(self, side: Side, position: Array) -> float:
        return float(np.linalg.norm(self._data.site_xpos[self._soles[side]] - position))

    def below(self, side: Side, position: Array) -> float:
        """How far in m a sole is below its place, likewise."""
        return float(position[2] - self._data.site_xpos[self._soles[side], 2])

    def com_off(self, com: Array) -> float:
        mujoco.mj_comPos(self._model, self._data)
        return float(np.linalg.norm(self._data.subtree_com[self._root] - com))

    def tilt(self, side: Side) -> float:
        """Angle in rad of a sole against level ground, likewise."""
        return math.acos(min(1.0, float(self._data.site_xmat[self._soles[side], 8])))

    def axes(self) -> Array:
        """Axes (2 k, 3) of the legs' joints in the world, likewise."""
        return np.asarray(self._data.xaxis[self._joints])

    def angular_momenta(self, configurations: Array, every: float) -> Array:
        """Angular momenta (n, 3) in N m s about the CoM of configurations (n, nq) that follow `every` so many s."""
        model = self._model
        data = self._data
        found = np.zeros((len(configurations), 3))
        for i in range(1, len(configurations) - 1):
            before, now, after = configurations[i - 1 : i + 2]
            found[i] = angular_momentum(model, data, 2.0 * every, before, after, now)[self._root]
        data.qvel[:] = 0.0
        return found

    def spare(self, legs: LegModel, sides: Sequence[Side]) -> Array:
        angles = legs.configuration[self.places]
        spare = np.minimum(angles - self._low, self._high - angles).reshape(2, -1)
        return np.asarray(spare[[SIDES.index(s) for s in sides]].min(axis=0))
