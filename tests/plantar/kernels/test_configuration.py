"""The kernel of a configuration against rotations of scipy, and its compiled form against its source."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.joints import configuration

FORMS = (configuration, python_form("configuration"))
WAYS, SPEEDS, TURNS, RATES = (np.array(a) for a in ([0, 1, 2, 7, 12], [0, 1, 2, 6, 10], [3, 8], [3, 7]))


def moved(module, start, velocity):
    """Where a free body, a hinge, a ball and a slide are after one unit of time."""
    there = start.copy()
    module.Configuration(WAYS, SPEEDS, TURNS, RATES, there, velocity).move()
    return there


@pytest.mark.parametrize("seed", range(20))
def test_ways_add_and_quaternions_turn_in_their_own_frame(seed):
    rng = np.random.default_rng(seed)
    start, velocity = rng.normal(size=13), rng.normal(size=11) * 10.0 ** rng.integers(-17, 1)
    there = moved(configuration, start, velocity)
    assert np.array_equal(there[WAYS], start[WAYS] + velocity[SPEEDS])
    for place, rate in zip(TURNS, RATES, strict=True):
        before = Rotation.from_quat(start[place : place + 4], scalar_first=True)
        after = (before * Rotation.from_rotvec(velocity[rate : rate + 3])).as_quat(scalar_first=True)
        found = there[place : place + 4]
        np.testing.assert_allclose(found * np.sign(found @ after), after, atol=1e-14)
    assert np.array_equal(moved(FORMS[1], start, velocity), there)


@pytest.mark.parametrize("module", FORMS)
def test_a_quaternion_of_no_length_is_no_turn(module):
    there = moved(module, np.zeros(13), np.zeros(11))
    assert np.array_equal(there, np.isin(np.arange(13), TURNS).astype(float))
