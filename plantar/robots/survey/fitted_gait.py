"""A walk that fits a robot: posture, stance, pace and gains."""

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES
from plantar.errors import RobotError
from plantar.gait.plan.footsteps import straight_plan
from plantar.robots.kinematics.body import body_of, pitching_joints, stood
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot import Robot
from plantar.robots.survey.first_posture import (
    bent_posture,
    knees_ahead,
    least_stance,
    posture_height,
    stance_width,
)
from plantar.robots.survey.plan_reach import PlanReach, Walked, missed_aside, plan_reach, settled
from plantar.robots.survey.servo_gains import CHATTERS, DAMPED, JointInertia, joint_inertia, servo_gains
from plantar.robots.survey.step_search import HELD, QUICK_STEPS, SPARE, TURN, best_steps, straight_walk
from plantar.robots.survey.step_time import ankle_reach, has_ankle_roll
from plantar.robots.survey.wishes import NO_WISHES, Wishes
from plantar.robots.walk import CONTROL_PERIOD, Walk, walk_timing

ROLL_MOST = math.radians(3.0)
"""Angle of a sole that carries alone against level ground up to which its taxels' soft pad lets it rest whole."""

# Phases in paces and length in legs of the steps that the built-in scenes ask for which walk at a velocity.
QUICK_SINGLE = 2.02
QUICK_DOUBLE = 0.404
QUICK_STEP = 0.15

# Height in legs and speed in legs a beat of the slow approach to the ground that the built-in scenes ask for.
APPROACH_HEIGHT = 0.025
APPROACH_SPEED = 0.0247

QUICK_HELD = 0.85
"""Share of the torque limits that quick steps may take: OP3's, whose knees took 1.6 of it, sat at a limit in a third of
all ticks and hit the ground with 6 body weights; at 0.85 of it that was 1 %."""

_OWN_STIFFNESS = 6.0  # over m g h, from which the model's own servos are kept: half of what h1 has
# of the leg: a step aside, as on the beam, and what a foot may be off after it
_ASIDE = 2 / 15
_OFF = 0.008
_NARROWER = 0.9  # of a stance, tried next
_TURNING = 5  # joints of a leg from which it turns its foot
_LEAST_CROUCH = 0.05  # of the leg: what scenes on unknown ground ask for
_MISSED_CROUCHING = 0.01  # m
# Share of its clearance that a swinging foot may stay below its path in a crouch, where an ankle at its limit holds it
# down: Fourier's N1 lost 0.6 of it and tripped over a slab of 24 mm, which it steps onto with 0.25
_LOW_CROUCHING = 1 / 3
_CROUCHED = 0.88  # of the torque limits, for that crouch
_CROUCHES = (0.02, 0.035, _LEAST_CROUCH, 0.1, 0.15, 0.2, 0.25)  # of the leg
_APPROACHES = (1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.75, 2.0)
_PACES = (1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.3, 2.6)
_QUIET = 0.19  # as `SHIFT`, that of h1, where a foot has to find the ground: five of twelve robots fell with 0.3
_QUICK_SHIFT = 0.33  # of quick steps, as `SHIFT`: those of h1 have 0.26

Array = NDArray[np.float64]


class FittedGait:
    """A robot with numbers that fit, and their reasons.

    `inertia`: about the joints of a leg; `reach`: demands of level steps of a third of a leg; `notes`: what was not met
    or was assumed; `rotors`: additional rotor inertia in kg m^2 about each leg joint of the model's copy; `known`: what
    was found for its legs, see `LegModel`.
    """

    def __init__(
        self,
        robot: Robot,
        body: BodyScale,
        inertia: JointInertia,
        reach: PlanReach,
        notes: list[str],
        rotors: Array,
        known: Mapping[tuple[Hashable, ...], Any],
    ) -> None:
        self.robot = robot
        self.body = body
        self.inertia = inertia
        self.reach = reach
        self.notes = tuple(notes)
        self.rotors = rotors
        self.known = known


