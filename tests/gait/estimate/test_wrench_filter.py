"""The expected push against the paper's low pass and against integration of the pendulum under it."""

import math

import numpy as np
import pytest

from plantar.errors import InputError
from plantar.gait.estimate.wrench_filter import MOST_OFFSET, WrenchFilter, WrenchFilterRules

OMEGA, PERIOD = 3.44, 0.005


def filled(offset, lasts) -> WrenchFilter:
    """A filter that knows nothing but one offset."""
    made = WrenchFilter(WrenchFilterRules(time_constant=0.0, lasts=lasts), OMEGA, PERIOD)
    made.update(offset)
    return made


def test_it_is_the_papers_low_pass():
    made = WrenchFilter(WrenchFilterRules(time_constant=1.0), OMEGA, PERIOD)
    mean, rng = np.zeros(2), np.random.default_rng(0)
    for offset in rng.normal(size=(400, 2)):
        made.update(offset)
        mean = (1.0 - PERIOD) * mean + PERIOD * offset  # K 19 with alpha = dt
    assert made.expected == pytest.approx(mean, abs=2e-3)
    held = 0.0
    for _ in range(400):
        held = made.update([1.0, 0.0])[0]
    start = mean[0]
    assert held == pytest.approx(1.0 + (start - 1.0) * math.exp(-2.0), abs=1e-3)


@pytest.mark.parametrize("lasts", [1e6, 0.05, 0.5, 100.0])
@pytest.mark.parametrize("horizon", [1e-4, 0.3, 2.0])
def test_the_mean_moves_the_dcm_as_far_as_the_decaying_push(lasts, horizon):
    offset = np.array([0.03, -0.02])
    found = filled(offset, lasts).mean(horizon) * math.expm1(OMEGA * horizon)
    s, weight = np.polynomial.legendre.leggauss(60)
    s, weight = 0.5 * horizon * (s + 1.0), 0.5 * horizon * weight
    decayed = np.exp(-s / lasts)
    wanted = offset * np.sum(weight * OMEGA * np.exp(OMEGA * (horizon - s)) * decayed)
    assert found == pytest.approx(wanted, rel=1e-10)


def test_forces_and_times_out_of_all_measure_stay_finite():
    made = filled([1e4, -1e300], 0.5)
    assert np.linalg.norm(made.expected) == pytest.approx(MOST_OFFSET)
    assert np.isfinite(made.mean(100.0)).all()
    assert np.isfinite(made.mean(1e90)).all()
    assert made.update([math.nan, 1.0]).tolist() == [0.0, 0.0]
    assert made.mean(0.0).tolist() == [0.0, 0.0]


def test_a_push_is_over_some_time_after_it_ends():
    made = WrenchFilter(WrenchFilterRules(time_constant=0.1), OMEGA, PERIOD)
    assert not made.acts
    made.update([0.05, 0.0])
    assert made.acts
    for _ in range(1000):
        made.update([0.0, 0.0])
    assert not made.acts


def test_what_is_expected_decays_as_a_push_does_once_none_is_measured():
    made = WrenchFilter(WrenchFilterRules(time_constant=1.0, lasts=0.5), OMEGA, PERIOD)
    for _ in range(100):
        before = made.update([0.05, 0.0])[0]
    for _ in range(100):
        made.update([0.0, 0.0])
    assert made.expected[0] == pytest.approx(before * math.exp(-1.0), rel=1e-9)
    slow = WrenchFilter(WrenchFilterRules(time_constant=0.2, lasts=1e6), OMEGA, PERIOD)
    slow.update([0.05, 0.0])
    after = slow.expected[0]
    slow.update([0.0, 0.0])
    assert slow.expected[0] == pytest.approx(after * math.exp(-PERIOD / 0.2), rel=1e-9)


def test_wrong_rules_are_named():
    with pytest.raises(InputError, match="lasts"):
        WrenchFilterRules(lasts=0.0)
