import numpy as np
import pytest

from plantar.errors import InputError, ReadingError
from plantar.layouts.taxel_values import taxel_frames, taxel_mask, taxel_values, without_dead


@pytest.mark.parametrize("layout", [None, "sole", 3, np.zeros(3)])
@pytest.mark.parametrize("take", [taxel_values, taxel_frames, taxel_mask])
def test_a_layout_is_one(take, layout):
    with pytest.raises(InputError, match=r"^layout is .*; expected a SoleLayout$"):
        take(layout, np.zeros(3))


def test_values_fit_the_layout(sole):
    n = len(sole)
    good = np.zeros(n)
    assert taxel_values(sole, good) is taxel_frames(sole, good) is good
    assert taxel_frames(sole, np.zeros((0, n))).shape == (0, n)
    for take in (taxel_values, taxel_frames, taxel_mask):
        with pytest.raises(ReadingError, match=f"^distances: shape .*; layout 'test sole' has {n} taxels$"):
            take(sole, np.zeros(n + 1, dtype=bool), "distances")


def test_dead_taxels_carry_nothing():
    sound = np.array([1.0, -2.0])
    assert without_dead(sound) is sound
    assert without_dead(np.array([[1.0, np.nan], [-np.inf, 1e300]])).tolist() == [[1.0, 0.0], [0.0, 0.0]]


def test_a_mask_may_be_of_zeros_and_ones(sole):
    given = np.arange(len(sole)) % 2
    assert taxel_mask(sole, given).tolist() == taxel_mask(sole, given.astype(bool)).tolist() == (given == 1).tolist()
