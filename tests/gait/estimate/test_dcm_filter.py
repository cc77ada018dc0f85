"""The filter of a pushed pendulum against scipy's Riccati solver and against the pendulum's truth."""

import math

import numpy as np
import pytest
from scipy.linalg import expm, solve_discrete_are

from plantar.gait.estimate.dcm_filter import DcmFilter, DcmFilterRules

OMEGA, PERIOD = 3.44, 0.005
NOISE = DcmFilterRules()
"""The noises that the truth below is drawn with are those that the filter is told."""


def walk(rules, felt, seconds=3.6, seed=0):
    """DCM errors (n,) of a filter in m along x: a pendulum is held over a swinging ZMP and pushed from 3.0 to 3.2 s.

    The truth is integrated by a matrix exponential of its own, and kept from falling by a ZMP that follows it.
    """
    rng, filtered = np.random.default_rng(seed), DcmFilter(rules, OMEGA, PERIOD)
    step = expm(PERIOD * np.array([[0.0, 1.0, 0.0], [OMEGA**2, 0.0, -(OMEGA**2)], [0.0, 0.0, 0.0]]))
    x, v, errors = 0.0, 0.0, []
    p = u = 0.0
    for k in range(int(seconds / PERIOD)):
        com = [x + rng.normal(scale=NOISE.com_noise), 0.0]
        state = filtered.update(com, [p + rng.normal(scale=NOISE.zmp_noise), 0.0], [u if felt else 0.0, 0.0])
        errors.append(state.dcm[0] - (x + v / OMEGA))
        u = 0.1 if 3.0 <= k * PERIOD < 3.2 else 0.0
        p = 1.5 * (x + v / OMEGA) + 0.02 * math.sin(4.0 * k * PERIOD)
        x, v, _ = step @ [x, v, p - u]
    return np.array(errors)


@pytest.mark.parametrize("unfelt", [0.0, 0.8])
def test_the_gain_is_that_of_the_riccati_equation(unfelt):
    rules = DcmFilterRules(unfelt_rate=unfelt)
    made = DcmFilter(rules, OMEGA, PERIOD)
    count = 3 if unfelt else 2
    # The same model by a matrix exponential: x, xi, d and the ZMP, which is held.
    a = np.zeros((4, 4))
    a[0, :2], a[1, 1:] = (-OMEGA, OMEGA), (OMEGA, OMEGA, -OMEGA)
    whole = expm(a * PERIOD)
    step, by_zmp = whole[:count, :count], whole[:count, 3]
    noise = rules.zmp_noise**2 * np.outer(by_zmp, by_zmp) + 1e-18 * np.eye(count)
    if unfelt:
        noise[2, 2] = (unfelt * PERIOD) ** 2
    h, r = np.eye(1, count), np.array([[rules.com_noise**2]])
    p = solve_discrete_are(step.T, h.T, noise, r)
    assert made._gain == pytest.approx(p @ h.T @ np.linalg.inv(h @ p @ h.T + r), rel=1e-6)


def test_a_push_that_is_felt_hardly_shows_in_the_error():
    trusting, wary = DcmFilterRules(unfelt_rate=0.0), DcmFilterRules()
    during = slice(int(3.0 / PERIOD), int(3.4 / PERIOD))
    told, blind, guessed = (
        np.mean([np.abs(walk(rules, felt, seed=s)[during]).max() for s in range(2)])
        for rules, felt in ((trusting, True), (trusting, False), (wary, False))
    )
    assert told < 0.5 * blind
    assert guessed < 0.8 * blind


def test_what_no_skin_feels_is_found():
    filtered = DcmFilter(DcmFilterRules(), OMEGA, PERIOD)
    for _ in range(2000):  # leans against a push of 0.03 m, and stands
        state = filtered.update([0.1, 0.0], [0.13, 0.0], [0.0, 0.0])
    assert state.unfelt == pytest.approx([0.03, 0.0], abs=1e-4)
    assert state.dcm == pytest.approx([0.1, 0.0], abs=1e-4)


def test_without_ground_only_the_push_accelerates():
    filtered = DcmFilter(DcmFilterRules(unfelt_rate=0.0), OMEGA, PERIOD)
    filtered.update([0.0, 0.0], None, [0.0, 0.0])
    filtered._state[1] = 1.0 / OMEGA, 0.0  # moves at 1 m/s
    state = filtered.update([PERIOD, 0.0], None, [0.0, 0.0])
    assert OMEGA * (state.dcm - state.com) == pytest.approx([1.0, 0.0], abs=1e-3)
    filtered.reset()
    assert filtered.update([0.5, 0.2], None, [0.0, 0.0]).dcm.tolist() == [0.5, 0.2]
