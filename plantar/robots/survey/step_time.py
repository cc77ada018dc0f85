"""Step time of a robot without ankle roll, and how far weak ankles bear it.

Without ankle roll a sole is level only under a vertical leg. A pendulum of height h over a foot p aside swings there
and back in a time T, and leans by atan(y / h), with

    y = p (1 - 1 / cosh(w T / 2)),    w = sqrt(g / h)

(Kajita et al., "The 3D linear inverted pendulum mode", IROS 2001). Quick steps keep that small.
"""

import math
from dataclasses import replace

from plantar.common.gravity import GRAVITY
from plantar.common.sides import Side
from plantar.robots.kinematics.body import pitching_joints, rolling_joints, stood
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot

LEAN_MOST = math.radians(2.5)
"""Lean of a leg in the orbit. What a sole that stands flat does not lean, the body does."""

# Share of the way to a foot's load that the CoM sways at most: of three drawn bipeds whose soles' edges are half as far
# out as their middles none walked at a third of the way to the middles, and all at a fifth
_NEAR = 0.2

_SINGLE = 0.62  # of the time of a step; with more, feet that land on an edge have no time to come down flat
_SHORTEST = 0.2  # s: the least that the timing of a walk allows


def has_ankle_roll(robot: Robot, legs: LegModel, side: Side = "left") -> bool:
    """Returns whether a `robot`'s leg of a `side` of `legs` has a joint below its knee that rolls the sole.

    The knee is the last pitching joint but one; where ankle and hip alone pitch, any joint below the hip counts.
    """
    data = stood(robot, legs.model)
    order = [int(legs.model.joint(name).id) for name in robot.legs[side].joints]
    pitching = pitching_joints(robot, side, legs.model, data)
    rolling = rolling_joints(robot, side, legs.model, data)
    knee = order.index(pitching[-2]) if len(pitching) > 1 else 0
    return any(order.index(joint) > knee for joint in rolling)


def rocking(robot: Robot, com_height: float) -> Robot:
    """Returns the `robot`, CoM at `com_height` in m, with a step time of little leg lean."""
    beat = math.sqrt(com_height / GRAVITY)
    robot = replace(robot, rocks=True)
    aside = 0.5 * robot.stance_width + float(robot.middle_of_sole("left")[1])
    near = min(_NEAR, com_height * math.tan(LEAN_MOST) / aside)
    step = 2.0 * beat * math.acosh(1.0 / (1.0 - near))
    single = max(_SHORTEST, round(_SINGLE * step, 3))
    return replace(robot, single_support=single, double_support=round((1.0 - _SINGLE) / _SINGLE * single, 3))


def ankle_reach(robot: Robot, weight: float, ankle: int) -> float | None:
    """Returns how far along the sole in m joint `ankle` of a `robot` bears its `weight` in N; None: to the toes."""
    if not robot.effort_limits:
        return None
    toe = float(robot.layouts["left"].outline[:, 0].max())
    reach = robot.effort_limits[ankle] / weight
    return None if reach >= toe else math.floor(1e4 * reach) / 1e4
