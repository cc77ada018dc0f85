"""Encoder offsets against drawn ones, on legs of six joints whose kinematics are written out here."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.common.sides import SIDES, Side
from plantar.gait.estimate.encoder_offsets import StandingTolerances, encoder_offsets, standing_base
from plantar.gait.estimate.estimator import Posture

TOLERANCES = StandingTolerances(offset=3e-3, place=6e-4, turn=1e-3)
HIPS: dict[Side, NDArray[np.float64]] = {"left": np.array([0.0, 0.08, -0.1]), "right": np.array([0.0, -0.08, -0.1])}
STANCE = np.radians([0.0, 0.0, -20.0, 40.0, -20.0, 0.0] * 2)
STEP = np.radians([3.0, 4.0, -35.0, 60.0, -25.0, -4.0, -2.0, 5.0, -5.0, 20.0, -15.0, -5.0])


def legs(joints: NDArray[np.float64]) -> Posture:
    """Kinematics of two legs: yaw, roll and pitch at the hip, knee, pitch and roll at the ankle."""
    positions: dict[Side, NDArray[np.float64]] = {}
    rotations: dict[Side, NDArray[np.float64]] = {}
    for side, q in zip(SIDES, (joints[:6], joints[6:]), strict=True):
        place, turned = HIPS[side], Rotation.identity()
        for axis, angle, link in zip("zxyyyx", q, (0.0, 0.0, 0.3, 0.3, 0.0, 0.12), strict=True):
            turned = turned * Rotation.from_euler(axis, angle)
            place = place + turned.apply([0.0, 0.0, -link])
        positions[side], rotations[side] = place, np.asarray(turned.as_matrix())
    return Posture(np.zeros(3), positions, rotations)


def stance(tilt: NDArray[np.float64]) -> tuple[NDArray[np.float64], dict[Side, tuple[float, float, float, float]]]:
    """Where the feet stand in the stance, and the direction of gravity in a base that leans."""
    posture = legs(STANCE)
    height = -posture.positions["left"][2]
    feet = {side: (float(p[0]), float(p[1]), float(p[2] + height), 0.0) for side, p in posture.positions.items()}
    return np.asarray(Rotation.from_rotvec(tilt).apply([0.0, 0.0, 1.0])), feet


def between(joints: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place (3,) and rotation (3, 3) of the right sole in the left one's frame."""
    posture = legs(joints)
    back = posture.rotations["left"].T
    return back @ (posture.positions["right"] - posture.positions["left"]), back @ posture.rotations["right"]


def errors(joints: NDArray[np.float64], wrong: NDArray[np.float64]) -> tuple[float, float]:
    """Errors in m and rad of one sole against the other, by joints that are read wrongly."""
    (place, turn), (seen, seen_turn) = between(joints), between(joints + wrong)
    return float(np.linalg.norm(seen - place)), float(Rotation.from_matrix(turn.T @ seen_turn).magnitude())


@pytest.mark.parametrize("seed", range(10))
def test_feet_are_where_they_are_again(seed):
    rng = np.random.default_rng(seed)
    true = np.radians(0.3) * rng.uniform(-1.0, 1.0, 12)
    up, feet = stance(np.array([*(5e-4 * rng.standard_normal(2)).tolist(), 0.0]))  # noise of the accelerometer's mean
    found = encoder_offsets(legs, STANCE + true, up, feet, TOLERANCES)
    for joints in (STANCE, STEP):  # found standing, they hold walking
        place, turn = errors(joints, true)
        place_left, turn_left = errors(joints, true - found)
        assert place_left < max(1.5e-3, 0.3 * place)
        assert turn_left < max(2.5e-3, 0.3 * turn)
    # Only how the base is over its feet stays unknown: no more than the offsets were.
    assert np.abs(true - found).max() < np.radians(0.3)


def test_finds_none_where_there_are_none():
    up, feet = stance(np.zeros(3))
    np.testing.assert_allclose(encoder_offsets(legs, STANCE, up, feet, TOLERANCES), 0.0, atol=1e-9)


def test_noise_is_not_taken_for_offsets():
    rng = np.random.default_rng(0)
    up, feet = stance(np.array([5e-4, -5e-4, 0.0]))
    found = encoder_offsets(legs, STANCE + 5e-6 * rng.standard_normal(12), up, feet, TOLERANCES)
    assert np.abs(found).max() < 6e-4  # what the accelerometer is off, and no more


def test_soles_that_lean_alike_are_seen_against_gravity():
    true = np.zeros(12)
    true[[4, 10]] = 4e-3  # both ankles' pitch: one sole against the other shows nothing of it
    up, feet = stance(np.zeros(3))
    found = encoder_offsets(legs, STANCE + true, up, feet, TOLERANCES)
    rotation, _ = standing_base(legs(STANCE + true - found), up, feet)
    for sole in legs(STANCE + true - found).rotations.values():
        assert np.abs((rotation @ sole)[2, :2]).max() < 1e-3
    assert np.abs(legs(STANCE + true).rotations["left"][2, :2]).max() > 3e-3


def test_the_base_stands_over_turned_feet():
    posture = legs(STANCE)
    for yaw in (0.3, 3.1, -3.1):
        turn = Rotation.from_euler("z", yaw)
        feet = {side: (*turn.apply(p).tolist(), yaw) for side, p in posture.positions.items()}
        rotation, position = standing_base(posture, np.array([0.0, 0.0, 1.0]), feet)
        np.testing.assert_allclose(rotation, turn.as_matrix(), atol=1e-12)
        np.testing.assert_allclose(position, 0.0, atol=1e-12)
