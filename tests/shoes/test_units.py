"""Tests of the boundary between millimetres and metres."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from plantar.shoes.units import MM_PER_M, to_m, to_mm


@given(st.floats(-1e6, 1e6))
def test_there_and_back_is_the_same(length):
    assert abs(to_m(to_mm(length)) - length) <= 1e-9 * max(1.0, abs(length))
    assert to_mm(length) == length * MM_PER_M


def test_arrays_keep_their_shape():
    np.testing.assert_allclose(to_m(np.array([[250.0, 1.0]])), [[0.25, 0.001]])
