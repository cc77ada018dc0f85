"""What taxels have carried: the compiled kernel, its source, and the formulas in numpy, to the same last bit."""

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.gait import carried_load

PYTHON = kernels.python_form("carried_load")


@pytest.mark.parametrize("seed", range(20))
def test_both_forms_are_the_formulas(seed):
    rng = np.random.default_rng(seed)
    n, k = int(rng.integers(1, 60)), int(rng.integers(1, 8))
    near = rng.integers(-1, n, (n, k)).astype(np.intp)
    total, mean, carried = rng.uniform(0.0, 50.0, n), rng.uniform(-1.0, 9.0, n), rng.random(n) < 0.1
    ours = [(module, total.copy(), mean.copy(), carried.copy()) for module in (carried_load, PYTHON)]
    for _ in range(5):
        force = rng.uniform(-1.0, 20.0, n)
        force[rng.random(n) < 0.2] = rng.choice([np.nan, np.inf, -np.inf])
        forgetting, share, least, beside = rng.uniform(0.0, 1.0, 4)
        sound = np.where(np.isfinite(force), force, 0.0)
        total, mean = forgetting * total + sound, mean + share * (sound - mean)
        around = np.where(near >= 0, mean[near], 0.0).max(axis=1, initial=0.0)
        carried = carried | (mean > np.maximum(least, beside * around))
        for module, its_total, its_mean, its_mask in ours:
            module.take_in(force, forgetting, share, its_total, its_mean)
            module.mark_carried(its_mean, near, least, beside, its_mask)
            np.testing.assert_array_equal(its_total, total)
            np.testing.assert_array_equal(its_mean, mean)
            np.testing.assert_array_equal(its_mask, carried)
