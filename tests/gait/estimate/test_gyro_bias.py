"""The gyro's bias against drawn ones, on legs that move over feet that stand, with the noise of gyro and encoders."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.common.sides import Side
from plantar.gait.estimate.gyro_bias import GyroBias
from plantar.mechanics.rotation import sine_vector

PERIOD, LARGEST = 0.005, 0.05
BOTH: dict[Side, float] = {"left": 400.0, "right": 300.0}


def advance(identified, gyro, turn, weights=BOTH):
    """A tick of gyro, and of how far the base turned by its still feet, or None."""
    still = turn is not None
    identified.kernel.update(
        *gyro.tolist(), still, *(turn if still else np.zeros(3)).tolist(), min(weights.values()) > 0.0
    )


def sway(time: float) -> NDArray[np.float64]:
    """Rotation of the base to the world, at times up to 3 degrees from upright."""
    return np.asarray(Rotation.from_euler("xyz", 0.05 * np.sin([1.3 * time, 2.0 * time, 0.7 * time])).as_matrix())


def turned(before, now, weights):
    """By how much soles that stand say the base has turned, weighted; None where none stands."""
    standing = [side for side, weight in weights.items() if weight > 0.0]
    if not standing:
        return None
    each = [sine_vector(before[side] @ now[side].T) for side in standing]
    return np.asarray(np.average(each, axis=0, weights=[weights[side] for side in standing]))


def found(bias, duration=3.0, seed=0, weights=BOTH, turning=None):
    """What is identified of a bias by a base that sways over its feet; a rate `turning` turns the right sole."""
    rng = np.random.default_rng(seed)
    identified = GyroBias(PERIOD, 20.0, LARGEST, 0.25, 6e-4)

    def soles(time: float) -> dict[Side, NDArray[np.float64]]:
        slid = np.zeros(3) if turning is None else turning * time
        noise = Rotation.from_rotvec(1e-4 * rng.standard_normal((2, 3))).as_matrix()  # of six encoders of 5e-5 rad
        base = sway(time).T
        return {"left": noise[0] @ base, "right": noise[1] @ base @ Rotation.from_rotvec(slid).as_matrix()}

    before = soles(0.0)
    for k in range(1, round(duration / PERIOD) + 1):
        a, b = sway((k - 1) * PERIOD), sway(k * PERIOD)
        rate = Rotation.from_matrix(a.T @ b).as_rotvec() / PERIOD
        now = soles(k * PERIOD)
        advance(identified, rate + bias + 2e-3 * rng.standard_normal(3), turned(before, now, weights), weights)
        before = now
    return identified.value


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", range(10))
def test_recovers_a_bias_while_the_body_sways(seed):
    bias = np.random.default_rng([seed, 1]).uniform(-0.01, 0.01, 3)
    # The gyro's noise over 600 ticks has a standard deviation of 2e-3 / sqrt(600) = 8e-5 rad/s, the encoders' of 5e-5.
    np.testing.assert_allclose(found(bias, seed=seed), bias, atol=4e-4)


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(5))
def test_is_none_without_a_bias(seed):
    assert np.abs(found(np.zeros(3), seed=seed)).max() < 4e-4


def test_a_foot_that_does_not_carry_may_turn():
    bias = np.array([0.004, -0.005, 0.003])
    swinging = np.array([0.0, 0.5, 0.2])
    np.testing.assert_allclose(found(bias, weights={"left": 700.0, "right": 0.0}, turning=swinging), bias, atol=4e-4)
    assert np.abs(found(bias, turning=swinging) - bias).max() > 0.01  # the test can tell


def test_holds_on_in_the_air_and_is_bounded():
    assert not found(np.ones(3), weights={"left": 0.0, "right": 0.0}).any()
    assert np.abs(found(np.array([1.0, -1.0, 1.0]))).max() == pytest.approx(LARGEST)


def test_follows_a_bias_that_drifts():
    identified = GyroBias(PERIOD, 2.0, LARGEST, 0.25, 6e-4)
    for k in range(4000):
        advance(identified, np.array([0.0, 0.0, 0.002 if k < 2000 else 0.004]), np.zeros(3))
    assert identified.value[2] == pytest.approx(0.004, abs=2e-5)  # five time constants later


def test_a_slip_is_no_bias_and_no_turn_of_the_base():
    """A sole turns by 5 mrad within 0.1 s while the base does not."""
    identified, slipping = GyroBias(PERIOD, 20.0, LARGEST, 0.25, 6e-4), range(1010, 1030)
    before, missed = np.eye(3), np.zeros(3)
    for k in range(2000):
        slid = 0.005 * min(max(k - slipping.start, 0), len(slipping)) / len(slipping)
        now = Rotation.from_rotvec([0.0, 0.0, slid]).as_matrix()
        advance(identified, np.array([0.0, 0.0, 0.002]), sine_vector(before @ now.T))
        if identified.kernel.concluded:
            missed += identified.kernel.missed
        before = now
    assert identified.value[2] == pytest.approx(0.002, abs=1e-4)  # without the limit 5e-4
    assert abs(missed[2]) < 6e-4
