"""Legs without ankle roll: how quickly they step, and where weak ankles let a sole be loaded."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES
from plantar.robots import builtin_robots, load_robot
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.survey.step_time import (
    LEAN_MOST,
    ankle_reach,
    has_ankle_roll,
    rocking,
)


@pytest.mark.parametrize(("height", "width"), [(0.97, 0.41), (0.97, 0.55), (0.6, 0.15)])
def test_a_pendulum_that_is_carried_by_turns_stays_as_near_the_middle_as_it_shall(height, width):
    robot = rocking(replace(load_robot("h1"), stance_width=width), height)
    assert robot.rocks
    step = robot.single_support + robot.double_support
    outer = float(robot.layouts["left"].outline[:, 1].max())
    carries = float(robot.middle_of_sole("left")[1])
    assert 0.7 * outer < carries < outer
    assert robot.middle_of_sole("right")[1] == pytest.approx(-carries)
    omega, foot = math.sqrt(GRAVITY / height), 0.5 * width + carries
    # Integrated from the middle, with the speed from which it is there again after a step.
    y, speed, most = 0.0, foot * omega * math.tanh(0.5 * omega * step), 0.0
    dt = step / 20000
    for _ in range(20000):
        speed += omega**2 * (y - foot) * dt
        y += speed * dt
        most = max(most, y)
    assert y == pytest.approx(0.0, abs=1e-3 * foot)
    share, lean = most / foot, math.atan(most / height)
    assert share <= 0.205
    assert lean <= 1.05 * LEAN_MOST
    assert share >= 0.19 or lean >= 0.95 * LEAN_MOST


@pytest.mark.parametrize("name", builtin_robots())
def test_the_built_in_robots_have_ankles_that_roll(name):
    robot = load_robot(name)
    legs = build_leg_model(robot)
    assert has_ankle_roll(robot, legs)
    names = {s: replace(robot.legs[s], joints=robot.legs[s].joints[:5]) for s in SIDES}
    posture = {s: robot.posture[s][:5] for s in SIDES}
    assert not has_ankle_roll(replace(robot, legs=names, posture=posture), legs)


def test_weak_ankles_bear_the_robot_as_far_as_their_torque_goes():
    robot = load_robot("h1")
    weight = 800.0
    limits = np.full(6, 1000.0)
    assert ankle_reach(robot, weight, 4) is None
    assert ankle_reach(replace(robot, effort_limits=tuple(limits)), weight, 4) is None
    limits[4] = 0.05 * weight
    assert ankle_reach(replace(robot, effort_limits=tuple(limits)), weight, 4) == pytest.approx(0.05, abs=1e-4)


def test_two_rolling_joints_of_the_hip_are_no_ankle(monkeypatch):
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    names = robot.legs["left"].joints
    ids = [int(legs.model.joint(name).id) for name in names]
    assert has_ankle_roll(robot, legs)
    monkeypatch.setattr("plantar.robots.survey.step_time.rolling_joints", lambda *_: ids[:2])
    assert not has_ankle_roll(robot, legs)
