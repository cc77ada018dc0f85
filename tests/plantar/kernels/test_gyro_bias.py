"""The kernel of the gyro's bias against the same in numpy, and its compiled form against its source."""

import math

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.gait import gyro_bias

PERIOD, LEAST, LARGEST, TICKS, SLIP, ONE_FOOT, KNOWN = PARAMETERS = (0.005, 0.0125, 0.05, 4, 2e-5, 0.1, 8)
SHARE, FOLLOW, BAND = STEADY = (0.8, 0.02, 40.0)
SOURCE = kernels.python_form("gyro_bias")


class Reference:
    """The mean of the pieces in numpy."""

    def __init__(self):
        self.value, self.missed, self.gathered = np.zeros(3), None, 0.0
        self.piece = []

    def update(self, gyro, turn, both):
        self.missed = None
        if turn is not None:
            self.piece.append((PERIOD * (gyro - self.value) - turn, 1.0 if both else ONE_FOOT))
        if self.piece and (turn is None or len(self.piece) >= TICKS):
            beyond = np.sum([b for b, _ in self.piece], axis=0)
            allowed = np.array([math.inf, math.inf, SLIP])
            if self.gathered < KNOWN:
                allowed = np.maximum(allowed, np.abs(beyond))
            worth = sum(w for _, w in self.piece)
            self.gathered += worth
            share = min(1.0, max(len(self.piece) * LEAST, worth / self.gathered))
            rate = np.clip(beyond, -allowed, allowed) / (len(self.piece) * PERIOD)
            self.value = np.clip(self.value + share * rate, -LARGEST, LARGEST)
            self.missed, self.piece = np.where(np.abs(beyond) <= allowed, -beyond, 0.0), []


@pytest.mark.parametrize("rate", [0.004, 0.2])
def test_a_bias_is_the_mean_of_the_pieces(rate):
    rng = np.random.default_rng(3)
    values, missed = np.zeros((2, 3)), np.zeros((2, 3))
    forms = [m.GyroBias(*PARAMETERS, values[k], missed[k]) for k, m in enumerate((gyro_bias, SOURCE))]
    reference, ended = Reference(), 0
    for _ in range(400):
        gyro, turn = rate * rng.normal(size=3), 2e-6 * rng.normal(size=3)
        stands, both = bool(rng.random() < 0.9), bool(rng.random() < 0.5)
        reference.update(gyro, turn if stands else None, both)
        for form in forms:
            form.update(*gyro.tolist(), stands, *turn.tolist(), both)
            assert form.concluded == (reference.missed is not None)
        np.testing.assert_allclose(values[0], reference.value, rtol=1e-10, atol=1e-15)
        if reference.missed is not None:
            ended += 1
            np.testing.assert_allclose(missed[0], reference.missed, rtol=1e-9, atol=1e-12)
        assert np.array_equal(values[0], values[1])
        assert np.array_equal(missed[0], missed[1])
    assert ended > 80


def test_what_is_no_number_stays_none():
    values, missed = np.zeros((2, 3)), np.zeros((2, 3))
    for k, module in enumerate((gyro_bias, SOURCE)):
        form = module.GyroBias(*PARAMETERS, values[k], missed[k])
        form.update(0.0, 0.0, math.nan, True, 0.0, 0.0, 0.0, True)
        form.update(0.0, 0.0, 0.0, False, 0.0, 0.0, 0.0, False)
    assert np.isnan(values[:, 2]).all()
    assert not values[:, :2].any()
    assert not missed.any()


def test_which_feet_stand_still():
    rng = np.random.default_rng(4)
    forms, means = [m.SteadyLoad(*STEADY) for m in (gyro_bias, SOURCE)], None
    for _ in range(500):
        loads = np.maximum(0.0, rng.choice([-1.0, 30.0, 300.0, 330.0], 2) + 20.0 * rng.normal(size=2))
        means = loads if means is None else means + FOLLOW * (loads - means)
        carries = loads >= SHARE * loads.sum()
        usual = (loads > (1.0 - SHARE) * loads.sum()) & (abs(loads - means) < BAND)
        for form in forms:
            form.update(*loads.tolist())
            assert [form.left, form.right] == np.where(carries | usual, loads, 0.0).tolist()
