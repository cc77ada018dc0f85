"""Strict hierarchies by one kernel: against the papers' projectors, and its two forms against each other."""

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.joints import task_space

INTERPRETED = kernels.python_form("task_space")


def problem(seed, size, counts):
    """A mass matrix, and rows with their wanted accelerations."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(size, size))
    levels = [(rng.normal(size=(count, size)), rng.normal(size=count)) for count in counts]
    return root @ root.T + np.eye(size), levels


def solved(form, mass, levels, least=1e-11):
    """Acceleration (n,) and the ranks of the levels."""
    space = form.TaskSpace(len(mass))
    assert space.begin(mass)
    ranks = []
    for rows, wanted in levels:
        rank, bound = space.own(np.ascontiguousarray(rows), wanted, True, least)
        if rank == len(rows):
            space.meet(rank)
        ranks.append((rank, bound))
    out = np.empty(len(mass))
    space.acceleration(out)
    return out, ranks


@pytest.mark.parametrize(("size", "counts"), [(3, (1, 1)), (7, (3, 3)), (12, (6, 5)), (36, (6, 6, 3, 10))])
@pytest.mark.parametrize("seed", range(5))
def test_levels_get_what_the_printed_projectors_give(seed, size, counts):
    """A 19-25 term by term, with inverses."""
    mass, levels = problem(seed, size, counts)
    inverse = np.linalg.inv(mass)
    projector, torque = np.eye(size), np.zeros(size)
    for rows, wanted in levels:
        projected = rows @ projector.T
        inertia = np.linalg.inv(projected @ inverse @ projected.T)
        torque = torque + projected.T @ inertia @ (wanted - rows @ inverse @ torque)
        projector = projector @ (np.eye(size) - projected.T @ (inverse @ projected.T @ inertia).T)
    found, ranks = solved(task_space, mass, levels)
    assert np.allclose(mass @ found, torque, rtol=1e-7, atol=1e-8 * np.abs(torque).max())
    assert [rank for rank, _ in ranks] == list(counts)


@pytest.mark.parametrize("seed", range(10))
def test_both_forms_give_the_same_bits(seed):
    mass, levels = problem(seed, 9, (3, 2, 2))
    levels[1] = (levels[0][0][:2] + (1e-13 if seed % 2 else 0.1) * levels[1][0], levels[1][1])
    (a, ranks_a), (b, ranks_b) = (solved(form, mass, levels) for form in (task_space, INTERPRETED))
    assert np.array_equal(a, b)
    assert ranks_a == ranks_b


@pytest.mark.parametrize("seed", range(20))
def test_the_bound_is_below_every_singular_value(seed):
    rng = np.random.default_rng(seed)
    mass, _ = problem(seed, 8, ())
    rows = rng.normal(size=(5, 8))
    rows[4] = rows[:4].T @ rng.normal(size=4) + 10.0 ** -rng.uniform(0, 9) * rows[4]
    _, [(rank, bound)] = solved(task_space, mass, [(rows, np.zeros(5))])
    weighted = np.linalg.solve(np.linalg.cholesky(mass), rows.T)
    strengths = np.linalg.svd(weighted / np.linalg.norm(weighted, axis=0), compute_uv=False)
    assert rank == 5
    assert 0.05 * strengths[-1] < bound <= strengths[-1] * (1.0 + 1e-6)


def test_rows_that_say_the_same_own_one_direction():
    mass, [(rows, wanted)] = problem(1, 6, (3,))
    rows = np.vstack([rows, 2.0 * rows, np.zeros((1, 6))])
    _, [(rank, _)] = solved(task_space, mass, [(rows, np.concatenate([wanted, wanted, [0.0]]))])
    assert rank == 3


def test_a_mass_matrix_must_be_positive_definite():
    assert not task_space.TaskSpace(2).begin(np.array([[1.0, 2.0], [2.0, 1.0]]))
    assert not task_space.TaskSpace(2).begin(np.full((2, 2), np.nan))


def test_a_push_acts_only_in_what_is_left():
    mass, [(rows, wanted)] = problem(3, 6, (4,))
    space = task_space.TaskSpace(6)
    space.begin(mass)
    space.own(rows, wanted, True, 1e-11)
    space.meet(4)
    space.push(np.random.default_rng(0).normal(size=6) * 1e3)
    out = np.empty(6)
    space.acceleration(out)
    assert np.allclose(rows @ out, wanted, atol=1e-11)
    assert np.abs(out).max() > 1.0
