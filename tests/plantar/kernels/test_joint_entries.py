"""The kernel of joints' entries in both forms against numpy's indexing."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.kernels import joint_entries, python_form


@pytest.mark.parametrize("module", [joint_entries, python_form("joint_entries")])
def test_it_subtracts_and_copies_as_numpy_would(module):
    rng = np.random.default_rng(0)
    vector, places, entries = rng.normal(size=9), rng.permutation(9)[:5], np.zeros(5)
    kernel, share = module.JointEntries(vector, places, entries), rng.normal(size=9)
    wanted = vector - share
    kernel.less(share)
    assert np.array_equal(vector, wanted)
    assert not entries.any()
    kernel.take()
    assert np.array_equal(entries, wanted[places])
