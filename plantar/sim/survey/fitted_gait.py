"""A walk that fits a robot: posture, stance, pace and gains."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

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
from plantar.sim.survey.first_posture import SOLE_GAP, bent_posture, posture_height, stance_width
from plantar.sim.survey.plan_reach import PlanReach, Walked, plan_reach, settled, standing_feet
from plantar.sim.survey.servo_gains import JointInertia, joint_inertia, servo_gains
from plantar.sim.survey.step_time import ankle_reach, has_ankle_roll, rocking

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
    "SHIFT",
    "STEP_SHARE",
    "TURN",
    "FittedGait",
    "fit_gait",
    "straight_walk",
]

KNEE_LEAST = math.radians(20.0)
"""Bend of the straightest knee over a walk of level steps: h1 walks with 14, hrp2kai with 24 degrees."""

STEP_SHARE = 1.0 / 3.0
"""Length of a step over that of a leg: 0.20 m for the robot h1."""

MISSED = 2e-3
"""How far in m or rad a solution for the legs may miss: half of what a control period moves."""

HELD = 0.75
"""Share of the torque limits that a planned walk may take; the rest is to balance with."""

SHIFT, TURN = 0.16, 0.15
"""Shares of the way to the sole's edge by which a swinging leg may move the ZMP, and of friction's moment by which it
may turn the sole. Legs of servos sway at about the pace of a swing, so that three times the ZMP's way is seen: h1 has
0.19 and 0.08, JVRC-1 fell with 0.35 and 0.13."""

ROLL_MOST = math.radians(3.0)
"""Angle of a sole that carries alone against level ground up to which its taxels' soft pad lets it rest whole."""

QUICK_SINGLE, QUICK_DOUBLE, QUICK_STEP = 2.02, 0.404, 0.15
"""Phases in paces and length in legs of the steps that the built-in scenes ask for which walk at a velocity."""

APPROACH_HEIGHT, APPROACH_SPEED = 0.025, 0.0247
"""Height in legs and speed in legs a beat of the slow approach to the ground that the built-in scenes ask for."""

QUICK_HELD = 0.85
"""Share of the torque limits that quick steps may take: OP3's, whose knees took 1.6 of it, sat at a limit in a third of
all ticks and hit the ground with 6 body weights; at 0.85 of it that was 1 %."""

_OWN_STIFFNESS = 6.0  # over m g h, from which the model's own servos are kept: half of what h1 has
_TURNING = 5  # joints of a leg from which it turns its foot
_SPARE = math.radians(1.0)  # of a joint's range that a walk leaves unused
_LEAST_CROUCH = 0.05  # of the leg: what scenes on unknown ground ask for
_MISSED_CROUCHING = 0.01  # m
_CROUCHED = 0.88  # of the torque limits, for that crouch
_FULL = 0.95  # of the torque limits: no knee bends for more
_MORE_BENT, _STRONG = math.radians(10.0), 0.6  # of knees, and share of the torque limits from which they are
_CROUCHES = (0.02, 0.035, _LEAST_CROUCH, 0.1, 0.15, 0.2, 0.25)  # of the leg
_APPROACHES = (1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.75, 2.0)
_PACES = (1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.3, 2.6)
_QUICK_SHIFT = 0.33  # of quick steps, as `SHIFT`: those of h1 have 0.26
_QUICK_STEPS = 4  # two of each foot
_WIDE = 0.33  # of the leg: distance of the feet above which a narrower stance is tried, too; h1 has 0.28
_SINGLE, _DOUBLE = 3.15, 1.05  # t_ss and t_ds of h1 over sqrt(h / g) of its height
_H1_STEP = 4.85  # beats of a step of h1
_LEAN = 0.48  # rad of trunk lean per leg length of lateral motion, as h1

