"""The kernel of joints' entries in both forms against numpy's indexing."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.joints import joint_entries


@pytest.mark.parametrize("module", [joint_entries, python_form("joint_entries")])
def test_it_copies_as_numpy_would(module):
    rng = np.random.default_rng(0)
    vector, places, entries = rng.normal(size=9), rng.permutation(9)[:5], np.zeros(5)
    kernel = module.JointEntries(vector, places, entries)
    for _ in range(2):
        vector[:] = rng.normal(size=9)
        kernel.take()
        assert np.array_equal(entries, vector[places])
