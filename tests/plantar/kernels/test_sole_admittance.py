"""The kernel of foot damping in both forms against the same in numpy, tick after tick."""

import decimal
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.base import fused
from plantar.kernels.gait import sole_admittance

from ...examples import examples

FORMS = (sole_admittance, python_form("sole_admittance"))
PERIOD, SHARE, GAIN, BACK, RELEASE = 0.005, 0.2, 1e-3, 1.0, 8.0
LARGEST = np.array([0.01, 0.01, 0.004])


def wrench(fz, tx, ty):
    """Wrench (6,) on a sole; what friction carries does not matter."""
    return np.array([7.0, -8.0, fz, tx, ty, 9.0])


def correction(foot):
    return np.array([foot.roll, foot.pitch, foot.shift])


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
        assert [foot.acts() for foot in feet] == 2 * [bool(correction(feet[0]).any())]
        np.testing.assert_allclose(correction(feet[0]), known, rtol=1e-12, atol=1e-15)
        assert np.array_equal(*map(correction, feet))


def test_what_fades_ends_at_none():
    for module in FORMS:
        foot = module.SoleAdmittance(PERIOD, SHARE, GAIN, BACK, RELEASE, LARGEST[0], LARGEST[2])
        foot.turn(wrench(300.0, 20.0, -15.0), wrench(300.0, 0.0, 0.0))
        before = correction(foot)
        assert foot.acts()
        assert np.abs(before[:2]).min() > 1e-5
        foot.fade()
        np.testing.assert_allclose(correction(foot), (1.0 - RELEASE * PERIOD) * before)
        for _ in range(400):
            foot.fade()
        assert not correction(foot).any()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("axis", [2, 3, 4])
def test_a_wrench_that_is_no_number_turns_nothing(axis, value):
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


numbers = st.floats(-1e200, 1e200) | st.floats(-2.0, 2.0) | st.floats(-1e-160, 1e-160)


def both(name, *arguments):
    """What both forms give, checked to be the same."""
    one, other = (getattr(module, name)(*arguments) for module in FORMS)
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)
    return one


@examples(60)
@given(seed=st.integers(0, 2**32 - 1))
def test_soles_are_turned_raised_and_pressed_as_numpy_would(seed):
    rng = np.random.default_rng(seed)
    level = np.ascontiguousarray(Rotation.from_rotvec(rng.normal(size=3)).as_matrix())
    position, center, wrench = rng.normal(size=3), rng.normal(size=2), 100.0 * rng.normal(size=6)
    x, y, roll, pitch, shift = (0.2 * rng.normal(size=5)).tolist()
    turn = Rotation.from_rotvec([x, y, 0.0]).as_matrix()
    np.testing.assert_allclose(both("turned", level, x, y), level @ turn, atol=1e-15)
    risen = both("risen", position, center, roll, pitch, shift)
    rise = shift + pitch * center[0] - roll * center[1]
    np.testing.assert_allclose(risen, position + np.array([0.0, 0.0, rise]))
    wrench[2] = abs(wrench[2])
    force, place = both("pressed", wrench, level, position, center)
    np.testing.assert_allclose(force, level @ wrench[:3], atol=1e-13)
    cop = np.array([-wrench[4], wrench[3]]) / wrench[2]
    np.testing.assert_allclose(place, position[:2] + level[:2, :2] @ cop, rtol=1e-12, atol=1e-12)
    # What does not press acts at the centre.
    force, place = both("pressed", np.zeros(6), level, position, center)
    assert not force.any()
    np.testing.assert_allclose(place, position[:2] + level[:2, :2] @ center, rtol=1e-12, atol=1e-12)


@examples(100)
@given(a=numbers, b=numbers, c=numbers)
def test_a_fused_multiply_add_is_rounded_once(a, b, c):
    with decimal.localcontext(prec=2500, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN):
        exact = float(decimal.Decimal(a) * decimal.Decimal(b) + decimal.Decimal(c))
    assert fused.multiply_add(a, b, c) == exact
    # The compiled form has the processor's: 0 a + 1 b + 0 is b, and a row of a matrix is a fused sum.
    level = np.array([[a, b, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    wrench = np.array([b, 1.0, 0.0, 0.0, 0.0, 0.0])
    forces = [module.pressed(wrench, level, np.zeros(3), np.zeros(2))[0] for module in FORMS]
    assert forces[0].tolist() == forces[1].tolist() == [fused.multiply_add(a, b, b), 1.0, 0.0]


@pytest.mark.parametrize("a", [0.0, -0.0, 2.0, -1e300, math.inf, math.nan])
def test_a_fused_multiply_add_of_zeros_and_what_is_not_finite_is_that_of_the_processor(a):
    for b in (0.0, -0.0, 1e300, -math.inf):
        for c in (0.0, -0.0, -3.0, math.inf):
            found = fused.multiply_add(a, b, c)
            expected = a * b + c
            assert found == expected or (math.isnan(found) and math.isnan(expected))
            assert math.copysign(1.0, found) == math.copysign(1.0, expected) or math.isnan(found)