_SHORTER = (1.0, 0.85, 0.7, 0.55, 0.4)
_OTHER_PACES = (0.8, 1.25, 0.64, 1.6)
_TRIED_LEANS = (1.0, 1.6, 2.4)
_TRIED_STANCES = (0.3, 0.24)  # of the leg
_HIGHEST, _LOWEST, _LOWER = 0.15, 0.45, 0.04  # of the leg, above and below the posture with knees of 40 degrees
_WORSE = 3  # heights in a row that cost more, below which no others are looked at
_LEAST_KNEE = math.radians(10.0)
_GOOD = 0.3
"""Cost of a walk from which no other one is looked for: level steps at h1's pace with 75 % of the torque have 0.15."""
_OTHER_SPEED, _OTHER_LEAN, _OTHER_STANCE = 0.6, 0.1, 0.15
"""Cost of steps half as long, or of twice or half the pace; of each further lean, and stance."""

Array = NDArray[np.float64]


class FittedGait:
    """A robot with numbers that fit, and their reasons.

    Attributes:
        inertia: About the joints of a leg.
        reach: Demands of level steps of a third of a leg.
        notes: What was not met or was assumed.
        rotors: Additional rotor inertia in kg m^2 about each leg joint of the model's copy.
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
    """Returns level steps of a third of a leg at a `robot`'s pace.

    Args:
        robot: The robot.
        body: Its size.
        com_height: In m.
        steps: Their number.
    """
    feet, plan = straight_plan(steps, length=STEP_SHARE * body.leg, width=robot.stance_width)
    walk = Walk().for_body(body)
    return Walked(feet, plan, walk_timing(walk, robot, body), walk.swing_height, com_height, robot.trunk_lean)


def fit_gait(draft: Robot, gains: Sequence[tuple[float, float]] = (), rotors: Array | None = None) -> FittedGait:
    """Fit a walk to a robot of known names, soles and limits.

    Args:
        draft: The robot; its posture, gait and gains are replaced.
        gains: The model's stiffness in N m/rad and damping in N m s/rad of each leg joint, or empty.
        rotors: Assumed rotor inertia in kg m^2 about each leg joint, or None.

    Returns:
        The robot with its numbers.

    Raises:
        RobotError: If it cannot stand.
    """
    legs = build_leg_model(draft)
    robot = replace(draft, posture=bent_posture(draft, legs))
    body = body_of(robot, legs.model)
    notes: list[str] = []
    robot = replace(robot, stance_width=stance_width(robot, legs))
    ankle = _ankle(robot, legs)
    bears = ankle_reach(robot, body.weight, ankle)
    if bears is not None:
        robot = replace(robot, ankle_reach=bears)
    seed = posture_height(robot, legs)
    robot = robot if has_ankle_roll(robot, legs) else replace(robot, rocks=True)
    robot, body, reach = _stepping(robot, legs, body, seed, notes)
    height = robot.com_height
    if robot.rocks:
        notes.append(
            f"without ankle roll soles come off level by up to {math.degrees(reach.roll):.0f} degrees: the robot rocks "
            "from foot to foot in short quick steps, and cannot wait on one of them"
        )
    if len(robot.posture["left"]) < _TURNING:
        notes.append("legs of four joints do not turn the feet: the robot walks straight ahead")
    settled(robot, legs, standing_feet(robot.stance_width), height)
    configuration = legs.configuration
    robot = replace(robot, posture=_angles(robot, legs, configuration))
    inertia = joint_inertia(robot, legs.model, configuration)
    stiffness, damping = _gains(robot, inertia, legs, body, gains, notes)
    own = _own_gains(inertia, gains) if gains else np.array([stiffness, damping])
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    crouch = _crouch(robot, legs, body, float((reach.torque / limits).max()))
    pace = _pace(robot, legs, body)
    robot = replace(
        robot,
        stiffness=tuple(stiffness.tolist()),
        damping=tuple(damping.tolist()),
        own_stiffness=tuple(own[0].tolist()),
        own_damping=tuple(own[1].tolist()),
        largest_crouch=crouch,
        largest_crouch_partial=crouch,
        pace=pace,
        balance=_balance(body),
    )
    robot = replace(robot, approach_support=_approach_support(robot, legs, body))
    assumed = np.zeros(len(draft.legs["left"].joints)) if rotors is None else rotors
    light = [name for name, value in zip(draft.legs["left"].joints, assumed, strict=True) if value > 0.0]
    if light:
        notes.append(
            f"the model states no rotor inertia, and {', '.join(light)} would be too light for a stiff servo: up to "
            f"{assumed.max():.2g} kg m^2 is assumed as armature in model.xml, put the motors' there"
        )
    return FittedGait(robot, body, inertia, reach, notes, assumed)


def _gains(
    robot: Robot,
    inertia: JointInertia,
    legs: LegModel,
    body: BodyScale,
    gains: Sequence[tuple[float, float]],
    notes: list[str],
) -> tuple[Array, Array]:
    height, limits = robot.com_height, robot.effort_limits
    stiffness, damping = servo_gains(inertia, legs.mass, height, body.beat, CONTROL_PERIOD, limits)
    if gains:
        own, unit = _own_gains(inertia, gains), body.weight * height
        kept = bool((own[0] >= _OWN_STIFFNESS * unit).all())
        least, most = own[0].min(), own[0].max()
        notes.append(
            f"the model's own servos have {least:.3g} to {most:.3g} N m/rad; "
            + (
                "they are kept"
                if kept
                else f"they are replaced, as position servos that hold the robot need {_OWN_STIFFNESS:g} m g h = "
                f"{_OWN_STIFFNESS * unit:.3g}"
            )
        )
        if kept:
            return own[0], own[1]
    return stiffness, damping


def _own_gains(inertia: JointInertia, gains: Sequence[tuple[float, float]]) -> Array:
    """Stiffness and damping (2, k) of the model's servos; damping below 0 is a ratio of critical."""
    stiffness, damping = np.array(gains).T
    critical = 2.0 * np.sqrt(stiffness * inertia.swing)
    return np.array([stiffness, np.where(damping < 0.0, -damping * critical, damping)])


