"""Results at once: every number is found, and a single one that is wrong is told."""

import numpy as np
import pytest

from plantar.geometry.outline import Outline

from .results import differing, not_finite, numbers

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_numbers_of_nested_results():
    value = (2.0, [SQUARE, None, (np.array([True]), 3)], Outline.of_rings([SQUARE]))
    assert sorted(numbers(value).tolist()) == sorted([2.0, *SQUARE.ravel().tolist(), *SQUARE.ravel().tolist()])
    assert numbers(None).shape == (0,)


@pytest.mark.parametrize("bad", [np.nan, np.inf, (1.0, [np.array([[np.nan]])])])
def test_one_result_that_is_not_finite_is_told(bad):
    assert not_finite([SQUARE, None, bad, 1.0]) == [False, False, True, False]


def test_one_unit_in_the_last_place_differs():
    other = SQUARE.copy()
    other[2, 1] = np.nextafter(1.0, 2.0)
    assert differing([SQUARE, SQUARE, None], [SQUARE, other, None]) == [False, True, False]


def test_shapes_and_none_differ():
    flat = SQUARE.reshape(-1)
    assert differing([SQUARE, None, SQUARE], [flat, SQUARE, None]) == [True, True, True]
    # The same numbers in another split.
    assert differing([SQUARE[:1], SQUARE[1:]], [SQUARE[:3], SQUARE[3:]]) == [True, True]


def test_nan_is_nan_only_where_asked():
    values = [np.array([np.nan, 1.0])]
    assert differing(values, values) == [True]
    assert differing(values, values, equal_nan=True) == [False]
