"""Rotations against scipy, the group's axioms and finite differences."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.mechanics.rotation import (
    heading,
    level_rotation,
    orthonormalised,
    rotation_error,
    rotation_from_angles,
    rotation_from_vector,
    sine_vector,
    vector_from_rotation,
)

directions = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 0.1)
units = directions.map(lambda v: v / np.linalg.norm(v))
axes = units | st.sampled_from([sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)])
edges = [0.0, 1e-300, 1e-12, 1e-9, 1e-7, 0.99e-6, 1.01e-6, 1e-4, math.acos(-0.9), math.pi]
edges += [edge + step for edge in (math.pi, math.acos(-0.9)) for step in (-1e-3, -1e-6, -1e-9, -1e-12)]
angles = st.floats(0.0, math.pi) | st.sampled_from(edges)
vectors = st.builds(np.multiply, angles, axes)
any_vectors = st.builds(np.multiply, st.floats(0.0, 50.0), axes)


@given(any_vectors)
def test_exponential_is_that_of_scipy_and_a_rotation(vector):
    rotation = rotation_from_vector(vector)
    assert np.abs(rotation - Rotation.from_rotvec(vector).as_matrix()).max() < 1e-14
    assert np.abs(rotation @ rotation.T - np.eye(3)).max() < 2e-15
    assert np.linalg.det(rotation) == pytest.approx(1.0, abs=1e-14)


@given(vectors, vectors, vectors)
def test_rotations_are_a_group(a, b, c):
    p, q, r = (rotation_from_vector(v) for v in (a, b, c))
    assert np.abs((p @ q) @ r - p @ (q @ r)).max() < 1e-14
    assert np.array_equal(rotation_from_vector(np.zeros(3)), np.eye(3))
    assert np.abs(rotation_from_vector(-a) - p.T).max() < 1e-15
    assert np.abs(rotation_from_vector(0.5 * a) @ rotation_from_vector(0.5 * a) - p).max() < 1e-14
    # The adjoint: q exp(a) q^T = exp(q a).
    assert np.abs(q @ p @ q.T - rotation_from_vector(q @ a)).max() < 1e-14


@given(vectors)
def test_logarithm_of_the_exponential_leads_back(vector):
    found = vector_from_rotation(rotation_from_vector(vector))
    same, opposite = np.abs(found - vector).max(), np.abs(found + vector).max()
    if np.linalg.norm(vector) > math.pi - 1e-7:  # of half a turn, either vector
        assert min(same, opposite) < 2e-15 or same < 1e-8
    else:
        assert same <= 1e-14 * max(1e-3, float(np.linalg.norm(vector)))


@given(vectors)
def test_exponential_of_the_logarithm_leads_back(vector):
    rotation = np.asarray(Rotation.from_rotvec(vector).as_matrix())
    found = vector_from_rotation(rotation)
    assert np.linalg.norm(found) <= math.pi + 1e-15
    assert np.abs(rotation_from_vector(found) - rotation).max() < 1e-14


def test_half_turns_about_every_axis_have_a_logarithm():
    """The antisymmetric part is 0 there: it alone would give no turn at all."""
    rng = np.random.default_rng(0)
    for unit in [*np.eye(3), *-np.eye(3), *rng.normal(size=(50, 3))]:
        unit = unit / np.linalg.norm(unit)
        half = 2.0 * np.outer(unit, unit) - np.eye(3)
        found = vector_from_rotation(half)
        assert np.linalg.norm(found) == pytest.approx(math.pi, abs=1e-14)
        assert np.abs(np.cross(found, unit)).max() < 1e-14
        assert np.linalg.norm(rotation_error(half, np.eye(3))) == pytest.approx(1.0, abs=1e-14)


@given(vectors, units)
def test_small_turns_change_the_exponential_by_their_cross_product(vector, turn):
    rotation, h = rotation_from_vector(vector), 1e-5
    ahead, behind = (rotation_from_vector(s * h * turn) @ rotation for s in (1.0, -1.0))
    assert np.abs((ahead - behind) / (2.0 * h) - np.cross(turn, rotation.T).T).max() < 1e-9


@given(vectors, units)
def test_error_turns_the_actual_rotation_towards_the_wanted_one(vector, axis):
    actual = rotation_from_vector(2.5 * axis)
    wanted = rotation_from_vector(vector) @ actual
    error, angle = rotation_error(wanted, actual), float(np.linalg.norm(vector))
    expected = math.sin(angle) if angle < 0.5 * math.pi else 1.0
    assert np.linalg.norm(error) == pytest.approx(expected, abs=1e-14)
    if 1e-7 < angle < math.pi - 1e-6:
        assert error @ vector == pytest.approx(expected * angle, rel=1e-9)
        assert np.linalg.norm(rotation_error(actual, wanted) + error) < 1e-13


@given(units, st.floats(-1e-5, 1e-5))
def test_error_is_continuous_at_the_quarter_turn(axis, beyond):
    turn = rotation_from_vector((0.5 * math.pi + beyond) * axis)
    assert rotation_error(turn, np.eye(3)) == pytest.approx(axis, abs=1e-9)


@given(units, st.floats(-1e-4, 1e-4))
def test_derivative_of_the_error_at_the_target_is_the_turn(axis, h):
    rotation = rotation_from_vector(2.0 * axis[::-1])
    assert rotation_error(rotation_from_vector(h * axis) @ rotation, rotation) == pytest.approx(h * axis, abs=1e-12)
    assert sine_vector(rotation_from_vector(h * axis)) == pytest.approx(h * axis, abs=1e-12)


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_angles_are_turns_about_fixed_axes(yaw, pitch, roll):
    rotation = rotation_from_angles(yaw, pitch, roll)
    assert np.abs(rotation - Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()).max() < 1e-15
    assert heading(rotation) == pytest.approx(yaw, abs=1e-12)
    assert np.array_equal(rotation_from_angles(yaw), level_rotation(yaw))
    assert np.abs(level_rotation(yaw) - rotation_from_vector(np.array([0.0, 0.0, yaw]))).max() < 1e-15


@given(vectors, st.integers(0, 2**32 - 1), st.floats(1e-9, 1e-2))
def test_one_step_of_orthonormalisation_squares_the_error(vector, seed, size):
    off = rotation_from_vector(vector) + size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, 3))
    left, _, right = np.linalg.svd(off)
    before, found = np.linalg.norm(off - left @ right), orthonormalised(off)
    assert np.linalg.norm(found - left @ right) <= 1.6 * before**2 + 1e-14
