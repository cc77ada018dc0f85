"""The closed forms of the ankle strategy against integration of the equation, finite differences and the paper."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from plantar.gait.balance.ankle_strategy import (
    AnkleRules,
    Saturation,
    double_support_pull,
    double_support_vrp,
    shrunk_support,
    single_support_vrp,
    target_dcms,
    within_support,
)

place = st.lists(st.integers(-400, 400), min_size=2, max_size=2).map(lambda mm: np.array(mm) / 1e3)
push = st.lists(st.integers(-100, 100), min_size=2, max_size=2).map(lambda mm: np.array(mm) / 1e3)
rate = st.floats(2.5, 8.0)
duration = st.floats(0.02, 0.8)
share = st.floats(0.0, 0.98)
few = settings(max_examples=15)  # an integration of the equation takes some 5 ms


def integrated(dcm, vrp_at, offset, omega, begin, end):
    """DCM (2,) at `end` by integration of K 8-9 (corrected)."""
    found = solve_ivp(
        lambda t, xi: omega * (xi - vrp_at(t) + offset), (begin, end), dcm, "DOP853", rtol=1e-13, atol=1e-15
    )
    return found.y[:, -1]


def double_support_reference(time, duration, start, end):
    """VRP (2,) of K 17."""
    return end - (end - start) * (1.0 - math.sin(0.5 * math.pi * time / duration))


@few
@given(place, place, push, rate, duration)
def test_the_single_support_vrp_reaches_its_target(dcm, target, offset, omega, time):
    found = single_support_vrp(dcm, target, time, offset, omega)
    wanted = integrated(dcm, lambda _: found.vrp, offset, omega, 0.0, time)
    assert target == pytest.approx(wanted, abs=1e-10 * math.exp(omega * time))
    # K 25 as printed.
    grown = math.exp(omega * time)
    assert found.vrp == pytest.approx((target + offset - grown * (dcm + offset)) / (1.0 - grown), abs=1e-10)


@few
@given(place, place, place, push, rate, duration, share)
def test_the_double_support_vrp_reaches_its_target(dcm, target, end, offset, omega, time, part):
    begun = part * time
    found = double_support_vrp(dcm, target, end, time, begun, offset, omega)
    # K 26 backwards: the u_i with which the rest of K 17 passes through the VRP of now.
    left = 1.0 - math.sin(0.5 * math.pi * part)
    start = end - (end - found.vrp) / left
    wanted = integrated(dcm, lambda t: double_support_reference(t, time, start, end), offset, omega, begun, time)
    scale = 1.0 + float(np.abs(found.vrp).max())
    assert target == pytest.approx(wanted, abs=1e-10 * scale * math.exp(omega * time))


def test_the_double_support_vrp_is_that_of_the_paper():
    dcm, target, end, offset = (np.array(v) for v in ([0.05, 0.02], [0.12, 0.05], [0.2, 0.1], [0.01, -0.02]))
    omega, time, begun = 3.44, 0.8, 0.3
    wd = 0.5 * math.pi / time
    cd = omega / (omega**2 + wd**2)
    grown = math.exp(omega * (time - begun))
    sc = omega * math.sin(wd * begun) + wd * math.cos(wd * begun)
    uew = end - offset
    start = end - (target - uew - grown * (dcm - uew)) / (grown * (1.0 - cd * sc) - (1.0 - cd * omega))
    wanted = (end - start) * (math.sin(wd * begun) - 1.0) + end
    assert double_support_vrp(dcm, target, end, time, begun, offset, omega).vrp == pytest.approx(wanted, abs=1e-12)


@given(rate, st.floats(0.01, 100.0), st.floats(1e-4, 1.0))
def test_the_pull_of_a_vrp_is_its_integral(omega, time, part):
    left = part * time
    wd = 0.5 * math.pi / time
    cuts = np.linspace(0.0, min(left, 60.0 / omega), 40)  # beyond, e^(-w s) is below 1e-26
    nodes, weights = np.polynomial.legendre.leggauss(20)
    total = 0.0
    for a, b in pairwise(cuts):
        s = 0.5 * (b - a) * nodes + 0.5 * (a + b)
        q = np.sin(0.5 * wd * (left - s)) ** 2 / math.sin(0.5 * wd * left) ** 2
        total += 0.5 * (b - a) * float(np.sum(weights * omega * np.exp(-omega * s) * q))
    assert double_support_pull(omega, time, left) == pytest.approx(total, rel=1e-10)


@few
@given(place, place, place, push, rate, duration, duration)
def test_both_phases_after_each_other_end_over_the_next_foot(stance, to, stride, offset, omega, last, both):
    targets = target_dcms(to, stance, stride, last, both, offset, omega)
    swayed = integrated(
        targets.single_end, lambda t: double_support_reference(t, both, stance, to), offset, omega, 0.0, both
    )
    assert targets.double_end == pytest.approx(swayed, abs=1e-10 * math.exp(omega * both))
    end = integrated(targets.double_end, lambda _: to, offset, omega, 0.0, last)
    # K 22 (corrected): it is u_n - u_w that the second step ends at; u_n is missed wherever there is a push.
    assert end == pytest.approx(to + stride - offset, abs=1e-9 * math.exp(omega * last))
    if np.abs(offset).max() > 1e-3:
        assert end != pytest.approx(to + stride, abs=1e-4)


def test_without_double_support_the_weight_goes_over_at_once():
    given_step = ([0.2, -0.1], [0.0, 0.1], [0.2, 0.2], 0.5)
    at_once = target_dcms(*given_step, 0.0, [0.01, 0.02], 3.5)
    assert at_once.single_end == pytest.approx(at_once.double_end)
    nearly = target_dcms(*given_step, 1e-9, [0.01, 0.02], 3.5)
    assert nearly.single_end == pytest.approx(at_once.single_end, abs=1e-7)
    assert nearly.slope == pytest.approx(at_once.slope, abs=1e-7)


@given(place, place, place, push, rate, duration, st.floats(0.05, 0.95))
def test_derivatives_are_those_of_finite_differences(dcm, target, end, offset, omega, time, part):
    h = np.array([1e-4, 0.0])
    single = single_support_vrp(dcm, target, time, offset, omega)
    moved = single_support_vrp(dcm + h, target, time, offset, omega).vrp - single.vrp
    assert moved[0] / h[0] == pytest.approx(single.gain, rel=1e-6)
    double = double_support_vrp(dcm, target, end, time, part * time, offset, omega)
    moved = double_support_vrp(dcm + h, target, end, time, part * time, offset, omega).vrp - double.vrp
    assert moved[0] / h[0] == pytest.approx(double.gain, rel=1e-6)
    targets = target_dcms(end, dcm, target, 0.5, time, offset, omega)
    moved = target_dcms(end + h, dcm, target, 0.5, time, offset, omega).single_end - targets.single_end
    assert moved[0] / h[0] == pytest.approx(targets.slope, abs=1e-8)


@pytest.mark.parametrize("omega", [2.5, 10.0])
@pytest.mark.parametrize("time", [0.0, 1e-12, 1e-3, 1.0, 100.0])
@pytest.mark.parametrize("force", [0.0, 1e4])
def test_nothing_overflows(omega, time, force):
    offset = np.array([force / (3.0 * omega**2), -force])  # on a robot of 3 kg, and of 1 / w^2 kg
    dcm, target = np.array([0.3, -0.2]), np.array([1e3, 5.0])
    single = single_support_vrp(dcm, target, time, offset, omega)
    double = double_support_vrp(dcm, target, [0.2, 0.1], time, 0.0, offset, omega)
    told = [single.vrp, double.vrp, *target_dcms(dcm, target, target, time, time, offset, omega)[:2]]
    assert np.isfinite(np.array(told)).all()
    assert math.isfinite(single.gain * double.gain)
    named = Saturation.TIME if time < 1e-6 else Saturation.NONE
    assert (single.saturated, double.saturated) == (named, named)


def test_a_vrp_outside_the_support_is_cut_and_says_so():
    sole = np.array([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
    inside = single_support_vrp([0.02, 0.0], [0.05, 0.0], 0.5, [0.0, 0.0], 3.5)
    assert within_support(inside, sole) is inside
    outside = single_support_vrp([0.3, 0.0], [0.05, 0.0], 0.5, [0.0, 0.0], 3.5)
    cut = within_support(outside, sole)
    assert (cut.vrp.tolist(), cut.saturated) == ([0.1, 0.0], Saturation.SUPPORT)
    assert within_support(outside, np.empty((0, 2))) is outside


def test_the_support_shrinks_along_the_sole_and_across_it():
    sole = np.array([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
    c, s = math.cos(0.3), math.sin(0.3)
    turn, at = np.array([[c, s], [-s, c]]), np.array([0.4, 0.2])
    found = shrunk_support(at + sole @ turn, AnkleRules(), at, 0.3)
    assert found == pytest.approx(at + (sole * [0.5, 0.8]) @ turn)  # beta_x, beta_y of K Table 1
