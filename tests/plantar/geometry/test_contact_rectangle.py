import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.errors import InputError
from plantar.geometry.enclosing import bounding_box
from plantar.geometry.inscribed import inscribed_rectangle, safe_rectangle
from plantar.geometry.polygon import convex_hull

seeds = st.integers(0, 2**32 - 1)


@given(seeds, st.floats(0.0, 0.3), st.sampled_from(["inscribed", "bounding"]))
def test_sides_move_inwards_by_the_offset_or_meet(seed, offset, method):
    hull = convex_hull(np.random.default_rng(seed).normal(0.0, 0.1, (8, 2)))
    box = inscribed_rectangle(hull) if method == "inscribed" else bounding_box(hull)
    (x1, y1), (x2, y2) = safe_rectangle(hull, offset, method)[[0, 2]]
    for low, high, inner_low, inner_high in ((box[0, 0], box[2, 0], x1, x2), (box[0, 1], box[2, 1], y1, y2)):
        if high - low > 2 * offset:
            assert (inner_low - low, high - inner_high) == pytest.approx((offset, offset), abs=1e-15)
        else:
            assert inner_low == inner_high == 0.5 * (low + high)


def test_an_empty_polygon_has_no_rectangle():
    assert safe_rectangle([], 0.01).shape == (0, 2)
    assert safe_rectangle([], 0.01, "bounding").shape == (0, 2)


@pytest.mark.parametrize("offset", [-0.01, float("nan"), float("inf")])
def test_a_bad_offset_is_refused(offset):
    with pytest.raises(InputError, match="safety offset"):
        safe_rectangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], offset)


def test_a_bad_method_is_refused():
    with pytest.raises(InputError, match="allowed: inscribed, bounding"):
        safe_rectangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 0.01, "outer")