def _balance(body: BodyScale) -> dict[str, Any]:
    beats = {"dcm_gain": 0.742, "zmp_gain": 0.124, "com_gain": 0.247}
    return {"law": "com_admittance", **{k: float(f"{v / body.beat:.3g}") for k, v in beats.items()}}


def _paced(robot: Robot, height: float, slower: float) -> Robot:
    """The robot with a pendulum's pace of its height in m, or slower."""
    if robot.rocks:
        return rocking(robot, height)
    unit = slower * math.sqrt(height / GRAVITY)
    return replace(
        robot, single_support=max(0.2, round(_SINGLE * unit, 2)), double_support=max(0.05, round(_DOUBLE * unit, 2))
    )


def _stepping(
    robot: Robot, legs: LegModel, body: BodyScale, seed: float, notes: list[str]
) -> tuple[Robot, BodyScale, PlanReach]:
    best: _Tried | None = None
    heights = seed + body.leg * np.arange(_HIGHEST, -_LOWEST, -_LOWER)
    for share in (_rocking_share(robot, body, seed),) if robot.rocks else _SHORTER:
        shorter = replace(body, leg=math.floor(1e4 * share * body.leg) / 1e4 if share < 1.0 else body.leg)
        paid = 0.0 if robot.rocks else _OTHER_SPEED * -math.log2(share)
        for other, changed in _others(robot, body):
            if best is None or paid + changed < best.cost > _GOOD:
                best = _least(best, other, legs, shorter, heights, paid + changed)
        if best is not None and best.body.leg == shorter.leg:
            best = _refined(best if robot.rocks else _other_paces(best, legs, heights), legs)
    if best is None:
        raise RobotError(
            f"robot '{robot.name}': no height of its CoM, pace or stance lets it take steps of "
            f"{share * STEP_SHARE * body.leg:.3f} m within its joints' limits; nearest is "
            f"{_nearest(robot, legs, body, seed)}"
        )
    best = best if robot.rocks else _slowed(best, legs, heights)
    if best.body.leg < body.leg:
        why = "quick steps are short" if robot.rocks else "joints or motors leave no steps of a third of the leg"
        notes.append(f"{why}: steps are shares of leg_length = {best.body.leg:g} m, not of {body.leg:g} m")
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.full(len(best.reach.torque), np.inf)
    j = int((best.reach.torque / limits).argmax())
    if best.reach.torque[j] > HELD * limits[j]:
        notes.append(
            f"{robot.legs['left'].joints[j]} needs {best.reach.torque[j]:.3g} N m for level steps at their best height "
            f"and pace; its limit is {limits[j]:.3g} N m: more than {100.0 * HELD:.0f} % of it leaves little to "
            "balance with"
        )
    return replace(best.robot, leg_length=best.body.leg if best.body.leg < body.leg else 0.0), best.body, best.reach


