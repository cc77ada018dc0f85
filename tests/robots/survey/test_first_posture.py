"""The posture that a fit begins with."""

import math
from dataclasses import replace
from types import SimpleNamespace

import mujoco
import pytest

from plantar.errors import RobotError
from plantar.robots import builtin_robots, load_robot
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.survey.first_posture import bent_posture, knees_ahead, posture_height

BALL = '<geom type="sphere" size="0.02"/>'


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


def test_knees_bend_ahead_as_a_bird_s_where_that_is_asked_for():
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    assert not knees_ahead(robot, legs.model)
    for side in ("left", "right"):
        legs.model.jnt_range[legs.model.joint(f"{side}_knee").id] = -2.0, 0.1
    bird = replace(robot, posture=bent_posture(robot, legs, ahead=True))
    assert min(bird.posture["left"]) == pytest.approx(math.radians(-40.0))
    assert sum(bird.posture["left"]) == pytest.approx(0.0, abs=1e-9)
    assert knees_ahead(bird, legs.model)


def test_knees_of_two_joints_bend_alike():
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><body name="trunk"><freejoint/>{BALL}{rolling_leg("l")}{rolling_leg("r")}'
        "</body></worldbody></mujoco>"
    )
    names = {side: SimpleNamespace(joints=[f"{side[0]}{k}" for k in range(4)]) for side in ("left", "right")}
    robot = SimpleNamespace(name="rolling knees", torso_body="trunk", legs=names)
    bent = bent_posture(robot, SimpleNamespace(model=model))
    assert [math.degrees(angle) for angle in bent["left"]] == pytest.approx([20.0, 20.0, 20.0, -20.0])


def rolling_leg(name: str) -> str:
    """MJCF of a leg: hip, a knee of two joints, and ankle, the hip's axis turned round."""
    links = ((0, -1, 0.0), (1, 1, 0.3), (2, 1, 0.1), (3, 1, 0.3))
    bodies = [f'<body pos="0 0 -{z}"><joint name="{name}{k}" axis="0 {y} 0"/>{BALL}' for k, y, z in links]
    return "".join(bodies) + 4 * "</body>"
