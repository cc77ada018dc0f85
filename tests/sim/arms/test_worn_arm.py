"""The arm that h1 wears: the robot weighs what it did, in the same place, and its legs keep their coordinates."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.errors import RobotError, SceneError
from plantar.robots import load_robot
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot import Arms
from plantar.sim.arms.worn_arm import WornArm


@pytest.mark.parametrize("side", SIDES)
def test_mass_and_centre_stay_and_the_legs_keep_their_places(h1, side):
    worn = WornArm(h1, side)
    armed, welded = build_leg_model(h1, [worn]), build_leg_model(h1)
    armed.hold_others(worn.posture)
    assert armed.mass == pytest.approx(welded.mass, abs=1e-9)
    legs = np.array([*h1.posture["left"], *h1.posture["right"]]) + 0.1
    assert armed.posture(legs).com == pytest.approx(welded.posture(legs).com, abs=1e-9)
    for leg in SIDES:
        for joint in h1.legs[leg].joints:
            assert armed.model.joint(joint).qposadr[0] == welded.model.joint(joint).qposadr[0]
    assert armed.model.nv == welded.model.nv + 7


def test_the_centre_of_mass_goes_with_the_arm(h1):
    worn = WornArm(h1, "left")
    legs = build_leg_model(h1, [worn])
    standing = np.array([*h1.posture["left"], *h1.posture["right"]])
    places = []
    for posture in (worn.posture, np.radians([90.0, 0, 0, 0, 0, 0, 0])):
        legs.hold_others(posture)
        places.append(legs.posture(standing).com)
    arm = 5.4 / 86.0  # of the mass, whose centre comes forward by some 0.2 m
    assert 0.1 * arm < (places[1] - places[0])[0] < 0.3 * arm


def test_its_skin_is_that_of_the_machines_arm(h1):
    worn = WornArm(h1, "right")
    counts = {patch.name: len(patch) for patch in worn.skin.patches}
    assert counts == {"right_upper_arm": 100, "right_lower_arm": 80, "right_hand_palm": 14, "right_hand_back": 7}
    assert set(worn.skin.links) <= set(worn.links)
    link, middle, radius = worn.surface("right_lower_arm")
    assert link == "arm/right_lower_arm"
    assert radius == pytest.approx(0.045, abs=1e-3)
    assert middle == pytest.approx([0.0, 0.0, -0.12], abs=0.02)


def test_robots_without_such_an_arm_are_refused(h1):
    with pytest.raises(SceneError, match=r"robot 'hrp2kai' has no arm to move; allowed: robots with a table \[arms\]"):
        WornArm(load_robot("hrp2kai"), "left")
    with pytest.raises(SceneError, match=r"posture has 2 angles; allowed: 7, of left_shoulder_pitch, "):
        WornArm(h1, "left", [0.0, 10.0])
    with pytest.raises(SceneError, match=r"posture has left_elbow at 170 deg; allowed: 0 to 135"):
        WornArm(h1, "left", [0, 0, 0, 170, 0, 0, 0])
    with pytest.raises(SceneError, match=r"left_shoulder_roll at nan deg; allowed: -5 to 110"):
        WornArm(h1, "left", [0, float("nan"), 0, 0, 0, 0, 0])
    with pytest.raises(SceneError, match=r"\[arm\] posture"):
        WornArm(h1, "left", ["bent"])
    wrong = replace(h1, arms=Arms("h1-body", h1.arms.chest, {"left": "tail", "right": "tail"}))
    with pytest.raises(RobotError, match="left is 'tail'; machine 'h1-body' has no such link"):
        WornArm(wrong, "left")
    chestless = WornArm(replace(h1, arms=Arms("h1-body", "trunk", h1.arms.roots)), "left")
    with pytest.raises(RobotError, match="chest is 'trunk', which the robot's model does not have"):
        build_leg_model(h1, [chestless])
