"""A wrench on the body against the moment balance of a pendulum, and against the printed signs."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.mechanics.external_wrench import external_acceleration, vrp_offset
from plantar.mechanics.wrench import wrench_at

MASS, HEIGHT = 86.0, 0.83
OMEGA = math.sqrt(GRAVITY / HEIGHT)


def moment_balance(force: np.ndarray, point: np.ndarray, com: np.ndarray, zmp: np.ndarray) -> np.ndarray:
    """Horizontal acceleration (2,) of an upright body pushed at a point, by moments about its ZMP.

    The ground's force has no horizontal moment there, so weight and push are all that changes the angular momentum
    m z x x'' of the CoM.
    """
    push, lever = np.append(force, 0.0), point - zmp
    about_zmp = np.cross(lever, push) + np.cross(com - zmp, [0.0, 0.0, -MASS * GRAVITY])
    return np.array([about_zmp[1], -about_zmp[0]]) / (MASS * (com - zmp)[2])


numbers = st.floats(-1.0, 1.0)


@given(numbers, numbers, numbers, numbers, numbers)
def test_it_is_the_moment_balance_about_the_zmp(fx, fy, above, aside, out):
    com, zmp = np.array([0.3, -0.1, HEIGHT]), np.array([0.25, 0.02, 0.0])
    force, point = 1e4 * np.array([fx, fy]), com + np.array([out, aside, above])
    wrench = wrench_at([*force, 0.0, *np.cross(point, [*force, 0.0])], com)
    u = zmp[:2] - vrp_offset(wrench, MASS, OMEGA)
    wanted = moment_balance(force, point, com, zmp)
    assert OMEGA**2 * (com[:2] - u) == pytest.approx(wanted, rel=1e-12, abs=1e-9)
    free = moment_balance(np.zeros(2), point, com, zmp)
    assert external_acceleration(wrench, MASS, OMEGA) == pytest.approx(wanted - free, rel=1e-12, abs=1e-9)


def test_the_printed_sign_would_let_a_push_at_the_shoulder_accelerate_less():
    force, above = 50.0, 0.4
    com = np.array([0.0, 0.0, HEIGHT])
    right = moment_balance(np.array([force, 0.0]), com + np.array([0.0, 0.0, above]), com, np.zeros(3))[0]
    u_force, u_moment = force / (MASS * OMEGA**2), force * above / (MASS * GRAVITY)
    printed = OMEGA**2 * (u_force - u_moment)
    found = external_acceleration([force, 0.0, 0.0, 0.0, force * above, 0.0], MASS, OMEGA)[0]
    assert (found, right) == pytest.approx((0.862, 0.862), abs=5e-4)
    assert printed == pytest.approx(0.301, abs=5e-4)


def test_a_smaller_virtual_mass_gives_way_more():
    wrench = [3.0, -2.0, 5.0, 0.7, 0.2, 0.1]
    assert vrp_offset(wrench, MASS, OMEGA, 0.5) == pytest.approx(2.0 * vrp_offset(wrench, MASS, OMEGA))


def test_many_wrenches_at_once_and_those_that_are_not_finite():
    wrenches = np.array([[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [1e4, 0, 0, 0, 1e4, 0], [math.nan, 0, 0, 0, 0, 0]])
    found = vrp_offset(wrenches, MASS, OMEGA)
    assert found[0] == pytest.approx(vrp_offset(wrenches[0], MASS, OMEGA))
    assert np.isfinite(found[:2]).all()
    assert math.isnan(found[2, 0])
    assert vrp_offset(np.empty((0, 6)), MASS, OMEGA).shape == (0, 2)


@pytest.mark.parametrize("wrong", [0.0, -1.0, math.nan, math.inf])
def test_what_is_no_body_is_refused(wrong):
    wrench = np.zeros(6)
    with pytest.raises(InputError, match="mass is"):
        vrp_offset(wrench, wrong, OMEGA)
    with pytest.raises(InputError, match="pendulum frequency is"):
        external_acceleration(wrench, MASS, wrong)
    with pytest.raises(InputError, match="share of the mass is"):
        vrp_offset(wrench, MASS, OMEGA, wrong)
