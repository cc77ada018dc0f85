"""Numbers of a walk that fit a robot: posture, height of the CoM, stance, pace and gains, none of them guessed."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.gait.plan.footsteps import straight_plan
from plantar.gravity import GRAVITY
from plantar.robots.kinematics.body import body_of, pitching_joints, stood
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot import Robot
from plantar.robots.walk import CONTROL_PERIOD, Walk, walk_timing
from plantar.settings.body_scale import BodyScale
from plantar.sides import SIDES, Side
from plantar.sim.survey.joint_inertia import JointInertia, joint_inertia
from plantar.sim.survey.plan_reach import PlanReach, Walked, plan_reach, settled, standing_feet
from plantar.sim.survey.rocking_gait import ankle_reach, has_ankle_roll, rocking
from plantar.sim.survey.servo_gains import servo_gains
from plantar.sim.survey.swing_yaw import least_single_support

__all__ = [
    "APPROACH_HEIGHT",
    "APPROACH_SPEED",
    "HELD",
    "KNEE_LEAST",
    "MISSED",
    "QUICK_DOUBLE",
    "QUICK_HELD",
    "QUICK_SINGLE",
    "QUICK_STEP",
    "ROLL_MOST",
    "STEP_SHARE",
    "FittedGait",
    "fit_gait",
    "stance_width",
    "straight_walk",
]

KNEE_LEAST = math.radians(20.0)
"""Bend of the straightest knee over a walk of level steps: h1 walks with 14, hrp2kai with 24 degrees."""

STEP_SHARE = 1.0 / 3.0
"""Length of a step over that of a leg: 0.20 m for the robot h1."""

SWING_SHARE = 1.0 / 12.0
"""Clearance of a swing foot over the length of a leg: 0.05 m for h1."""

MISSED = 2e-3
"""How far in m or rad a solution for the legs may miss: half of what a control period moves."""

HELD = 0.75
"""Share of the torque limits that a planned walk may take; the rest is to balance with."""

ROLL_MOST = math.radians(3.0)
"""Angle of a sole that carries alone against level ground up to which its taxels' soft pad lets it rest whole."""

QUICK_SINGLE, QUICK_DOUBLE, QUICK_STEP = 2.02, 0.404, 0.15
"""Phases in paces and length in legs of the steps that the built-in scenes ask for which walk at a velocity."""

APPROACH_HEIGHT, APPROACH_SPEED = 0.025, 0.0247
"""Height in legs and speed in legs a beat of the slow approach to the ground that the built-in scenes ask for."""

QUICK_HELD = 0.85
"""Share of the torque limits that quick steps may take: OP3's, whose knees took 1.6 of it, sat at a limit in a third of
all ticks and hit the ground with 6 body weights; at 0.85 of it that was 1 %."""

_SEED_BEND = math.radians(40.0)
_SPARE = math.radians(1.0)  # of a joint's range that a walk leaves unused
_LEAST_CROUCH = 0.05  # of the leg: what scenes on unknown ground ask for
_MOST_CROUCH = 0.25
_CROUCH_STEPS = 5
_SLOWER = (1.0, 1.15, 1.3)
_APPROACHES = (1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.75, 2.0)
_PACES = (1.0, 1.2, 1.4, 1.6, 1.8, 2.0)
_SHORTER = (1.0, 0.85, 0.7, 0.55, 0.4)
_BENDS = tuple(math.radians(a) for a in (20.0, 30.0, 40.0, 50.0))
_QUICK_STEPS = 4  # two of each foot
_GAP = 0.25  # of the sole's width between two soles that stand side by side: h1 has 0.3
_SINGLE, _DOUBLE = 3.15, 1.05  # t_ss and t_ds of h1 over sqrt(h / g) of its height
_H1_STEP = 4.85  # beats of a step of h1
_LEAN = 0.48  # rad of trunk lean per leg length of lateral motion, as h1

Array = NDArray[np.float64]


class FittedGait:
    """A robot with numbers that fit, and what they rest on.

    Attributes:
        robot: The robot.
        body: How large it is.
        inertia: Inertia about the joints of a leg.
        reach: What level steps of a third of a leg ask of it.
        notes: What could not be met, and what was assumed.
        rotors: Rotor inertia in kg m^2 about each joint of a leg that the copy of the model has and the model has not.
    """

    def __init__(
        self,
        robot: Robot,
        body: BodyScale,
        inertia: JointInertia,
        reach: PlanReach,
        notes: list[str],
        rotors: Array,
    ) -> None:
        self.robot, self.body, self.inertia, self.reach = robot, body, inertia, reach
        self.notes, self.rotors = tuple(notes), rotors


