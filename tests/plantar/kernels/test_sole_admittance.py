"""The kernel of foot damping in both forms against the same in numpy, tick after tick."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar.kernels import python_form
from plantar.kernels.gait import sole_admittance

FORMS = (sole_admittance, python_form("sole_admittance"))
PERIOD, SHARE, GAIN, BACK, RELEASE = 0.005, 0.2, 1e-3, 1.0, 8.0
LARGEST = np.array([0.01, 0.01, 0.004])


def wrench(fz, tx, ty):
    """Wrench (6,) on a sole; what friction carries does not matter."""
    return np.array([7.0, -8.0, fz, tx, ty, 9.0])


def correction(foot):
    return np.array([foot.roll, foot.pitch, foot.shift])


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1))
def test_it_moves_as_numpy_would(seed):
    rng = np.random.default_rng(seed)
    feet = [module.SoleAdmittance(PERIOD, SHARE, GAIN, BACK, RELEASE, LARGEST[0], LARGEST[2]) for module in FORMS]
    known, filtered = np.zeros(3), None
    for _ in range(60):
        measured, wanted, rate = rng.normal(0.0, 60.0, 3), rng.normal(0.0, 60.0, 3), rng.normal(0.0, 0.1)
        if rng.random() < 0.2:
            filtered, known = None, (1.0 - RELEASE * PERIOD) * known
            for foot in feet:
                foot.fade()
        else:
            filtered = measured if filtered is None else filtered + SHARE * (measured - filtered)
            off = filtered - wanted
            rates = np.array([GAIN * off[1], GAIN * off[2], rate])
            known = np.clip(known + PERIOD * (rates - BACK * known), -LARGEST, LARGEST)
            for foot in feet:
                assert foot.turn(wrench(*measured), wrench(*wanted)) == off[0]
                foot.lift(rate)
        np.testing.assert_allclose(correction(feet[0]), known, rtol=1e-12, atol=1e-15)
        assert np.array_equal(*map(correction, feet))


def test_what_fades_ends_at_none():
    for module in FORMS:
        foot = module.SoleAdmittance(PERIOD, SHARE, GAIN, BACK, RELEASE, LARGEST[0], LARGEST[2])
        foot.turn(wrench(300.0, 20.0, -15.0), wrench(300.0, 0.0, 0.0))
        before = correction(foot)
        assert np.abs(before[:2]).min() > 1e-5
        foot.fade()
        np.testing.assert_allclose(correction(foot), (1.0 - RELEASE * PERIOD) * before)
        for _ in range(400):
            foot.fade()
        assert not correction(foot).any()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("axis", [2, 3, 4])
def test_a_wrench_that_is_no_number_turns_nothing(axis: int, value: float) -> None:
    sole, wanted = sole_admittance.SoleAdmittance(0.005, 0.2, 0.01, 1.0, 10.0, 0.08, 0.02), np.zeros(6)
    sound = np.array([0.0, 0.0, 400.0, 5.0, -5.0, 0.0])
    sole.turn(sound, wanted)
    before = sole.roll, sole.pitch
    bad = sound.copy()
    bad[axis] = value
    assert sole.turn(bad, wanted) == 0.0
    assert (sole.roll, sole.pitch) == before
    sole.turn(sound, wanted)
    assert abs(sole.roll) < 0.01
    assert np.isfinite(sole.pitch)
