"""The posture that a fit begins with."""

import math
from dataclasses import replace

import pytest

from plantar.errors import RobotError
from plantar.robots import builtin_robots, load_robot
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.survey.first_posture import bent_posture, posture_height


@pytest.mark.parametrize("name", builtin_robots())
def test_knees_are_bent_and_soles_level(name):
    robot = load_robot(name)
    legs = build_leg_model(robot)
    bent = replace(robot, posture=bent_posture(robot, legs))
    assert max(bent.posture["left"]) == pytest.approx(math.radians(40.0))
    assert sum(bent.posture["left"]) == pytest.approx(0.0, abs=1e-9)
    straight = replace(robot, posture=dict.fromkeys(robot.posture, (0.0,) * 6))
    assert posture_height(bent, legs) < posture_height(straight, legs)


def test_knees_that_bend_backwards_are_refused():
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    knee = legs.model.joint("left_knee").id
    legs.model.jnt_range[knee] = -2.0, 0.1
    with pytest.raises(RobotError, match="knee 'left_knee', from -115 to 6 degrees, does not bend the shank back"):
        bent_posture(robot, legs)