def straight_walk(robot: Robot, body: BodyScale, com_height: float, steps: int = 6) -> Walked:
    """Level steps of a third of a leg at the robot's own pace.

    Args:
        robot: The robot.
        body: How large it is.
        com_height: Height of its CoM in m.
        steps: Number of steps.

    Returns:
        The walk.
    """
    feet, plan = straight_plan(steps, length=STEP_SHARE * body.leg, width=robot.stance_width)
    timing = walk_timing(Walk().for_body(body), robot, body)
    return Walked(feet, plan, timing, SWING_SHARE * body.leg, com_height)


def fit_gait(draft: Robot, rotors: Array | None = None) -> FittedGait:
    """Fit a walk's numbers to a robot whose names, soles and limits are known.

    Args:
        draft: The robot; its posture, gait and gains are replaced.
        rotors: Rotor inertia in kg m^2 about each joint of a leg that was assumed; None for none.

    Returns:
        The robot with them.

    Raises:
        RobotError: If the legs cannot stand on both soles.
    """
    legs = build_leg_model(draft)
    robot = replace(draft, posture=_bent(draft, legs))
    body = body_of(robot, legs.model)
    notes: list[str] = []
    robot = replace(robot, stance_width=stance_width(robot, legs), trunk_lean=float(f"{_LEAN / body.leg:.2g}"))
    ankle = _ankle(robot, legs)
    bears = ankle_reach(robot, body.weight, ankle)
    if bears is not None:
        robot = replace(robot, ankle_reach=bears)
    seed = _seed_height(robot, legs)
    robot = robot if has_ankle_roll(robot, legs) else replace(robot, rocks=True)
    robot, body, reach = _stepping(robot, legs, body, seed, notes)
    height = robot.com_height
    if robot.rocks:
        notes.append(
            f"without ankle roll soles come off level by up to {math.degrees(reach.roll):.0f} degrees: the robot rocks "
            "from foot to foot in short quick steps, and cannot wait on one of them"
        )
    settled(robot, legs, standing_feet(robot.stance_width), height)
    configuration = legs.configuration
    robot = replace(robot, posture=_angles(robot, legs, configuration))
    inertia = joint_inertia(robot, legs.model, configuration)
    stiffness, damping = servo_gains(inertia, legs.mass, height, body.beat, CONTROL_PERIOD)
    crouch = _crouch(robot, legs, body)
    pace = _pace(robot, legs, body)
    own = _paced(robot, robot.com_height, pace) if pace > 1.0 and not robot.rocks else robot
    held = 0.0 if robot.rocks else least_single_support(robot, legs, body, STEP_SHARE * body.leg)
    robot = replace(
        robot,
        stiffness=tuple(stiffness.tolist()),
        damping=tuple(damping.tolist()),
        largest_crouch=crouch,
        largest_crouch_partial=crouch,
        pace=pace,
        single_support=max(robot.single_support, own.single_support, held),
        double_support=max(robot.double_support, own.double_support),
        balance=_balance(body),
    )
    robot = replace(robot, approach_support=_approach_support(robot, legs, body))
    assumed = np.zeros(len(draft.legs["left"].joints)) if rotors is None else rotors
    light = [name for name, value in zip(draft.legs["left"].joints, assumed, strict=True) if value > 0.0]
    if light:
        notes.append(
            f"the model states no rotor inertia, and {', '.join(light)} would be too light for a servo: up to "
            f"{assumed.max():.2g} kg m^2 is assumed as armature in model.xml, put the motors' there"
        )
    return FittedGait(robot, body, inertia, reach, notes, assumed)


def _balance(body: BodyScale) -> dict[str, Any]:
    """Gains of h1's balance law, in the beat of the robot's legs."""
    beats = {"dcm_gain": 0.742, "zmp_gain": 0.124, "com_gain": 0.247}
    return {"law": "com_admittance", **{k: float(f"{v / body.beat:.3g}") for k, v in beats.items()}}


def _bent(robot: Robot, legs: LegModel) -> dict[Side, tuple[float, ...]]:
    """Legs with their knees bent forward, from the model's own posture."""
    model = legs.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    across = data.xmat[model.body(robot.torso_body).id].reshape(3, 3)[:, 1]
    posture: dict[Side, tuple[float, ...]] = {}
    for side in SIDES:
        ids = [model.joint(n).id for n in robot.legs[side].joints]
        angles = model.qpos0[model.jnt_qposadr[ids]].copy()
        pitch = [ids.index(i) for i in pitching_joints(robot, side, model, data)]
        if len(pitch) < 3:
            raise RobotError(
                f"robot '{robot.name}': the {side} leg has {len(pitch)} joints that pitch; allowed: hip, knee and ankle"
            )
        for k, part in ((pitch[0], -0.5), (pitch[-2], 1.0), (pitch[-1], -0.5)):
            angles[k] += part * _SEED_BEND * math.copysign(1.0, float(data.xaxis[ids[k]] @ across))
        for k, i in enumerate(ids):
            if model.jnt_limited[i]:
                angles[k] = np.clip(angles[k], *model.jnt_range[i])
        posture[side] = tuple(angles.tolist())
    return posture


