"""The kernels of sums over contacts: compiled against interpreted, and against numpy's sums."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar.kernels import contact_sums, few_points, is_compiled, python_form

REACH = 5e-4
seeds = st.integers(0, 2**32 - 1)


def contacts(seed: int):
    """Contacts of a foot: own and other geoms (k,), positions, forces, torques (k, 3), gaps (k,), carries (k,)."""
    rng = np.random.default_rng(seed)
    k = int(rng.integers(1, 12))
    rows = rng.normal(0.0, 1.0, (k, 11))  # as a simulation keeps them: what is handed in has gaps between its rows
    carries = rng.random(k) < 0.6
    rows[~carries, 3:9] = 0.0
    ids = rng.integers(0, 3, (k, 2)).astype(np.int32)
    gaps = rng.uniform(-REACH, 3.0 * REACH, k)
    return ids[:, 0], ids[:, 1], rows[:, :3], rows[:, 3:6], rows[:, 6:9], gaps, carries


def summed(module, seed: int):
    _, _, positions, forces, torques, gaps, carries = contacts(seed)
    sums, points = np.zeros(7), []
    for _ in range(2):  # of two feet
        module.ground_sums(positions, forces, torques, gaps, carries.view(np.uint8), REACH, sums, points)
    return sums, points


def paired(module, seed: int):
    own, other, positions, forces, torques, gaps, _ = contacts(seed)
    return module.pair_loads(own, other, positions, forces, torques, gaps, REACH)


@pytest.mark.skipif(not is_compiled("contact_sums"), reason="without a compiler there is one form only")
@settings(max_examples=100)
@given(seeds)
def test_the_two_forms_agree_to_the_last_bit(seed):
    python = python_form("contact_sums")
    (one, points), (other, same) = summed(contact_sums, seed), summed(python, seed)
    assert (one == other).all()
    assert points == same
    assert paired(contact_sums, seed) == paired(python, seed)
    source = python_form("few_points")
    ring = few_points.small_hull(points)
    assert ring == source.small_hull(points)
    x, y = np.random.default_rng(seed).uniform(-0.3, 0.3, 2).tolist()
    assert few_points.small_margin(ring, x, y) == source.small_margin(ring, x, y)


@settings(max_examples=100)
@given(seeds)
def test_the_ground_s_sums_are_numpy_s(seed):
    sums, points = summed(contact_sums, seed)
    _, _, positions, forces, torques, gaps, carries = contacts(seed)
    assert sums[:3] == pytest.approx(2.0 * forces.sum(axis=0), abs=1e-12)
    assert sums[3:6] == pytest.approx(2.0 * (np.cross(positions, forces) + torques).sum(axis=0), abs=1e-12)
    assert sums[6] == pytest.approx(2.0 * positions[:, 2] @ forces[:, 2], abs=1e-12)
    assert points == 2 * [(x, y) for x, y, _ in positions[carries | (gaps <= REACH)].tolist()]


@settings(max_examples=100)
@given(seeds)
def test_each_pair_has_its_contacts_wrench_and_points(seed):
    own, other, positions, forces, torques, gaps, _ = contacts(seed)
    counts = ~((gaps > REACH) & (forces[:, 2] == 0.0))
    pairs = list(dict.fromkeys(zip(own[counts].tolist(), other[counts].tolist(), strict=True)))
    loads = paired(contact_sums, seed)
    assert len(loads) == len(pairs)
    for (first, second), (force, about_x, about_y, points) in zip(pairs, loads, strict=True):
        mine = counts & (own == first) & (other == second)
        moment = (np.cross(positions, forces) + torques)[mine].sum(axis=0)
        assert [force, about_x, about_y] == pytest.approx([forces[mine, 2].sum(), *moment[:2]], abs=1e-12)
        assert points == [(x, y) for x, y, _ in positions[mine].tolist()]
