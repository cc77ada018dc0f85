"""The kernel of the depth under a descending sole against the formulas in numpy, in both forms."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.gait import seen_depth

LEAST, HIGHEST, DEEP, SHARE = 4, 0.05, 0.04, 0.3


@pytest.mark.parametrize("seed", range(12))
def test_both_forms_are_the_formulas(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(4, 40))
    kernels = [m.SeenDepth(n, LEAST, HIGHEST, DEEP, SHARE) for m in (seen_depth, python_form("seen_depth"))]
    depth, looks = np.zeros(n), 0
    for k in range(30):
        if k == 20:
            depth, looks = np.zeros(n), 0
            for kernel in kernels:
                kernel.lift()
        distance = 0.08 - 0.004 * (k % 20) + rng.uniform(0.0, 0.06, n)
        distance[rng.random(n) < 0.1 * (k % 8)] = np.inf
        if k % 20 > 12:
            distance[rng.random(n) < 0.05] = rng.choice([np.nan, -np.inf])
        near = distance[np.isfinite(distance)]
        if len(near) >= LEAST:
            ground = np.sort(near)[: max(LEAST, len(near) // 3)].mean()
            if ground <= HIGHEST:
                looks += 1
                new = np.clip(distance - ground, -DEEP, DEEP)
                depth = np.where(distance > -np.inf, depth + (SHARE if looks > 1 else 1.0) * (new - depth), np.nan)
        for kernel in kernels:
            kernel.look(distance)
            assert kernel.looks == looks
            np.testing.assert_allclose(np.asarray(kernel.depth), depth, rtol=0, atol=1e-14)


@pytest.mark.parametrize("module", [seen_depth, python_form("seen_depth")])
def test_deep_ground_shows(module):
    kernel = module.SeenDepth(8, LEAST, HIGHEST, DEEP, SHARE)
    distance = np.full(8, 0.01)
    kernel.look(distance)
    assert not kernel.shows(0.005)
    distance[3:5] = 0.01 + DEEP, np.nan
    kernel.look(distance)
    assert kernel.shows(0.9 * SHARE * DEEP)
    assert not kernel.shows(1.1 * SHARE * DEEP)
