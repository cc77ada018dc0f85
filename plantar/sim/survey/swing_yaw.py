"""How long a step takes whose swinging leg does not turn the standing sole on the ground.

A leg thrown forward pushes the robot back about the vertical through the standing sole; friction has to hold that.
Unitree's G1, whose legs are a fifth of its mass each, turns its sole by one or two degrees a step where the leg takes a
sixth of friction, and by seven once it has stepped down.
"""

from __future__ import annotations

import math

import numpy as np

from plantar.gravity import GRAVITY
from plantar.robots.kinematics.body import hanging_on, stood
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot
from plantar.settings.body_scale import BodyScale

__all__ = ["least_single_support", "swinging_mass"]

_HELD = 0.12
"""Share of what friction holds that a swinging leg may take: h1 has 0.05, JVRC-1 0.10, and G1 slips with 0.17."""
_FRICTION = 0.8
"""Of the built-in scenes."""
_ARM = 0.26
"""Mean distance of a rectangle's points from its middle, over its diagonal: 0.25 of a line, 0.27 of a square."""
_PEAK = 10.0 / math.sqrt(3.0)
"""Largest acceleration of a minimum-jerk path, in its length over its time squared."""


def swinging_mass(robot: Robot, legs: LegModel) -> float:
    """Returns the mass in kg of `legs` of a `robot` that goes forward as the foot: each part by how far below the hip
    it is.
    """
    model, data = legs.model, stood(robot, legs.model)
    hip = int(model.joint(robot.legs["left"].joints[0]).bodyid[0])
    parts = hanging_on(model, hip)
    top, sole = data.xpos[hip, 2], data.site_xpos[model.site(robot.legs["left"].sole_site).id, 2]
    share = np.clip((top - data.xipos[parts, 2]) / (top - sole), 0.0, 1.0)
    return float(share @ model.body_mass[parts])


def least_single_support(robot: Robot, legs: LegModel, body: BodyScale, step: float) -> float:
    """The least t_ss in s, in hundredths, at which friction holds the standing sole with plenty to spare.

    Returns it from:

    Args:
        robot: The robot, with its stance and layouts.
        legs: Its kinematics.
        body: Its mass and leg.
        step: Length of a step in m; the foot goes twice as far.
    """
    length, width = np.ptp(robot.layouts["left"].outline, axis=0)
    holds = _FRICTION * body.mass * GRAVITY * _ARM * math.hypot(length, width)
    takes = swinging_mass(robot, legs) * robot.stance_width * _PEAK * 2.0 * step  # over t_ss squared
    return math.ceil(100.0 * math.sqrt(takes / (_HELD * holds))) / 100.0
