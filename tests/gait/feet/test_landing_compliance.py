import numpy as np
import pytest

from plantar.gait.feet.landing_compliance import LandingCompliance


def test_a_sole_on_its_toes_turns_its_heel_down():
    foot = LandingCompliance(0.005)
    foot.update(200.0, np.array([0.1, 0.0]), np.zeros(2))
    assert foot.turn[1] < 0.0  # about +y the toes go down
    assert foot.turn[0] == 0.0
    foot = LandingCompliance(0.005)
    foot.update(200.0, np.array([0.0, 0.05]), np.zeros(2))
    assert foot.turn[0] > 0.0  # about +x the left edge goes up
    assert foot.turn[1] == 0.0


def test_in_the_air_the_turn_ends_without_a_jump():
    foot = LandingCompliance(0.005)
    for _ in range(500):
        foot.update(300.0, np.array([0.3, 0.0]), np.zeros(2))
    before, most = foot.turn, foot.gains.largest_turn
    for _ in range(60):
        last = foot.turn
        foot.fade()
        assert np.hypot(*(foot.turn - last)) < 0.2 * most
    assert np.hypot(*foot.turn) < 1e-3 * np.hypot(*before)


def test_it_settles_on_an_elastic_ground_where_the_load_acts_in_the_middle():
    foot, stiffness, tilt = LandingCompliance(0.005), 4e3, 0.0015  # N m/rad of a sole that rolls on its edge
    for _ in range(200):
        moment = stiffness * (tilt + foot.turn[1])  # nose down: the load acts forward
        foot.update(200.0, np.array([moment / 200.0, 0.0]), np.zeros(2))
    assert tilt + foot.turn[1] == pytest.approx(0.0, abs=1e-5)


def test_turn_and_rate_are_limited_and_a_foot_that_carries_the_body_does_not_yield():
    foot = LandingCompliance(0.005)
    foot.update(300.0, np.array([0.3, 0.0]), np.zeros(2))
    assert abs(foot.turn[1]) <= foot.gains.largest_rate * foot.period + 1e-12
    for _ in range(500):
        foot.update(300.0, np.array([0.3, 0.1]), np.zeros(2))
    assert np.hypot(*foot.turn) == pytest.approx(foot.gains.largest_turn)
    held = foot.turn.copy()
    foot.update(800.0, np.array([-0.1, 0.0]), np.zeros(2))
    assert (foot.turn == held).all()
