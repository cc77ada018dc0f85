"""The kernel of the legs' targets in both forms: each argument comes to its array."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.joints import leg_targets


@pytest.mark.parametrize("module", [leg_targets, python_form("leg_targets")])
def test_each_target_comes_to_its_array(module):
    rng = np.random.default_rng(0)
    given = [rng.normal(size=shape) for shape in 3 * [3, (3, 3)]]
    given[5].flags.writeable = False
    com, torso, left, left_turn, right, right_turn = received = [np.zeros(a.shape) for a in given]
    kernel = module.LegTargets(com, torso, (left, left_turn), (right, right_turn))
    kernel.take(*given)
    for a, b in zip(received, given, strict=True):
        assert np.array_equal(a, b)
        assert not np.shares_memory(a, b)
    with pytest.raises(ValueError, match="contiguous"):
        kernel.take(*given[:3], given[3].T, *given[4:])


@pytest.mark.parametrize("module", [leg_targets, python_form("leg_targets")])
def test_it_copies_as_numpy_would(module):
    rng = np.random.default_rng(0)
    vector, places, entries = rng.normal(size=9), rng.permutation(9)[:5], np.zeros(5)
    kernel = module.JointEntries(vector, places, entries)
    for _ in range(2):
        vector[:] = rng.normal(size=9)
        kernel.take()
        assert np.array_equal(entries, vector[places])


@pytest.mark.parametrize("module", [leg_targets, python_form("leg_targets")])
def test_it_takes_a_command_and_reports_which_feet_carry_nothing(module):
    rng = np.random.default_rng(1)
    received = [np.zeros(shape) for shape in 3 * [3, (3, 3)]]
    com, torso, left, left_turn, right, right_turn = received
    kernel = module.LegTargets(com, torso, (left, left_turn), (right, right_turn))
    for lifted, heights in enumerate([(1.0, 1.0), (0.0, 1.0), (1.0, -1.0), (-2.0, 0.0)]):
        given = [rng.normal(size=shape) for shape in 3 * [3, (3, 3)]]
        feet = {
            side: SimpleNamespace(position=given[k], rotation=given[k + 1], force=np.array([9.0, 9.0, height]))
            for side, k, height in zip(("left", "right"), (2, 4), heights, strict=True)
        }
        command = SimpleNamespace(com=given[0], rotation_torso=given[1], feet=feet)
        assert kernel.follow(command) == lifted
        assert all(np.array_equal(a, b) for a, b in zip(received, given, strict=True))
    feet["left"].force = np.ones((3, 2))[:, 0]
    with pytest.raises(ValueError, match="contiguous"):
        kernel.follow(command)
