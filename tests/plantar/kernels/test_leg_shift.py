"""What swinging legs take and give against the formulas in numpy, and a pendulum's miss, in both forms."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.gait import leg_shift, pendulum_miss

FORMS = [leg_shift, python_form("leg_shift")]
MISSES = [pendulum_miss, python_form("pendulum_miss")]
SQUARE = 0.1 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def instant(rng):
    names = ("vrp", "dcm", "com", "com_velocity", "com_acceleration")
    return SimpleNamespace(**{name: rng.normal(size=2) for name in names})


@pytest.mark.parametrize("form", FORMS)
def test_shift_is_the_formulas(form):
    rng = np.random.default_rng(3)
    reference, shift, inertia, omega = instant(rng), instant(rng), 5e-3, 3.2
    planned, foot = form.accelerations(reference, shift, inertia)
    np.testing.assert_array_equal(planned, reference.com_acceleration + shift.com_acceleration)
    np.testing.assert_array_equal(foot, shift.vrp / -inertia)
    state = SimpleNamespace(com=rng.normal(size=3), com_velocity=rng.normal(size=3))
    whole, own = form.dcms(state, shift, omega)
    np.testing.assert_array_equal(whole, (state.com + state.com_velocity / omega)[:2])
    np.testing.assert_array_equal(own, whole - shift.dcm)
    com, acceleration, momentum = form.added(reference.com, reference.com_acceleration, shift, inertia)
    np.testing.assert_array_equal(com, reference.com + shift.com)
    np.testing.assert_array_equal(acceleration, reference.com_acceleration + shift.com_acceleration)
    np.testing.assert_array_equal(momentum, -shift.vrp - 2.0 * inertia * acceleration)


@pytest.mark.parametrize("form", MISSES)
@pytest.mark.parametrize("seed", range(8))
def test_a_pendulum_misses_what_its_support_cannot_give(form, seed):
    rng = np.random.default_rng(seed)
    dcm, goal, offset = 0.05 * rng.normal(size=(3, 2))
    omega, left = 3.2, 0.3
    pendulum = SimpleNamespace(dcm=dcm, goal=goal, offset=offset, omega=omega, zmp_region=SQUARE)
    growth, wanted, zmp = form.best_zmp(pendulum, left)
    assert growth == pytest.approx(np.expm1(omega * left), rel=1e-15)
    np.testing.assert_allclose(wanted, dcm + (dcm - goal) / growth + offset, rtol=0, atol=1e-15)
    np.testing.assert_allclose(zmp, np.clip(wanted, -0.1, 0.1), rtol=0, atol=1e-15)
    point = zmp - offset  # the DCM goes away from it by e^(w T)
    end = point + np.exp(omega * left) * (dcm - point)
    np.testing.assert_allclose(form.missed_by(pendulum, left), end - goal, rtol=0, atol=1e-14)
