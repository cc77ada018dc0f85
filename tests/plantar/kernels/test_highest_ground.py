"""The plane through the highest ground: both forms agree, and it is what numpy's least squares find."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout, kernels
from plantar.kernels.gait import highest_ground

LAYOUT = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
X, Y = LAYOUT.positions[:, 0].copy(), LAYOUT.positions[:, 1].copy()
NOISE = 2e-3
LEAST = 10
PYTHON = kernels.python_form("highest_ground")
seeds = st.integers(0, 2**32 - 1)


def ground(seed):
    """Distances of sloping, stepped or scattered ground, some unseen, and the readings behind each."""
    rng = np.random.default_rng(seed)
    distance = rng.uniform(0.0, 0.04) + rng.uniform(-0.1, 0.1) * X + rng.uniform(-0.1, 0.1) * Y
    distance += np.where(rng.uniform(-0.15, 0.15) < X, rng.uniform(0.0, 0.02), 0.0)
    low = rng.random(len(X)) < rng.choice([0.0, 0.05, 0.3])
    distance = distance + np.where(low, rng.uniform(0.0, 0.03, len(X)), 0.0)
    readings = rng.uniform(1.0, 60.0, len(X))
    distance += rng.normal(0.0, NOISE, len(X)) / np.sqrt(readings)
    distance[rng.random(len(X)) < rng.choice([0.0, 0.2, 0.9])] = rng.choice([np.inf, np.nan])
    return distance, readings


def fitted(module, distance, readings):
    used, plane = np.zeros(len(X), dtype=np.uint8), np.zeros(3)
    return module.highest_plane(X, Y, distance, readings, NOISE, LEAST, used, plane), used, plane


@given(seeds)
def test_both_forms_agree_to_the_last_bit(seed):
    distance, readings = ground(seed)
    ours, theirs = (fitted(module, distance, readings) for module in (highest_ground, PYTHON))
    assert ours[0] == theirs[0]
    assert ours[1].tolist() == theirs[1].tolist()
    assert ours[2].tolist() == theirs[2].tolist()


def plane_of(distance, readings, used):
    """Least squares through some points by numpy: level, sx, sy; None for too few, or points in a row."""
    x, y, w = X[used], Y[used], readings[used]
    if len(x) < 6:
        return None
    spread = np.cov(x, y, aweights=w, ddof=0)
    least = 0.115 * min(X.var(), Y.var())
    if np.linalg.det(spread) < 0.02 * spread[0, 0] * spread[1, 1] or spread.diagonal().min() < least:
        return None
    rows = np.column_stack([np.ones(len(x)), -x, -y])
    return np.linalg.lstsq(rows * np.sqrt(w)[:, None], distance[used] * np.sqrt(w), rcond=None)[0]


@given(seeds)
def test_the_plane_is_the_one_that_numpy_finds(seed):
    distance, readings = ground(seed)
    explained = NOISE * np.maximum(1.0, 4.0 / np.sqrt(readings))
    seen = np.isfinite(distance)
    used, plane = seen.copy(), None
    for _ in range(8):
        found = plane_of(distance, readings, used)
        if found is None:
            plane = None
            break
        plane = found
        above = np.where(seen, plane @ np.array([np.ones(len(X)), -X, -Y]) - distance, -np.inf)
        if (above > explained)[used].any():
            used &= above > 0.0
        elif (above < -explained)[used].any():
            used &= above > -explained
        else:
            break
    got, on, ours = fitted(highest_ground, distance, readings)
    assert got == (plane is not None)
    if plane is None:
        assert on.astype(bool).tolist() == used.tolist()
        return
    for _ in range(3 if used.sum() >= LEAST else 0):
        near = np.abs(plane @ np.array([np.ones(len(X)), -X, -Y]) - distance) < explained
        near &= seen
        if (near == used).all():
            break
        found = plane_of(distance, readings, near)
        if found is None:
            break
        above = np.where(seen, found @ np.array([np.ones(len(X)), -X, -Y]) - distance, -np.inf)
        if (above > explained).any():
            break
        used, plane = near, found
    assert on.astype(bool).tolist() == used.tolist()
    np.testing.assert_allclose(ours, plane, rtol=0, atol=1e-12)


@given(seeds)
def test_no_ground_stands_above_the_plane(seed):
    distance, readings = ground(seed)
    found, _on, plane = fitted(highest_ground, distance, readings)
    if found:
        above = plane @ np.array([np.ones(len(X)), -X, -Y]) - distance
        seen = np.isfinite(distance)
        cut = (above > NOISE * np.maximum(1.0, 4.0 / np.sqrt(readings)))[seen]
        assert not cut.any()


def test_a_sole_of_any_size_gets_a_plane():
    """A sole of 40 mm's width has a plane as one of 137 mm has."""
    for size in (0.1, 0.3, 1.0):
        used, plane = np.zeros(len(X), dtype=np.uint8), np.zeros(3)
        x, y = size * X, size * Y
        distance = 0.01 + 0.05 * x - 0.03 * y
        assert highest_ground.highest_plane(x, y, distance, np.ones(len(X)), NOISE, LEAST, used, plane)
        assert plane == pytest.approx([0.01, -0.05, 0.03])
