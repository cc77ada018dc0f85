"""Encoders of a robot that leans, by the angles that were commanded."""

import numpy as np
import pytest

from plantar.gait.safety.bring_up.joint_checks import check_joints
from plantar.gait.safety.bring_up.motion import LEANED

PERIOD = 0.005
NAMES = ("left_hip", "left_knee", "right_hip", "right_knee")
REST = np.array([0.03, 0.5, 0.04, 0.6])  # rad


def leaned():
    """Commanded angles (n, 4) in rad at times (n,) in s."""
    time = PERIOD * np.arange(round(LEANED / PERIOD))
    lean = np.where(time > 0.5, np.sin(2.0 * np.pi * (time - 0.5) / 1.35), 0.0)
    return time, REST + np.outer(lean, [0.01, 0.02, -0.015, 0.012])


def causes(time, expected, measured):
    trace = {"time": time, "expected": expected, "joints": measured}
    return [finding.cause for finding in check_joints(trace, NAMES, 0)]


def test_encoders_that_follow_pass():
    time, expected = leaned()
    assert causes(time, expected, 1.02 * expected - 0.005) == []


@pytest.mark.parametrize("sway", [0.0, 0.5])
def test_a_small_angle_with_its_sign_turned_is_named_by_its_motion(sway):
    time, expected = leaned()
    moved = expected + np.outer(0.01 * sway * np.sin(2.0 * np.pi * time / 2.1 + 2.0), [1.0, -1.0, 1.0, -1.0])
    moved[:, 0] *= -1.0
    assert causes(time, expected, moved) == ["sign of the encoder of left_hip turned"]


@pytest.mark.parametrize("phase", np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False))
def test_a_joint_that_sways_by_more_than_it_is_commanded_shows_no_slope(phase):
    time, expected = leaned()
    moved = expected.copy()
    moved[:, 0] += 0.03 * np.sin(2.0 * np.pi * time / 2.1 + phase)
    assert causes(time, expected, moved) == []


def test_an_encoder_that_is_stuck_or_off_is_named():
    time, expected = leaned()
    stuck = expected.copy()
    stuck[:, 0] = REST[0]
    assert causes(time, expected, stuck) == ["encoder of left_hip stuck"]
    assert causes(time, expected, expected + np.array([0.0, 0.0, 0.0, 0.2])) == [
        "encoder of right_knee off by 0.20 rad"
    ]