def stance_width(robot: Robot, legs: LegModel) -> float:
    """Distance in m of the feet side by side: as the model has them, or so far that the soles keep a gap.

    Args:
        robot: The robot.
        legs: Its kinematics.

    Returns:
        The distance of the sole frames' origins.
    """
    angles = np.array([*robot.posture["left"], *robot.posture["right"]])
    feet = legs.posture(angles).positions
    own = float(feet["left"][1] - feet["right"][1])
    outline = robot.layouts["left"].outline
    low, high = outline.min(axis=0), outline.max(axis=0)
    inner = -float(low[1])
    least = 2.0 * inner + _GAP * float(high[1] - low[1])
    return round(max(own, least), 3)


def _seed_height(robot: Robot, legs: LegModel) -> float:
    """Height in m of the CoM above the soles in the robot's posture."""
    posture = legs.posture(np.array([*robot.posture["left"], *robot.posture["right"]]))
    return float(posture.com[2] - np.mean([posture.positions[s][2] for s in SIDES]))


def _paced(robot: Robot, height: float, slower: float) -> Robot:
    """The robot with the pace of a pendulum of its height in m: h1's, in the time sqrt(h / g), or slower.

    One that rocks has its own.
    """
    if robot.rocks:
        return rocking(robot, height)
    unit = slower * math.sqrt(height / GRAVITY)
    return replace(
        robot, single_support=max(0.2, round(_SINGLE * unit, 2)), double_support=max(0.05, round(_DOUBLE * unit, 2))
    )


def _stepping(
    robot: Robot, legs: LegModel, body: BodyScale, seed: float, notes: list[str]
) -> tuple[Robot, BodyScale, PlanReach]:
    """The robot with a height and pace, and the leg that its steps are shares of: the whole one where joints let it."""
    for share in (_rocking_share(robot, body, seed),) if robot.rocks else _SHORTER:
        length = math.floor(1e4 * share * body.leg) / 1e4 if share < 1.0 else body.leg
        shorter = replace(body, leg=length)
        found = _fitted(robot, legs, shorter, seed, notes)
        if found is None:
            continue
        if share < 1.0:
            why = "quick steps are short" if robot.rocks else "joint limits leave no steps of a third of the leg"
            notes.append(f"{why}: steps are shares of leg_length = {length:g} m, not of {body.leg:g} m")
            return replace(found[0], leg_length=length), shorter, found[1]
        return found[0], body, found[1]
    raise RobotError(
        f"robot '{robot.name}': no height of its CoM lets it take steps of {share * STEP_SHARE * body.leg:.3f} "
        "m with bent knees and within its joints' limits; are these the legs, and their limits right?"
    )


def _rocking_share(robot: Robot, body: BodyScale, height: float) -> float:
    """Share of the leg that the steps of a robot that rocks are shares of: they are as short as they are quick, so that
    it walks as fast as h1 in legs a beat."""
    rocks = rocking(robot, height)
    return min(1.0, (rocks.single_support + rocks.double_support) / (_H1_STEP * body.beat))


def _fitted(
    robot: Robot, legs: LegModel, body: BodyScale, seed: float, notes: list[str]
) -> tuple[Robot, PlanReach] | None:
    """The robot at the greatest height and the quickest pace at which its knees stay bent and its motors hold.

    A knee that is almost straight has to move fast, and a quick swing takes torque to move itself: where motors do not
    hold, more bend and a slower pace are tried, the least of both first. None where there is no such height.
    """
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    found: list[tuple[float, Robot, PlanReach]] = []
    for slower, bend in product(*((_SLOWER[:1], _BENDS[1:]) if robot.rocks else (_SLOWER, _BENDS))):
        paced = _paced(robot, seed, slower)
        height, reach = _height(paced, legs, body, seed, bend)
        if reach is None:
            if not found:
                return None  # more bend and more sway reach no further
            continue
        asked = float((reach.torque / limits).max())
        found.append((asked, replace(paced, com_height=height), reach))
        if asked <= HELD:
            break
    asked, best, reach = min(found, key=lambda f: (max(f[0], HELD), found.index(f)))
    if asked > HELD:
        j = int((reach.torque / limits).argmax())
        notes.append(
            f"{robot.legs['left'].joints[j]} needs {reach.torque[j]:.3g} N m for level steps at their best height and "
            f"pace; its limit is {robot.effort_limits[j]:.3g} N m: more than {100.0 * HELD:.0f} % of it leaves little "
            "to balance with"
        )
    return best, reach


