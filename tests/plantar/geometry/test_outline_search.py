"""The scan for the largest rectangle in an outline at any angle: its gap is true, and more looks give no less."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar import InputError, hex_layout
from plantar.geometry.inscribed import rectangle_in_outline, rectangle_in_outline_any_angle
from plantar.geometry.outline import Outline, concave_outline
from plantar.geometry.polygon import area

SOLE = hex_layout([[-0.1, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.1, 0.05]], cell_area=4e-4)


def random_outline(seed):
    rng = np.random.default_rng(seed)
    return concave_outline(SOLE, rng.random(len(SOLE)) < rng.uniform(0.3, 1.0))


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.sampled_from([60, 300]))
def test_no_other_angle_has_more_than_the_gap_allows(seed, looks):
    outline = random_outline(seed)
    corners, gap = rectangle_in_outline_any_angle(outline, looks)
    angles = np.random.default_rng(seed).uniform(0.0, np.pi, 60)
    best = max(area(rectangle_in_outline(outline, a)) for a in [0.0, *angles])
    assert best <= area(corners) * (1.0 + gap) * (1.0 + 1e-9)
    assert best <= area(corners) * 1.02  # and the refined scan is close whatever is proven


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1))
def test_more_looks_give_no_larger_gap(seed):
    outline = random_outline(seed)
    found = [rectangle_in_outline_any_angle(outline, looks) for looks in (40, 100, 400)]
    bounds = [area(corners) * (1.0 + gap) for corners, gap in found]
    assert bounds[0] >= bounds[1] * (1.0 - 1e-6) >= bounds[2] * (1.0 - 2e-6)


def test_the_corners_are_inside_and_no_less_than_along_the_axes():
    import shapely

    for seed in range(10):
        outline = random_outline(seed)
        corners, _ = rectangle_in_outline_any_angle(outline)
        shape = shapely.union_all([shapely.Polygon(i[0], i[1:]) for i in outline.islands]).buffer(1e-9)
        assert shape.covers(shapely.Polygon(corners))
        assert area(corners) >= area(rectangle_in_outline(outline)) * (1.0 - 1e-12)


@pytest.mark.parametrize("looks", [0, -1, 2.5, "much", None])
def test_looks_are_a_whole_number_above_0(looks):
    with pytest.raises(InputError, match="looks"):
        rectangle_in_outline_any_angle(Outline.of_rings([[[0, 0], [1, 0], [1, 1], [0, 1]]]), looks)
