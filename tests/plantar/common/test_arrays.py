import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.common.arguments import LARGEST
from plantar.common.arrays import array, integers, is_finite, mask, numbers, own, read_only
from plantar.common.plane_points import plane_points
from plantar.errors import InputError, ReadingError
from plantar.kernels import python_form

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
ODD = {
    "text": ["1", "2"],
    "bytes": np.array([b"1", b"2"]),
    "None": None,
    "objects": [1.0, None],
    "complex": [1.0, 2j],
    "dates": np.array(["2020-01-01"], dtype="datetime64[D]"),
    "durations": np.array([1], dtype="timedelta64[s]"),
    "records": np.zeros(2, dtype=[("x", float), ("y", float)]),
    "ragged": [[1.0, 2.0], [3.0]],
    "masked": np.ma.masked_array([1.0, 2.0], mask=[False, True]),
    "rows that are masked": [np.ma.masked_array([1.0, 2.0], mask=[False, True])],
    "a set": {1.0, 2.0},
    "a generator": (x for x in (1.0, 2.0)),
    "too large for int64": [10**30],
}


@pytest.mark.parametrize("kind", ODD)
def test_what_is_no_array_of_numbers_is_refused_by_name(kind):
    with pytest.raises(ReadingError, match=r"^loads: (not|holds masked)") as caught:
        numbers(ODD[kind], "loads", ReadingError)
    assert "\n" not in str(caught.value)


class Table:
    """A table of another library."""

    def __array__(self, dtype=None, copy=None):
        return np.array(SQUARE, dtype=dtype)


SAME = {
    "lists": SQUARE,
    "tuples": tuple(map(tuple, SQUARE)),
    "integers": np.array(SQUARE),
    "bool": np.array(SQUARE, dtype=bool),
    "half": np.array(SQUARE, dtype=np.float16),
    "long": np.array(SQUARE, dtype=np.longdouble),
    "other bytes": np.array(SQUARE, dtype=">f8"),
    "Fortran": np.asfortranarray(np.array(SQUARE, dtype=float)),
    "strides": np.repeat(np.array(SQUARE, dtype=float), 3, axis=1)[:, ::3],
    "backwards": np.array(SQUARE[::-1], dtype=float)[::-1],
    "read-only": read_only(np.array(SQUARE, dtype=float)),
    "masked nowhere": np.ma.masked_array(SQUARE, mask=False),
    "matrix of another library": Table(),
}


@pytest.mark.parametrize("kind", SAME)
def test_every_form_of_numbers_is_the_same(kind):
    points = plane_points(SAME[kind])
    assert points.dtype == np.float64
    assert type(points) is np.ndarray
    assert points.tolist() == np.array(SQUARE, dtype=float).tolist()


def test_an_array_of_float64_is_not_copied_unless_it_is_kept():
    given = np.array(SQUARE, dtype=float)
    assert numbers(given, "x") is array(given, "x", ("k", 2)) is plane_points(given) is given
    kept = own(given)
    given[:] = 7.0
    assert kept.tolist() == np.array(SQUARE, dtype=float).tolist()
    with pytest.raises(ValueError, match="read-only"):
        kept[0] = 0.0


@pytest.mark.parametrize(("bad", "text"), [(np.nan, "not finite"), (np.inf, "not finite"), (1e101, "1e.101; allowed")])
@pytest.mark.parametrize("size", [1, 5000])
def test_points_are_finite_where_they_have_to_be(bad, text, size):
    points = np.zeros((size, 2))
    points[size // 2, 1] = bad
    with pytest.raises(InputError, match=text):
        plane_points(points)
    assert plane_points(points, finite=False) is points
    for form in (points, points.ravel(), points[None]):
        assert not is_finite(form)
        with pytest.raises(InputError, match=text):
            array(form, "x", (...,), finite=True)


@given(st.lists(st.floats(), max_size=20))
def test_finite_is_what_numpy_says_up_to_the_largest(values):
    given = np.array(values)
    right = bool((np.isfinite(given) & (np.abs(given) <= LARGEST)).all())
    assert is_finite(given) == is_finite(given[:, None]) == is_finite(given[None, None]) == right
    interpreted = python_form("limits")
    assert interpreted.values_within(given, LARGEST) == interpreted.points_within(given[:, None], LARGEST) == right


@pytest.mark.parametrize(
    ("shape", "wanted"),
    [
        ((3,), ("n",)),
        ((3, 2), ("k", 2)),
        ((2,), (..., 2)),
        ((4, 5, 2), (..., 2)),
        ((), (...,)),
        ((), ()),
        ((0, 6), (..., 6)),
    ],
)
def test_shapes_that_fit(shape, wanted):
    assert array(np.zeros(shape), "x", wanted).shape == shape


@pytest.mark.parametrize(
    ("shape", "wanted", "text"),
    [
        ((), ("n",), r"\(\); expected \(n,\)"),
        ((3, 2), ("n",), r"\(3, 2\); expected \(n,\)"),
        ((2, 3), (..., 2), r"\(2, 3\); expected \(..., 2\)"),
        ((), (..., 2), r"\(\); expected \(..., 2\)"),
        ((3,), (3, 3), r"\(3,\); expected \(3, 3\)"),
    ],
)
def test_shapes_that_do_not_fit_say_what_would(shape, wanted, text):
    with pytest.raises(InputError, match=f"^point: shape {text}$"):
        array(np.zeros(shape), "point", wanted)


@pytest.mark.parametrize(
    "value", [[0.5], [1.0], ["1"], [True], None, [10**30], np.array([2**63], dtype=np.uint64), [[0]]]
)
def test_arrays_of_whole_numbers(value):
    assert integers([1, 2], "ids", ("n",)).dtype == np.int64
    assert integers([], "cells", ("m", 2)).shape == (0, 2)
    with pytest.raises(InputError, match=r"^ids: (not|shape)"):
        integers(value, "ids", ("n",))


@pytest.mark.parametrize(
    "value", [[2, 0], [0.5, 1], [0.0, 1.0], ["", "a"], [None, True], [np.nan, 1.0], [[True, False]], True]
)
def test_masks_are_truth_values_and_no_indices(value):
    assert mask([0, 1], "mask", (2,)).tolist() == [False, True]
    with pytest.raises(InputError, match=r"^mask: (holds|shape)"):
        mask(value, "mask", (2,))


def test_closing_goes_into_tuples():
    inner, outer = np.zeros(2), np.zeros(2)
    assert read_only((outer, (inner, 3.0), None))[0] is outer
    assert not inner.flags.writeable
    assert not outer.flags.writeable


def test_names_ending_in_s_are_plurals():
    with pytest.raises(InputError, match=r"^forces: shape"):
        array([], "forces", (2,))