def _other_paces(found: _Tried, legs: LegModel, heights: Array) -> _Tried:
    best = found
    for pace in _OTHER_PACES:
        paid = found.paid + _OTHER_SPEED * abs(math.log2(pace))
        if paid < best.cost > _GOOD:
            best = _least(best, replace(found.robot, pace=pace), legs, found.body, heights, paid) or best
    return best


def _slowed(found: _Tried, legs: LegModel, heights: Array) -> _Tried:
    """The same steps so slow that the swinging leg neither rocks nor turns the robot: both fall with time squared."""
    longer = math.sqrt(max(found.reach.shift / SHIFT, found.reach.turn / TURN))
    if longer <= 1.0:
        return found
    slower = replace(found.robot, pace=longer * found.robot.pace)
    best = _least(None, slower, legs, found.body, heights, found.paid)
    return found if best is None else _refined(best, legs)


@dataclass(frozen=True)
class _Tried:
    cost: float
    paid: float
    robot: Robot
    body: BodyScale
    reach: PlanReach


def _others(robot: Robot, body: BodyScale) -> list[tuple[Robot, float]]:
    outline = robot.layouts["left"].outline[:, 1]
    least = -2.0 * float(outline.min()) + SOLE_GAP * float(np.ptp(outline))
    widths = [robot.stance_width]
    if robot.stance_width > _WIDE * body.leg:
        widths += [round(max(least, share * body.leg), 3) for share in _TRIED_STANCES]
    found = [
        (
            replace(robot, stance_width=width, trunk_lean=float(f"{lean * _LEAN / body.leg:.2g}")),
            i * _OTHER_STANCE + j * _OTHER_LEAN,
        )
        for i, width in enumerate(dict.fromkeys(widths))
        for j, lean in enumerate(_TRIED_LEANS)
    ]
    return sorted(found, key=lambda f: f[1])


def _least(
    best: _Tried | None, robot: Robot, legs: LegModel, body: BodyScale, heights: Array, paid: float
) -> _Tried | None:
    own, worse = math.inf, 0
    for height in heights.tolist():
        tried = _tried(robot, legs, body, height, paid)
        if tried is None:
            continue
        worse = worse + 1 if tried.cost > own else 0
        own = min(own, tried.cost)
        if best is None or tried.cost < best.cost:
            best = tried
        if worse == _WORSE:
            break
    return best


def _tried(robot: Robot, legs: LegModel, body: BodyScale, height: float, paid: float) -> _Tried | None:
    robot = replace(_paced(robot, height, robot.pace), com_height=math.floor(1e4 * height) / 1e4)
    reach = plan_reach(robot, legs, straight_walk(robot, body, robot.com_height, _QUICK_STEPS), _bears)
    if not _bears(reach.missed, reach.knee, reach.spare):
        return None
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    asked = float(np.maximum(reach.carrying / limits, HELD * reach.torque / limits).max())
    # A robot that cannot crouch needs bent knees as it is: those that are almost straight throw the leg as it lands.
    more = 1.0 if robot.rocks else min(1.0, max(0.0, (asked - _STRONG) / (HELD - _STRONG)))
    least = KNEE_LEAST + more * _MORE_BENT
    straight, bent = max(0.0, least - reach.knee), max(0.0, reach.knee - least)
    over = 4.0 * max(0.0, asked - HELD) + 20.0 * max(0.0, asked - _FULL)
    cost = paid + 0.2 * asked + over + 6.0 * straight + 0.5 * bent
    return _Tried(cost, paid, robot, body, reach)


def _bears(missed: float, knee: float, spare: Array) -> bool:
    return missed <= MISSED and knee >= _LEAST_KNEE and float(spare.min()) >= _SPARE


def _refined(best: _Tried, legs: LegModel) -> _Tried:
    step = 0.5 * _LOWER * best.body.leg
    while step > 2e-3 * best.body.leg:
        near = best.robot.com_height + step * np.array([1.0, -1.0])
        best = _least(best, best.robot, legs, best.body, near, best.paid) or best
        step *= 0.5
    return best


