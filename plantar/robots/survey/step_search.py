"""Search for the steps that a robot takes best: height, length, pace, stance and lean."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.settings.body_scale import BodyScale
from plantar.errors import RobotError
from plantar.gait.plan.footsteps import straight_plan
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot
from plantar.robots.survey.first_posture import least_stance
from plantar.robots.survey.plan_reach import PlanReach, Walked, plan_reach, speed_shares
from plantar.robots.survey.step_time import rocking
from plantar.robots.survey.wishes import NO_WISHES, Wishes
from plantar.robots.walk import Walk, walk_timing

KNEE_LEAST = math.radians(20.0)
"""Bend of the straightest knee over a walk of level steps: h1 walks with 14, hrp2kai with 24 degrees."""

STEP_SHARE = 1.0 / 3.0
"""Length of a step over that of a leg: 0.20 m for the robot h1."""

MISSED = 2e-3
"""How far in m or rad a solution for the legs may miss: half of what a control period moves."""

HELD = 0.75
"""Share of the torque limits that a planned walk may take; the rest is to balance with."""

# Shares of the way to the sole's edge by which a swinging leg may move the ZMP, and of friction's moment by which it
# may turn the sole: h1 has 0.19 and 0.08. The plan makes way for the leg, so that 0.4 is walked, too; slower steps are
# no safer, as what balance misses on a part of a sole grows as long as the step lasts.
SHIFT = 0.3
TURN = 0.15

SPARE = math.radians(1.0)
"""Angle of a joint's range that a walk leaves unused."""

QUICK_STEPS = 4
"""Steps that are looked at: two of each foot."""

_FULL = 0.95  # of the torque limits: no knee bends for more
# of knees, and share of the torque limits from which they are
_MORE_BENT = math.radians(10.0)
_STRONG = 0.6
_WIDE = 0.33  # of the leg: distance of the feet above which a narrower stance is tried, too; h1 has 0.28
# t_ss and t_ds of h1 over sqrt(h / g) of its height
_SINGLE = 3.15
_DOUBLE = 1.05
_H1_STEP = 4.85  # beats of a step of h1
_LEAN = 0.48  # rad of trunk lean per leg length of lateral motion, as h1
_SHORTER = (1.0, 0.85, 0.7, 0.55, 0.4)
_OTHER_PACES = (0.8, 1.25, 0.64, 1.6)
_TRIED_LEANS = (1.0, 1.6, 2.4)
_TRIED_STANCES = (0.3, 0.24)  # of the leg
# of the leg, above and below the posture with knees of 40 degrees
_HIGHEST = 0.15
_LOWEST = 0.45
_LOWER = 0.04
_WORSE = 3  # heights in a row that cost more, below which no others are looked at
_LEAST_KNEE = math.radians(10.0)
# Cost of a walk from which no other one is looked for: level steps at h1's pace with 75 % of the torque have 0.15
_GOOD = 0.3
# Cost of steps half as long, or of twice or half the pace; of each further lean, and stance
_OTHER_SPEED = 0.6
_OTHER_LEAN = 0.1
_OTHER_STANCE = 0.15

Array = NDArray[np.float64]


def straight_walk(robot: Robot, body: BodyScale, com_height: float, steps: int = 6) -> Walked:
    """Returns level steps of a third of a leg at a `robot`'s pace. `com_height` in m."""
    feet, plan = straight_plan(steps, length=STEP_SHARE * body.leg, width=robot.stance_width)
    walk = Walk().for_body(body)
    return Walked(feet, plan, walk_timing(walk, robot, body), walk.swing_height, com_height, robot.trunk_lean)


@dataclass(frozen=True)
class _Tried:
    cost: float
    paid: float
    robot: Robot
    body: BodyScale
    reach: PlanReach


