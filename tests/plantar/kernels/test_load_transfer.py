"""The kernel of the load transfer in both forms against numpy."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.gait import load_transfer

FORMS = (load_transfer, python_form("load_transfer"))
MASS, GRAVITY = 60.0, 9.81


def foot_at(rng, y):
    rotation = np.ascontiguousarray(Rotation.from_rotvec(rng.normal(0.0, 0.3, 3)).as_matrix())
    return SimpleNamespace(
        position=np.array([0.0, y, 0.0]) + rng.normal(0.0, 0.02, 3), rotation=rotation, center=rng.normal(0.0, 0.02, 2)
    )


@pytest.mark.parametrize("stance", [0, 1, 2])
@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_shares_are_those_of_the_projected_zmp(stance, seed):
    rng = np.random.default_rng(seed)
    feet = [foot_at(rng, 0.1), foot_at(rng, -0.1)]
    zmp, acceleration = rng.normal(0.0, 0.15, 2), rng.normal(size=2)
    found, other = (module.shared_load(zmp, acceleration, MASS, GRAVITY, *feet, stance) for module in FORMS)
    for one, two in zip(found, other, strict=True):
        np.testing.assert_array_equal(one, two)
    places = [foot.position[:2] + foot.rotation[:2, :2] @ foot.center for foot in feet]
    way = places[0] - places[1]
    share = (None, 1.0, 0.0)[stance]
    if share is None:
        share = float(np.clip((zmp - places[1]) @ way / (way @ way), 0.0, 1.0))
    force = MASS * np.array([*acceleration, GRAVITY])
    beside = zmp - (share * places[0] + (1.0 - share) * places[1])
    expected = (share * force, places[0] + beside, (1.0 - share) * force, places[1] + beside)
    for one, wished in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, wished, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("module", FORMS)
def test_feet_that_are_loaded_at_one_point_carry_half_each(module):
    foot = foot_at(np.random.default_rng(0), 0.0)
    left, _, right, _ = module.shared_load(np.ones(2), np.zeros(2), MASS, GRAVITY, foot, foot, 0)
    assert left.tolist() == right.tolist() == [0.0, 0.0, 0.5 * MASS * GRAVITY]