def _nearest(robot: Robot, legs: LegModel, body: BodyScale, seed: float) -> str:
    short = replace(body, leg=_SHORTER[-1] * body.leg)
    found = []
    for height in seed + body.leg * np.arange(_HIGHEST, -_LOWEST, -2.0 * _LOWER):
        walk = straight_walk(_paced(robot, float(height), 1.0), short, float(height), _QUICK_STEPS)
        reach = plan_reach(robot, legs, walk)
        found.append((max(reach.missed, 0.1 * max(0.0, _SPARE - float(reach.spare.min()))), float(height), reach))
    _, height, reach = min(found, key=lambda f: f[0])
    j = int(reach.spare.argmin())
    if math.isfinite(reach.spare[j]) and reach.spare[j] < _SPARE:
        missing = math.degrees(_SPARE - float(reach.spare[j]))
        return f"a CoM at {height:.3f} m, where {robot.legs['left'].joints[j]} lacks {missing:.1f} degrees of range"
    if reach.knee < _LEAST_KNEE:
        return f"a CoM at {height:.3f} m, where a knee bends by {math.degrees(reach.knee):.0f} degrees; allowed: 10"
    return f"a CoM at {height:.3f} m, where the feet miss their places by {1e3 * reach.missed:.0f} mm or mrad"


def _rocking_share(robot: Robot, body: BodyScale, height: float) -> float:
    """Leg share that scales a rocking robot's steps, for h1's speed."""
    rocks = rocking(robot, height)
    return min(1.0, (rocks.single_support + rocks.double_support) / (_H1_STEP * body.beat))


def _pace(robot: Robot, legs: LegModel, body: BodyScale) -> float:
    """Least beats a pace that leave the motors a reserve, or the largest."""
    if robot.rocks:
        step = robot.single_support + robot.double_support
        return float(f"{step / ((QUICK_SINGLE + QUICK_DOUBLE) * body.beat):.3g}")
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    feet, plan = straight_plan(_QUICK_STEPS, length=QUICK_STEP * body.leg, width=robot.stance_width)
    for beats in _PACES:
        pace = beats * body.beat
        quick = replace(robot, single_support=QUICK_SINGLE * pace, double_support=QUICK_DOUBLE * pace)
        walk = Walk().for_body(body)
        timing = walk_timing(walk, quick, body)
        walked = Walked(feet, plan, timing, walk.swing_height, robot.com_height, robot.trunk_lean)
        asked = plan_reach(robot, legs, walked)
        fits = asked.shift <= _QUICK_SHIFT and asked.turn <= TURN
        if fits and not bool((asked.torque > QUICK_HELD * limits).any()):
            return beats
    return _PACES[-1]


def _approach_support(robot: Robot, legs: LegModel, body: BodyScale) -> float:
    """Least t_ss in s of a slow landing with a motor reserve; else 0."""
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
    pitching = pitching_joints(robot, "left", legs.model, stood(robot, legs.model))
    return [legs.model.joint(name).id for name in robot.legs["left"].joints].index(pitching[-1])


def _angles(robot: Robot, legs: LegModel, configuration: Array) -> dict[Side, tuple[float, ...]]:
    places = {s: [legs.model.joint(n).qposadr[0] for n in robot.legs[s].joints] for s in SIDES}
    return {s: tuple(float(configuration[i]) for i in places[s]) for s in SIDES}


def _crouch(robot: Robot, legs: LegModel, body: BodyScale, asked: float) -> float:
    """How much lower in m it can walk, at three quarters of torque."""
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    fits = 0.0
    for lower in _CROUCHES:
        found = plan_reach(robot, legs, straight_walk(robot, body, robot.com_height - lower * body.leg))
        enough = found.missed <= _MISSED_CROUCHING and (lower <= _LEAST_CROUCH or float(found.spare.min()) >= _SPARE)
        held = max(_CROUCHED if lower <= _LEAST_CROUCH else HELD, 1.02 * asked)
        if not enough or bool((found.torque > held * limits).any()):
            break
        fits = lower
    return math.floor(1e3 * fits * body.leg) / 1e3
