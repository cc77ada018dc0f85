"""A sole against the other one: signs, the zero of the opening stand, and that a turn by it comes to rest level."""

import numpy as np
import pytest

from plantar.common.sides import Side
from plantar.gait.estimate.sole_slope import SoleSlope
from plantar.gait.feet.landing_compliance import DampingGains, LandingCompliance
from plantar.mechanics.rotation import rotation_from_vector

BOTH = {"left": 400.0, "right": 400.0}


def turned(x: float, y: float, yaw: float = 0.0) -> np.ndarray:
    return rotation_from_vector(np.array([0.0, 0.0, yaw])) @ rotation_from_vector(np.array([x, y, 0.0]))


def slope_of(side: Side, rotations: dict[str, np.ndarray]) -> np.ndarray:
    slope = SoleSlope(50.0)
    slope.update(rotations, BOTH)
    return slope.slope(side)


def test_a_sole_that_is_turned_nose_down_falls_along_x():
    for side in ("left", "right"):
        soles = {"left": np.eye(3), "right": np.eye(3)} | {side: turned(0.0, 0.003)}
        assert slope_of(side, soles) == pytest.approx([-0.003, 0.0], abs=1e-5)


def test_attitude_of_the_whole_robot_does_not_matter():
    """An error of the estimated attitude turns both soles."""
    lean = turned(0.02, -0.01, 0.4)
    level = {"left": turned(0.001, 0.003), "right": turned(-0.002, 0.001)}
    both = {side: lean @ rotation for side, rotation in level.items()}
    assert slope_of("left", both) == pytest.approx(slope_of("left", level), abs=1e-9)


@pytest.mark.parametrize("side", ["left", "right"])
def test_what_the_opening_stand_shows_is_level(side):
    standing = {"left": turned(0.002, -0.001, 0.2), "right": turned(0.05, 0.0, -0.2)}
    slope = SoleSlope(50.0)
    for _ in range(5):
        slope.update(standing, BOTH, standing=True)
    assert slope.slope(side) == pytest.approx([0.0, 0.0], abs=1e-5)
    slope.update({**standing, side: standing[side] @ turned(0.0, 0.003)}, BOTH)
    assert slope.slope(side) == pytest.approx([-0.003, 0.0], abs=1e-5)


def test_a_foot_in_the_air_says_nothing_of_the_ground():
    """Then the attitude tells how the other one has turned since."""
    slope = SoleSlope(50.0)
    slope.update({"left": turned(0.0, 0.001), "right": np.eye(3)}, BOTH)
    slope.update({"left": turned(0.0, 0.002), "right": turned(0.0, -0.05)}, {"left": 800.0, "right": 0.0})
    assert slope.slope("left") == pytest.approx([-0.002, 0.0], abs=1e-5)


def test_a_foot_comes_to_rest_parallel_to_the_other():
    foot, slope = LandingCompliance(0.005), SoleSlope(50.0)
    off = turned(0.002, -0.0025)
    for _ in range(100):
        slope.update({"left": off @ rotation_from_vector(np.array([*foot.turn, 0.0])), "right": np.eye(3)}, BOTH)
        foot.level(0.0, slope.slope("left"), 40.0)
    assert slope.slope("left") == pytest.approx([0.0, 0.0], abs=1e-5)
    assert np.hypot(*foot.turn) == pytest.approx(np.hypot(0.002, 0.0025), rel=0.01)


def test_a_foot_that_carries_the_body_is_not_turned():
    foot = LandingCompliance(0.005)
    foot.level(1.01 * DampingGains().largest_force, np.array([0.0, 0.01]), 40.0)
    assert not foot.turn.any()
    foot.level(0.99 * DampingGains().largest_force, np.array([0.0, 0.01]), 40.0)
    assert foot.turn[0] < 0.0
    assert foot.turn[1] == 0.0