def fit_gait(
    draft: Robot,
    gains: Sequence[tuple[float, float]] = (),
    rotors: Array | None = None,
    wishes: Wishes = NO_WISHES,
    known: Mapping[tuple[Hashable, ...], Any] = MappingProxyType({}),
) -> FittedGait:
    """Fit a walk to a robot of known names, soles and limits.

    `draft`: the robot; its posture, gait and gains are replaced; `gains`: the model's stiffness in N m/rad and damping
    in N m s/rad of each leg joint, or empty; `rotors`: assumed rotor inertia in kg m^2 about each leg joint, or None;
    `wishes`: their height and stance are taken as they are; `known`: of an earlier fit, whose legs differ in rotors
    alone: how they move does not depend on these.

    Knees bend the shank back. Where that leaves no steps, they bend it ahead, as a bird's do.
    """
    try:
        return _fit_gait(draft, gains, rotors, wishes, known, ahead=False)
    except RobotError as error:
        try:
            return _fit_gait(draft, gains, rotors, wishes, known, ahead=True)
        except RobotError:
            raise error from None


def _fit_gait(
    draft: Robot,
    gains: Sequence[tuple[float, float]],
    rotors: Array | None,
    wishes: Wishes,
    known: Mapping[tuple[Hashable, ...], Any],
    ahead: bool,
) -> FittedGait:
    legs = build_leg_model(draft)
    legs.known.update(known)
    robot = replace(draft, posture=bent_posture(draft, legs, ahead))
    body = body_of(robot, legs.model)
    notes: list[str] = []
    robot = replace(robot, stance_width=wishes.stance or stance_width(robot, legs))
    pitching = pitching_joints(robot, "left", legs.model, stood(robot, legs.model))
    ankle = [legs.model.joint(name).id for name in robot.legs["left"].joints].index(pitching[-1])
    bears = ankle_reach(robot, body.weight, ankle)
    if bears is not None:
        robot = replace(robot, ankle_reach=bears)
        notes += _weak_ankle(robot, body.weight, ankle)
    seed = posture_height(robot, legs)
    robot = robot if has_ankle_roll(robot, legs) else replace(robot, rocks=True)
    robot, body, reach = best_steps(robot, legs, body, seed, notes, wishes)
    height = robot.com_height
    narrower = robot if robot.rocks or wishes.stance else _narrowed(robot, legs, body)
    if narrower is not robot:
        robot = narrower
        reach = plan_reach(narrower, legs, straight_walk(narrower, body, height, QUICK_STEPS))
    if robot.rocks:
        notes.append(
            f"without ankle roll soles come off level by up to {math.degrees(reach.roll):.0f} degrees: the robot rocks "
            "from foot to foot in short quick steps, and cannot wait on one of them, so that it hits a slab that it "
            "does not know of (--trials flat,stone,push leaves that out; an ankle that rolls helps)"
        )
    if knees_ahead(robot, legs.model):
        notes.append(
            "the knees bend the shank ahead, as a bird's do: their limits, or the hips', leave no steps with knees "
            "that bend it back (where the robot's do, turn round the axes of the model's knees)"
        )
    if len(robot.posture["left"]) < _TURNING:
        notes.append("legs of four joints do not turn the feet: the robot walks straight ahead")
    settled(robot, legs, straight_plan(0, width=robot.stance_width)[0], height)
    configuration = legs.configuration
    robot = replace(robot, posture=dict(zip(SIDES, map(tuple, legs.joints.reshape(2, -1).tolist()), strict=True)))
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
        pace=pace,
        balance=_balance(body),
    )
    robot = replace(robot, approach_support=_approach_support(robot, legs, body, reach.shift))
    assumed = np.zeros(len(draft.legs["left"].joints)) if rotors is None else rotors
    light = [name for name, value in zip(draft.legs["left"].joints, assumed, strict=True) if value > 0.0]
    if light:
        notes.append(
            f"the model states no rotor inertia, and {', '.join(light)} would be too light for a stiff servo: up to "
            f"{assumed.max():.2g} kg m^2 is assumed as armature in model.xml, put the motors' there"
        )
    return FittedGait(robot, body, inertia, reach, notes, assumed, dict(legs.known))


def _weak_ankle(robot: Robot, weight: float, ankle: int) -> list[str]:
    """What ankles lack that do not bear the robot's weight in N over the soles' middles: a sole is loaded at half of
    what they reach. `ankle`: index of the pitching joint.
    """
    outline = robot.layouts["left"].outline
    middle = 0.5 * float(outline[:, 0].min() + outline[:, 0].max())
    if robot.ankle_reach >= middle:
        return []
    name = robot.legs["left"].joints[ankle]
    return [
        f"{name} bears the robot up to {1e3 * robot.ankle_reach:.0f} mm ahead of itself with "
        f"{robot.effort_limits[ankle]:.3g} N m, where the sole's middle is {1e3 * middle:.0f} mm ahead: a part of a "
        f"sole, or a push, may be beyond it; a motor of {math.ceil(2.0 * weight * middle)} N m loads the middle"
    ]


