"""Small arrays made of numbers, and what reaches into an array's memory: new arrays, in both forms, that own theirs."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.base import vectors
from plantar.kernels.mechanics import rotations

NUMBERS = [1.5, -0.0, np.nan, np.inf, 5e-324, -1e300, 0.1, 2.0, 3.0]


@pytest.mark.parametrize("form", [vectors, python_form("vectors")], ids=["as installed", "interpreted"])
def test_new_arrays_hold_the_numbers_and_nothing_else(form):
    for made, expected in (
        (form.vector2(*NUMBERS[:2]), np.array(NUMBERS[:2])),
        (form.vector(*NUMBERS[:3]), np.array(NUMBERS[:3])),
        (form.matrix(*NUMBERS), np.array(NUMBERS).reshape(3, 3)),
    ):
        assert type(made) is np.ndarray
        assert made.tobytes() == expected.tobytes()
        assert made.shape == expected.shape
        assert made.dtype == np.float64
        assert made.flags.owndata
        assert made.flags.writeable
        assert made.flags.c_contiguous
    many = [form.vector(k, 0.0, 0.0) for k in range(1000)]
    assert [v[0] for v in many] == list(range(1000))


@pytest.mark.parametrize("form", [vectors, python_form("vectors")], ids=["as installed", "interpreted"])
def test_a_kept_copy_is_nobody_elses_and_closed(form):
    for given in (np.array(NUMBERS), np.zeros(0), np.arange(102.0)):
        copy = form.kept(given)
        assert copy.tobytes() == given.tobytes()
        assert copy.flags.owndata
        assert not copy.flags.writeable
    for other in (np.arange(6.0)[::2], np.arange(3), np.eye(2), [1.0, 2.0], None, np.float64(3.0)):
        assert form.kept(other) is None


@pytest.mark.parametrize(
    "wrong",
    [
        np.zeros(3, dtype=np.float32),
        np.zeros(3, dtype=int),
        np.zeros(6)[::2],
        np.eye(3).T[:, ::2],
        [0.0, 0.0, 0.0],
        None,
    ],
    ids=["float32", "int", "every other", "columns", "a list", "nothing"],
)
def test_an_array_of_another_kind_is_refused_and_not_misread(wrong):
    memory = python_form("memory")
    for read in (memory.values, memory.room):
        with pytest.raises((ValueError, AttributeError)):
            read(wrong)


def test_what_may_not_be_written_is_not_written():
    kept = np.zeros((3, 3))
    kept.flags.writeable = False
    for module in (rotations, python_form("rotations")):
        with pytest.raises(ValueError, match=r"writ|read-only"):
            module.exponential(0.1, 0.2, 0.3, kept)
    assert not kept.any()
