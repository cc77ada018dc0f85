"""The kernel of the ground's plane: compiled against interpreted, and against numpy's least squares and median."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout
from plantar.kernels import compiled, python_form
from plantar.kernels.skin import ground

from ...examples import examples

SOLE = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
seeds = st.integers(0, 2**32 - 1)


def fitted(module, distance, tolerance):
    kernel = module.GroundFit(SOLE.positions, SOLE.rotations[:, :, 2])
    out, inliers = np.empty(4), np.zeros(len(SOLE), dtype=np.uint8)
    return kernel.fit(distance, 0.05, tolerance, out, inliers), out, inliers


def readings(seed):
    rng = np.random.default_rng(seed)
    distance = 0.02 + SOLE.positions[:, :2] @ rng.uniform(-0.2, 0.2, 2) + 1e-4 * rng.normal(size=len(SOLE))
    distance[rng.random(len(SOLE)) < rng.uniform(0.0, 0.5)] += rng.uniform(0.005, 0.02)
    distance[rng.random(len(SOLE)) < rng.choice([0.0, 0.1, 0.9])] = rng.choice([np.nan, np.inf, -1e300])
    return distance


@pytest.mark.skipif(not compiled, reason="without a compiler there is one form only")
@examples(60)
@given(seeds)
def test_the_two_forms_agree_to_the_last_bit(seed):
    one, other = (fitted(m, readings(seed), 2e-3) for m in (ground, python_form("ground")))
    assert one[0] == other[0]
    assert np.array_equal(one[1], other[1], equal_nan=True)
    assert (one[2] == other[2]).all()


@given(seeds)
def test_the_inliers_plane_is_the_least_squares_plane(seed):
    distance = readings(seed)
    directions, out, inliers = fitted(ground, distance, 2e-3)
    used = inliers.astype(bool)
    if directions < 2:
        return
    base = np.column_stack([-np.ones(used.sum()), SOLE.positions[used, :2]])
    wanted, *_ = np.linalg.lstsq(base, -distance[used], rcond=None)
    assert out[:3] == pytest.approx(wanted, rel=1e-9, abs=1e-12)
    assert out[3] == pytest.approx(np.sqrt(np.mean((base @ wanted + distance[used]) ** 2)), abs=1e-12)


@given(seeds, st.integers(1, 40))
def test_a_ranked_value_is_the_sorted_one(seed, count):
    module = python_form("ground")
    scratch = module.GroundScratch(count)
    rng = np.random.default_rng(seed)
    values = rng.choice(rng.normal(size=7), count)  # some of them the same
    rank = int(rng.integers(count))
    scratch.miss[:] = values
    assert module._ranked(count, rank, scratch) == np.sort(values)[rank]
