"""What a robot is found to be in the opening stand: bounded, commanded gradually, and only what is asked for."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.estimate.estimator import FloatingBaseEstimator, Posture
from plantar.gait.estimate.identification import IdentificationRules
from plantar.gait.estimate.identified_body import IdentifiedBody
from plantar.mechanics.base_state import BaseState

PERIOD, WEIGHT, UP = 0.005, 800.0, np.array([0.0, 0.0, 9.81])
FEET: dict[Side, tuple[float, float, float, float]] = {"left": (0.0, 0.1, 0.0, 0.0), "right": (0.0, -0.1, 0.0, 0.0)}
RULES = IdentificationRules()


class Sliding:
    """Two legs whose two joints each move a sole forward by 1 m/rad and turn it about the vertical."""

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        positions: dict[Side, NDArray[np.float64]] = {}
        rotations: dict[Side, NDArray[np.float64]] = {}
        for i, side in enumerate(SIDES):
            slide, turn = joint_positions[2 * i : 2 * i + 2].tolist()
            positions[side] = np.array([slide, FEET[side][1], -0.8])
            c, s = np.cos(turn), np.sin(turn)
            rotations[side] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return Posture(np.zeros(3), positions, rotations)


def soles(weight: float = WEIGHT, x: float = 0.0, y: float = 0.0) -> dict[Side, SoleWrench]:
    """Soles that carry a weight at a point, shared by where it lies between them."""
    left = 0.5 + y / 0.2
    return {
        side: SoleWrench(share * weight * np.array([0.0, 0.0, 1.0, 0.0, -x, 0.0]))
        for side, share in (("left", left), ("right", 1.0 - left))
    }


def stood(rules: IdentificationRules, joints: NDArray[np.float64], carried: dict[Side, SoleWrench]) -> IdentifiedBody:
    body = IdentifiedBody(Sliding(), WEIGHT, FEET, rules, PERIOD)
    for _ in range(100):
        body.stand(joints, UP, carried)
    body.conclude()
    return body


def test_finds_offsets_mass_and_com_of_one_robot():
    wrong = np.array([0.004, 0.003, -0.004, -0.003])
    body = stood(RULES, wrong, soles(1.08 * WEIGHT, x=0.012, y=-0.015))
    np.testing.assert_allclose(body.encoder_offsets, wrong, atol=1e-3)  # the prior keeps a little of each
    np.testing.assert_allclose(body.com_offset, [0.012, -0.015, 0.0], atol=5e-4)
    assert body.mass_ratio == pytest.approx(1.08)
    posture = body.posture(wrong)
    np.testing.assert_allclose(posture.com, body.com_offset)
    assert abs(posture.positions["left"][0] - posture.positions["right"][0]) < 1.2e-3  # 8 mm by the encoders
    for joints in (wrong, 2.0 * wrong, wrong):
        posture, live = body.posture(joints), body.live_posture(joints)
        assert np.array_equal(live.com, posture.com)
        for side in SIDES:
            assert np.array_equal(live.positions[side], posture.positions[side])
            assert np.array_equal(live.rotations[side], posture.rotations[side])


def test_is_the_model_where_robot_and_model_agree():
    body = stood(RULES, np.zeros(4), soles())
    assert not body.encoder_offsets.any()
    np.testing.assert_allclose(body.com_offset, 0.0, atol=1e-12)
    assert body.lean == 0.0


def test_noise_changes_nothing():
    body = stood(RULES, np.array([5e-4, 0.0, -5e-4, 0.0]), soles(1.01 * WEIGHT, x=0.001, y=-0.001))
    for _ in range(100):
        body.advance()
    assert not body.encoder_offsets.any()
    assert not body.com_offset.any()
    assert body.lean == 0.0


def test_what_is_not_asked_for_stays_nominal():
    rules = replace(RULES, encoders=False, com=False, lean=0.0)
    body = stood(rules, np.array([0.004, 0.0, 0.0, 0.0]), soles(1.2 * WEIGHT, x=0.02))
    body.advance()
    assert not body.encoder_offsets.any()
    assert not body.com_offset.any()
    assert body.lean == 0.0


def test_is_bounded_whatever_is_measured():
    body = stood(RULES, np.array([1.0, 1.0, -1.0, -1.0]), soles(10.0 * WEIGHT, x=5.0))
    assert np.abs(body.encoder_offsets).max() <= RULES.encoder_largest + 1e-12
    assert np.linalg.norm(body.com_offset) <= RULES.com_largest + 1e-12
    assert body.mass_ratio == pytest.approx(1.4)


def test_is_nominal_without_a_stand_and_without_load():
    body = IdentifiedBody(Sliding(), WEIGHT, FEET, RULES, PERIOD)
    body.conclude()
    assert body.posture(np.zeros(4)).positions["left"].tolist() == [0.0, 0.1, -0.8]
    assert body.joint_offsets is None
    unloaded = stood(RULES, np.zeros(4), soles(0.0))
    assert not unloaded.com_offset.any()


def test_commands_follow_without_a_jump():
    body = stood(RULES, np.array([0.004, 0.003, -0.004, -0.003]), soles(1.05 * WEIGHT, y=0.015))
    before, leans = np.zeros(4), []
    for _ in range(round(RULES.fade / PERIOD) + 1):
        body.advance()
        now = body.joint_offsets
        assert np.abs(now - before).max() < 2.0 * PERIOD / RULES.fade * np.abs(body.encoder_offsets).max()
        before = now
        leans.append(body.lean)
    np.testing.assert_allclose(before, body.encoder_offsets)
    np.testing.assert_allclose(body.com_shift, body.com_offset)
    assert leans == sorted(leans)
    assert leans[-1] == pytest.approx(2.0 * RULES.lean)  # 15 mm of 100 mm, times 1.05: more than two tenths


def rested(speed, seconds):
    """Body that has stood, and stands on with its CoM moving at a `speed` in m/s, 10 mm behind the ZMP in its model."""
    body = stood(RULES, np.zeros(4), soles())
    nowhere = dict.fromkeys(SIDES, np.zeros(3))
    upright = dict.fromkeys(SIDES, np.eye(3))
    loads = dict.fromkeys(SIDES, 0.5 * WEIGHT)
    velocity = np.array([speed, 0.0, 0.0])
    for _ in range(round(seconds / PERIOD)):
        com = body.com_offset
        body.rest(BaseState(np.eye(3), np.zeros(3), com, velocity, np.array([0.01, 0.0]), loads, nowhere, upright))
    return body


def test_standing_still_brings_the_com_over_the_zmp():
    assert not rested(0.0, 0.9 * RULES.com_rest).com_offset.any()
    body = rested(0.0, RULES.com_rest + 12.0 * RULES.com_time)
    np.testing.assert_allclose(body.com_offset, [0.01, 0.0, 0.0], atol=5e-4)
    assert body.live_posture(np.zeros(4)).com[0] == pytest.approx(body.com_offset[0])


def test_a_body_that_moves_is_not_over_its_zmp():
    assert not rested(1.1 * RULES.com_still, 5.0).com_offset.any()


def test_an_estimator_stands_where_it_stood():
    wrong = np.array([0.004, 0.003, -0.004, -0.003])
    body = IdentifiedBody(Sliding(), WEIGHT, FEET, RULES, PERIOD)
    estimator = FloatingBaseEstimator(body, 3.5, PERIOD, FEET)
    for k in range(200):
        if k < 100:
            body.stand(wrong, UP, soles(x=0.01))
        elif k == 100:
            body.conclude()
            estimator.stand_again(wrong)
        state = estimator.update(wrong, np.zeros(3), UP, soles(x=0.01))
        limit = 1.2e-3 if k >= 100 else 5e-3  # half of 8 mm, and what the prior keeps of it
        for side in SIDES:
            assert abs(state.positions_sole[side][0]) < limit
    assert state.com[0] == pytest.approx(0.01, abs=1e-3)
    assert np.abs(state.com_velocity).max() < 1e-2
