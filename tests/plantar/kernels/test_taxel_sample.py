"""The kernel of a sample of taxels against numpy, in both forms."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from plantar.kernels import python_form, taxel_sample


@given(st.integers(0, 2**32 - 1))
def test_it_is_what_numpy_makes_of_them(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 60))
    force, noise = 30.0 * rng.random(n), rng.normal(size=n)
    force[rng.random(n) < 0.1] = np.nan
    dead = np.flatnonzero(rng.random(n) < 0.2)
    wanted = np.minimum(np.maximum(force + noise, 2.0), 20.0)
    wanted[dead] = np.nan
    for module in (taxel_sample, python_form("taxel_sample")):
        assert np.array_equal(module.taxel_sample(force, noise, 2.0, 20.0, dead), wanted, equal_nan=True)