def best_steps(
    robot: Robot, legs: LegModel, body: BodyScale, seed: float, notes: list[str], wishes: Wishes = NO_WISHES
) -> tuple[Robot, BodyScale, PlanReach]:
    """Returns the `robot` with the best height, pace, stance and lean, the `body` of its steps, and their demands.

    `seed`: height in m of its CoM in that posture; `notes`: what was not met is added; `wishes`: their height,
    stance and leg are the only ones looked at.
    """
    best: _Tried | None = None
    heights = seed + body.leg * np.arange(_HIGHEST, -_LOWEST, -_LOWER)
    if wishes.height is not None:
        heights = np.array([wishes.height])
    rocks = rocking(robot, float(heights[0]) if len(heights) == 1 else seed)
    quick = (rocks.single_support + rocks.double_support) / (_H1_STEP * body.beat)  # of the leg, for h1's speed
    shares = _SHORTER if wishes.leg is None else (min(1.0, wishes.leg / body.leg),)
    for share in (min(1.0, quick),) if robot.rocks else shares:
        shorter = replace(body, leg=math.floor(1e4 * share * body.leg) / 1e4 if share < 1.0 else body.leg)
        paid = 0.0 if robot.rocks or len(shares) == 1 else _OTHER_SPEED * -math.log2(share)
        for other, changed in _others(robot, body, wishes.stance is not None):
            if best is None or paid + changed < best.cost > _GOOD:
                best = _least(best, other, legs, shorter, heights, paid + changed)
        if best is not None and best.body.leg == shorter.leg:
            best = _refined(best if robot.rocks else _other_paces(best, legs, heights), legs, heights)
    if best is None:
        how = "without ankle roll it rocks from foot to foot with a level sole, and " if robot.rocks else ""
        raise RobotError(
            f"robot '{robot.name}': {how}no height of its CoM, pace or stance lets it take steps of "
            f"{share * STEP_SHARE * body.leg:.3f} m within its joints' limits; nearest is "
            f"{_nearest(robot, legs, body, heights)}"
        )
    best = best if robot.rocks else _slowed(best, legs, heights)
    if best.body.leg < body.leg:
        why = "quick steps are short" if robot.rocks else "joints or motors leave no steps of a third of the leg"
        why = why if wishes.leg is None or robot.rocks else "shorter steps are taken"
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
    """The same steps, slower for joints near their speed limits and legs that rock or turn the robot as they swing."""
    quick = float(speed_shares(found.robot, found.reach).max())
    longer = max(quick, math.sqrt(max(found.reach.shift / SHIFT, found.reach.turn / TURN)))
    if longer <= 1.0:
        return found
    slower = replace(found.robot, pace=longer * found.robot.pace)
    best = _least(None, slower, legs, found.body, heights, found.paid)
    return found if best is None else _refined(best, legs, heights)


def _others(robot: Robot, body: BodyScale, stated: bool) -> list[tuple[Robot, float]]:
    widths = [robot.stance_width]
    # Nearer feet lean legs without ankle roll, and so their soles, as they stand.
    if robot.stance_width > _WIDE * body.leg and not stated and not robot.rocks:
        widths += [round(max(least_stance(robot), share * body.leg), 3) for share in _TRIED_STANCES]
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
    own = math.inf
    worse = 0
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
    walk = straight_walk(robot, body, robot.com_height, QUICK_STEPS)
    reach = plan_reach(robot, legs, walk, _bears)
    if not _bears(reach.missed, reach.knee, reach.spare):
        return None
    limits = np.array(robot.effort_limits) if robot.effort_limits else np.inf
    asked = float(np.maximum(reach.carrying / limits, HELD * reach.torque / limits).max())
    # A robot that cannot crouch needs bent knees as it is: those that are almost straight throw the leg as it lands.
    more = 1.0 if robot.rocks else min(1.0, max(0.0, (asked - _STRONG) / (HELD - _STRONG)))
    least = KNEE_LEAST + more * _MORE_BENT
    straight = max(0.0, least - reach.knee)
    bent = max(0.0, reach.knee - least)
    over = 4.0 * max(0.0, asked - HELD) + 20.0 * max(0.0, asked - _FULL)
    cost = paid + 0.2 * asked + over + 6.0 * straight + 0.5 * bent + 0.2 * reach.low / walk.swing_height
    return _Tried(cost, paid, robot, body, reach)


def _bears(missed: float, knee: float, spare: Array) -> bool:
    return missed <= MISSED and knee >= _LEAST_KNEE and float(spare.min()) >= SPARE


def _refined(best: _Tried, legs: LegModel, heights: Array) -> _Tried:
    if len(heights) == 1:  # it was stated
        return best
    step = 0.5 * _LOWER * best.body.leg
    while step > 2e-3 * best.body.leg:
        near = best.robot.com_height + step * np.array([1.0, -1.0])
        best = _least(best, best.robot, legs, best.body, near, best.paid) or best
        step *= 0.5
    return best


def _nearest(robot: Robot, legs: LegModel, body: BodyScale, heights: Array) -> str:
    short = replace(body, leg=_SHORTER[-1] * body.leg)
    found = []
    for height in heights[::2]:
        walk = straight_walk(_paced(robot, float(height), 1.0), short, float(height), QUICK_STEPS)
        reach = plan_reach(robot, legs, walk)
        found.append((max(reach.missed, 0.1 * max(0.0, SPARE - float(reach.spare.min()))), float(height), reach))
    _, height, reach = min(found, key=lambda f: f[0])
    j = int(reach.spare.argmin())
    if math.isfinite(reach.spare[j]) and reach.spare[j] < SPARE:
        missing = math.degrees(SPARE - float(reach.spare[j]))
        return f"a CoM at {height:.3f} m, where {robot.legs['left'].joints[j]} lacks {missing:.1f} degrees of range"
    if reach.knee < _LEAST_KNEE:
        return f"a CoM at {height:.3f} m, where a knee bends by {math.degrees(reach.knee):.0f} degrees; allowed: 10"
    return f"a CoM at {height:.3f} m, where the feet miss their places by {1e3 * reach.missed:.0f} mm or mrad"


def _paced(robot: Robot, height: float, slower: float) -> Robot:
    if robot.rocks:
        return rocking(robot, height)
    unit = slower * math.sqrt(height / GRAVITY)
    return replace(
        robot, single_support=max(0.2, round(_SINGLE * unit, 2)), double_support=max(0.05, round(_DOUBLE * unit, 2))
    )