def _height(robot: Robot, legs: LegModel, body: BodyScale, seed: float, bend: float) -> tuple[float, PlanReach | None]:
    """The greatest height in m of the CoM at which the knees stay bent by `bend` rad; None where there is none."""

    def bears(missed: float, knee: float, spare: Array) -> bool:
        return missed <= MISSED and knee >= bend and float(spare.min()) >= _SPARE

    def reach(height: float) -> PlanReach:
        return plan_reach(robot, legs, straight_walk(robot, body, height), bears)

    def holds(found: PlanReach) -> bool:
        return bears(found.missed, found.knee, found.spare)

    low = high = seed + 0.15 * body.leg
    found = None
    while found is None and low > seed - 0.4 * body.leg:
        high, low = low, low - 0.06 * body.leg
        now = reach(low)
        found = now if holds(now) else None
    if found is None:
        return low, None
    while high - low > 2e-3 * body.leg:
        middle = 0.5 * (low + high)
        now = reach(middle)
        low, high, found = (middle, high, now) if holds(now) else (low, middle, found)
    return math.floor(1e4 * low) / 1e4, found


def _pace(robot: Robot, legs: LegModel, body: BodyScale) -> float:
    """The least number of beats a pace at which quick steps leave the motors something to balance with; the largest one
    that is tried where none does. One that rocks steps in its own time."""
    if robot.rocks:
        step = robot.single_support + robot.double_support
        return float(f"{step / ((QUICK_SINGLE + QUICK_DOUBLE) * body.beat):.3g}")
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    feet, plan = straight_plan(_QUICK_STEPS, length=QUICK_STEP * body.leg, width=robot.stance_width)
    for beats in _PACES:
        pace = beats * body.beat
        quick = replace(robot, single_support=QUICK_SINGLE * pace, double_support=QUICK_DOUBLE * pace)
        timing = walk_timing(Walk().for_body(body), quick, body)
        asked = plan_reach(robot, legs, Walked(feet, plan, timing, SWING_SHARE * body.leg, robot.com_height))
        if not bool((asked.torque > QUICK_HELD * limits).any()):
            return beats
    return _PACES[-1]


def _approach_support(robot: Robot, legs: LegModel, body: BodyScale) -> float:
    """The least t_ss in s at which a swing that comes down slowly leaves the motors something to balance with; 0 where
    that is the robot's own, or where it rocks and comes down as quickly as ever."""
    if robot.rocks or not robot.effort_limits:
        return 0.0
    limits = np.array(robot.effort_limits)
    approach = (APPROACH_HEIGHT * body.leg, APPROACH_SPEED * body.leg / body.beat)
    height = robot.com_height - min(robot.largest_crouch, _LEAST_CROUCH * body.leg)
    for longer in _APPROACHES:
        slow = replace(robot, single_support=longer * robot.single_support)
        walk = straight_walk(slow, body, height, _QUICK_STEPS)
        asked = plan_reach(slow, legs, replace(walk, approach_height=approach[0], approach_speed=approach[1]))
        if not bool((asked.torque > QUICK_HELD * limits).any()):
            break
    return round(slow.single_support, 2) if longer > 1.0 else 0.0


def _ankle(robot: Robot, legs: LegModel) -> int:
    """Which joint of a leg pitches the foot."""
    pitching = pitching_joints(robot, "left", legs.model, stood(robot, legs.model))
    return [legs.model.joint(name).id for name in robot.legs["left"].joints].index(pitching[-1])


def _angles(robot: Robot, legs: LegModel, configuration: Array) -> dict[Side, tuple[float, ...]]:
    """Joint angles of each leg in rad in a configuration."""
    places = {s: [legs.model.joint(n).qposadr[0] for n in robot.legs[s].joints] for s in SIDES}
    return {s: tuple(float(configuration[i]) for i in places[s]) for s in SIDES}


def _crouch(robot: Robot, legs: LegModel, body: BodyScale) -> float:
    """How much lower in m the robot can walk: its joints stay in range and below three quarters of their torque."""
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    fits = 0.0
    for lower in np.linspace(_LEAST_CROUCH, _MOST_CROUCH, _CROUCH_STEPS).tolist():
        found = plan_reach(robot, legs, straight_walk(robot, body, robot.com_height - lower * body.leg))
        enough = found.missed <= MISSED and float(found.spare.min()) >= _SPARE
        if not enough or bool((found.torque > HELD * limits).any()):
            break
        fits = lower
    return math.floor(1e3 * max(fits, _LEAST_CROUCH) * body.leg) / 1e3