def _narrowed(robot: Robot, legs: LegModel, body: BodyScale) -> Robot:
    """The robot with feet so near that its ankles take a step aside, or as near as its soles may come."""
    aside = _ASIDE * body.leg
    most = _OFF * body.leg
    least = least_stance(robot) / _NARROWER
    while missed_aside(robot, legs, aside) > most and robot.stance_width >= least:
        robot = replace(robot, stance_width=round(_NARROWER * robot.stance_width, 3))
    return robot


def _gains(
    robot: Robot,
    inertia: JointInertia,
    legs: LegModel,
    body: BodyScale,
    gains: Sequence[tuple[float, float]],
    notes: list[str],
) -> tuple[Array, Array]:
    height = robot.com_height
    limits = robot.effort_limits
    stiffness, damping = servo_gains(inertia, legs.mass, height, body.beat, CONTROL_PERIOD, limits)
    if gains:
        own = _own_gains(inertia, gains)
        unit = body.weight * height
        works, _ = servo_gains(inertia, legs.mass, height, body.beat, CONTROL_PERIOD)
        fits = (own[0] <= 1.05 * works) | (CONTROL_PERIOD * np.sqrt(own[0] / inertia.swing) <= CHATTERS)
        fits &= own[1] + inertia.damping >= 2.0 * DAMPED * np.sqrt(own[0] * inertia.swing)
        kept = bool((fits & (own[0] >= _OWN_STIFFNESS * unit)).all())
        least = own[0].min()
        most = own[0].max()
        notes.append(
            f"the model's own servos have {least:.3g} to {most:.3g} N m/rad; "
            + (
                "they are kept"
                if kept
                else f"they are replaced, as position servos that hold the robot need {_OWN_STIFFNESS:g} m g h = "
                f"{_OWN_STIFFNESS * unit:.3g}, {DAMPED:g} of critical damping, and a swing of at most {CHATTERS:g} rad "
                "in a control period"
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


def _pace(robot: Robot, legs: LegModel, body: BodyScale) -> float:
    """Least beats a pace that leave the motors a reserve, or the largest."""
    if robot.rocks:
        step = robot.single_support + robot.double_support
        return float(f"{step / ((QUICK_SINGLE + QUICK_DOUBLE) * body.beat):.3g}")
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    feet, plan = straight_plan(QUICK_STEPS, length=QUICK_STEP * body.leg, width=robot.stance_width)
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


def _approach_support(robot: Robot, legs: LegModel, body: BodyScale, shift: float) -> float:
    """Least t_ss in s of a slow landing with a motor reserve and a quiet leg, whose `shift` is at t_ss now; else 0."""
    if robot.rocks:
        return 0.0
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    approach = (APPROACH_HEIGHT * body.leg, APPROACH_SPEED * body.leg / body.beat)
    height = robot.com_height - min(robot.largest_crouch, _LEAST_CROUCH * body.leg)
    for longer in _APPROACHES:
        slow = replace(robot, single_support=longer * robot.single_support)
        walk = straight_walk(slow, body, height, QUICK_STEPS)
        asked = plan_reach(slow, legs, replace(walk, approach_height=approach[0], approach_speed=approach[1]))
        if not bool((asked.torque > QUICK_HELD * limits).any()):
            break
    longer = max(longer, math.sqrt(shift / _QUIET))
    return round(longer * robot.single_support, 2) if longer > 1.0 else 0.0


def _crouch(robot: Robot, legs: LegModel, body: BodyScale, asked: float) -> float:
    """How much lower in m it can walk, at three quarters of torque."""
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    fits = 0.0
    for lower in _CROUCHES:
        walk = straight_walk(robot, body, robot.com_height - lower * body.leg)
        found = plan_reach(robot, legs, walk)
        enough = found.missed <= _MISSED_CROUCHING and found.low <= _LOW_CROUCHING * walk.swing_height
        enough = enough and float(found.spare.min()) >= SPARE
        held = max(_CROUCHED if lower <= _LEAST_CROUCH else HELD, 1.02 * asked)
        if not enough or bool((found.torque > held * limits).any()):
            break
        fits = lower
    return math.floor(1e3 * fits * body.leg) / 1e3
