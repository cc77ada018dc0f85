"""The kernel of a Newton step against numpy's normal equations, and its compiled form against its source."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar import kernels
from plantar.kernels.joints import newton_step
from plantar.kernels.mechanics import rotations
from plantar.mechanics.rotation import rotation_error

ROUNDING, LEAST = 1e-8, 0.04
FORMS = (newton_step, kernels.python_form("newton_step"))


def problem(seed):
    """A leg-like problem: six velocities of a base and joints of which two are held, in units of 0.7 m."""
    rng = np.random.default_rng(seed)
    rows, nv = int(rng.integers(10, 19)), 20
    columns = np.setdiff1d(np.arange(nv), rng.choice(np.arange(6, nv), 2, replace=False))
    jacobian = rng.normal(size=(rows, nv)) * (rng.random((rows, nv)) < 0.7)
    row_units, column_units = rng.choice([1.0 / 0.7, 1.0], rows), np.where(np.arange(nv) < 3, 0.7, 1.0)
    return jacobian, 0.1 * rng.normal(size=rows), rng.normal(size=nv), columns, row_units, column_units


def solved(module, given, half=10.0, largest=1e9, least=0.0):
    """What a form says, its step, its Jacobian, the error in units and the velocity."""
    jacobian, error, configuration, columns, row_units, column_units = given
    movable, error = np.arange(6, len(columns)), error.copy()
    used, step, velocity = np.zeros((len(error), len(columns))), np.zeros(len(columns)), np.zeros(jacobian.shape[1])
    middle, halves = np.zeros(len(movable)), np.full(len(movable), half)
    kernel = module.NewtonStep(
        *(columns, row_units, column_units, movable, columns[movable], middle, halves, ROUNDING, least),
        *((jacobian, error, configuration), used, step, velocity),
    )
    for _ in range(2):  # nothing stays of the step before
        error[:] = given[1]
        stays = kernel.solve(largest)
    np.testing.assert_equal(kernel.worst(), np.abs(error).max())
    kernel.write()
    return stays, step, used, error, velocity


@pytest.mark.parametrize("seed", range(12))
def test_a_step_is_that_of_the_normal_equations(seed):
    given = problem(seed)
    jacobian, error, _, columns, row_units, column_units = given
    stays, step, used, in_units, velocity = solved(newton_step, given, np.inf)
    scaled = (jacobian * row_units[:, None] * column_units)[:, columns]
    np.testing.assert_allclose(used, scaled, rtol=1e-15)
    np.testing.assert_allclose(in_units, error * row_units, rtol=1e-15)
    normal = scaled.T @ scaled + ROUNDING * np.eye(len(columns))
    # Backward stable: what is left of the equations is rounding of their size.
    left = normal @ step - scaled.T @ in_units
    assert np.abs(left).max() <= 1e-13 * np.abs(normal).max() * max(1.0, np.abs(step).max())
    if len(error) >= len(columns):
        np.testing.assert_allclose(step, np.linalg.solve(normal, scaled.T @ in_units), rtol=1e-9)
    assert stays
    np.testing.assert_array_equal(velocity[columns], step * column_units[columns])
    assert not np.delete(velocity, columns).any()
    for a, b in zip(solved(FORMS[1], given, np.inf), (stays, step, used, in_units, velocity), strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize("module", FORMS)
def test_a_step_stays_only_where_nothing_forbids_it(module):
    given = problem(3)
    _, step, *_ = solved(module, given, np.inf)
    size = float(np.abs(step).max())
    assert solved(module, given, np.inf, largest=size)[0]
    assert not solved(module, given, np.inf, largest=np.nextafter(size, 0.0))[0]
    _, error, configuration, columns, *_ = given
    reach = float(np.abs(configuration[columns[6:]] + step[6:]).max())
    assert solved(module, given, reach)[0]
    assert not solved(module, given, np.nextafter(reach, 0.0))[0]
    scaled = solved(module, given, np.inf)[2]
    pivot = float(np.linalg.cholesky(scaled.T @ scaled + ROUNDING * np.eye(len(columns))).diagonal().min())
    assert solved(module, given, np.inf, least=pivot * (1.0 - 1e-6))[0]
    assert not solved(module, given, np.inf, least=pivot * (1.0 + 1e-6))[0]
    error[2] = np.nan
    assert not solved(module, given, np.inf)[0]


@pytest.mark.parametrize("angle", [0.0, 1e-8, 0.4, 1.57, 1.58, 2.9, np.pi])
def test_the_missing_pose_is_the_error_of_its_rotation_up_to_a_quarter_turn(angle):
    rng = np.random.default_rng(5)
    actual = Rotation.from_rotvec(rng.normal(size=3))
    axis = rng.normal(size=3)
    wanted = (Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)) * actual).as_matrix()
    place, at = rng.normal(size=(2, 3))
    for module in (rotations, kernels.python_form("rotations")):
        out = np.empty(6)
        near = module.missing_pose(place, wanted, at, actual.as_matrix(), out)
        assert near == (angle <= np.pi / 2)
        np.testing.assert_array_equal(out[:3], place - at)
        if near:
            np.testing.assert_allclose(out[3:], rotation_error(wanted, actual.as_matrix()), rtol=1e-13, atol=1e-15)
