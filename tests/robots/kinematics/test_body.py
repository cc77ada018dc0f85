"""How large a robot is: its leg's length from its model, whatever the posture."""

import math
from dataclasses import replace

import pytest

from plantar.common.sides import SIDES
from plantar.robots import builtin_robots, load_robot
from plantar.robots.kinematics.body import body_of, leg_length
from plantar.robots.kinematics.robot_model import build_leg_model


@pytest.mark.parametrize("name", builtin_robots())
def test_a_leg_is_as_long_as_thigh_and_shank(name):
    robot = load_robot(name)
    model = build_leg_model(robot).model
    assert leg_length(robot, model) == pytest.approx(robot.biped.thigh_length + robot.biped.shank_length, abs=1e-6)
    body = body_of(robot, model)
    assert body.mass == pytest.approx(robot.biped.total_mass)
    outline = robot.layouts["left"].outline
    assert (body.sole, body.sole_width) == pytest.approx(tuple(outline.max(axis=0) - outline.min(axis=0)))


def test_the_posture_does_not_change_it():
    robot = load_robot("h1")
    model = build_leg_model(robot).model
    straight = replace(robot, posture=dict.fromkeys(SIDES, (0.0,) * 6))
    turned = replace(robot, posture=dict.fromkeys(SIDES, (0.3, 0.1, -0.9, math.pi / 2, -0.4, 0.0)))
    assert leg_length(straight, model) == leg_length(robot, model)
    assert leg_length(turned, model) == pytest.approx(leg_length(robot, model), abs=1e-6)


def test_the_file_may_say_it():
    robot = replace(load_robot("h1"), leg_length=0.55)
    assert body_of(robot, build_leg_model(robot).model).leg == 0.55
