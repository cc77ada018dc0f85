import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError
from plantar.mechanics.wrench import wrench_at
from plantar.mechanics.zmp import zmp_in_plane, zmp_of_feet
from plantar.sensing.force import center_of_pressure, ground_reaction_wrench

seeds = st.integers(0, 2**32 - 1)


def random_force(seed: int, n: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.where(rng.random(n) < 0.3, 0.0, rng.uniform(0.0, 50.0, n))


@given(seeds, seeds)
def test_cop_is_where_the_vertical_forces_have_no_tipping_moment(tilted_sole, layout_seed, force_seed):
    layout = tilted_sole(layout_seed)
    force = random_force(force_seed, len(layout))
    vertical = np.array([(rotation @ [0, 0, f])[2] for rotation, f in zip(layout.rotations, force, strict=True)])
    cop = center_of_pressure(layout, force, 0.0)
    if vertical.sum() == 0.0:
        assert cop is None
        return
    moment = sum(np.cross([*(r[:2] - cop), 0.0], [0, 0, f]) for r, f in zip(layout.positions, vertical, strict=True))
    assert np.abs(moment).max() < 1e-10
    low, high = layout.positions[:, :2].min(axis=0), layout.positions[:, :2].max(axis=0)
    assert (cop >= low - 1e-12).all()
    assert (cop <= high + 1e-12).all()


def test_cop_of_a_flat_sole_is_the_zmp_of_its_wrench(sole):
    force = random_force(3, len(sole))
    assert center_of_pressure(sole, force) == pytest.approx(zmp_in_plane(ground_reaction_wrench(sole, force)))


@given(st.floats(1e-6, 10.0), seeds)
def test_cop_does_not_depend_on_the_unit_of_force(tilted_sole, factor, seed):
    layout = tilted_sole(0)
    force = random_force(seed, len(layout)) + 1.0
    scaled = center_of_pressure(layout, force * factor, 0.0)
    assert scaled == pytest.approx(center_of_pressure(layout, force, 0.0), abs=1e-12)


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan])
def test_no_load_has_no_cop(sole, value):
    assert center_of_pressure(sole, np.full(len(sole), value)) is None


def test_wrench_at_leaves_its_input_alone():
    wrench = np.arange(6.0)
    wrench_at(wrench, np.ones(3))
    assert wrench.tolist() == [0, 1, 2, 3, 4, 5]


def test_zmp_of_feet_in_the_air():
    assert zmp_of_feet([None, None], [0.0, 0.0]) is None
    assert zmp_of_feet([np.array([0.1, 0.2]), None], [10.0, -300.0]).tolist() == [0.1, 0.2]
    with pytest.raises(InputError, match="carries 300 N and has no point"):
        zmp_of_feet([None, np.array([0.1, 0.2])], [300.0, 100.0])
    assert zmp_of_feet([], []) is None


def test_a_wrench_that_is_not_known_has_no_zmp():
    assert zmp_in_plane([0, 0, np.inf, 0, 0, 0]) is None
    assert zmp_in_plane(np.zeros(6), minimum_force=0.0) is None
    moved = wrench_at([[np.inf, 0, 0, 0, 0, 0], [0, 0, 1.0, 0, 0, 0]], [0.0, 1.0, 0.0])
    assert moved[1].tolist() == [0, 0, 1.0, -1.0, 0, 0]
    assert not np.isfinite(moved[0]).all()


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: zmp_of_feet([None], [1.0, 2.0]), "1 points and 2 vertical forces"),
        (lambda: zmp_of_feet([[0.0, 0.0]], [np.inf]), "not finite"),
        (lambda: zmp_of_feet(None, [1.0]), "points is None"),
        (lambda: zmp_of_feet([None], "a"), "vertical force is 'a'"),
    ],
)
def test_wrong_arguments_are_refused_by_name(call, text):
    with pytest.raises(InputError, match=text):
        call()
