import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from plantar import InputError
from plantar.geometry.polygon import area, convex_hull, signed_margin
from plantar.sensing.proximity import cells_polygon, height_contours, near_taxels, preemptive_polygon, proximity_measure

anything = st.one_of(st.floats(-0.01, 0.1), st.sampled_from([math.nan, math.inf, -math.inf]))
distances = hnp.arrays(float, hnp.array_shapes(min_dims=1, max_dims=2, min_side=0, max_side=8), elements=anything)


@given(distances, st.floats(1e-3, 0.2))
def test_the_measure_saturates_at_both_ends_and_is_never_nan(distance, reach):
    rho = proximity_measure(distance, reach)
    assert rho.shape == distance.shape
    for d, r in zip(distance.ravel(), rho.ravel(), strict=True):
        expected = 0.0 if math.isnan(d) or d >= reach else reach if d <= 0.0 else reach - d
        assert r == expected


@pytest.mark.parametrize("reach", [0.0, -1.0, math.nan, math.inf])
def test_a_range_must_be_finite_and_above_0(reach):
    with pytest.raises(InputError, match="sensing range"):
        proximity_measure([0.01], reach)


def test_near_taxels_are_the_ones_over_high_ground_not_as_printed(sole):
    """Printed, T 4.2.7 takes d > eps: on a board under the toes that is the sole but for the board."""
    over_board = sole.positions[:, 0] > 0.05
    distance = np.where(over_board, 0.01, 0.04)
    near = near_taxels(distance, 0.02)
    assert near.tolist() == over_board.tolist()
    assert near.tolist() != (distance > 0.02).tolist()
    polygon = preemptive_polygon(sole, distance, 0.02)
    assert area(polygon) == pytest.approx(area(cells_polygon(sole, over_board)))
    assert (polygon[:, 0] > 0.03).all()
    assert not near_taxels([np.nan, np.inf], 0.02).any()


@given(st.integers(0, 2**32 - 1))
def test_a_polygon_of_cells_is_the_hull_of_their_corners(sole, seed):
    rng = np.random.default_rng(seed)
    chosen = rng.random(len(sole)) < rng.random()
    corners = [sole.cell_polygon(i) for i in np.flatnonzero(chosen)]
    expected = convex_hull(np.concatenate(corners)) if corners else np.empty((0, 2))
    got = cells_polygon(sole, chosen)
    assert area(got) == pytest.approx(area(expected), rel=1e-12)
    assert all(signed_margin(got, p) > -1e-9 for ring in corners for p in ring)


@given(st.integers(0, 2**32 - 1))
def test_contours_are_nested_and_each_is_the_polygon_of_its_height(sole, seed):
    rng = np.random.default_rng(seed)
    distance = rng.uniform(-0.005, 0.06, len(sole))
    distance[rng.random(len(sole)) < 0.2] = np.inf
    distance[rng.random(len(sole)) < 0.1] = np.nan
    heights = [*rng.uniform(0.0, 0.05, 4).tolist(), 0.02, 0.02]
    stack = height_contours(sole, distance, heights)
    assert [c.height for c in stack] == sorted(heights)
    for lower, upper in itertools.pairwise(stack):
        assert not (lower.taxels & ~upper.taxels).any()
        assert area(lower.polygon_in_sole) <= area(upper.polygon_in_sole) * (1 + 1e-9)
    for contour in stack:
        assert contour.taxels.tolist() == [bool(d < contour.height) for d in distance]
        np.testing.assert_array_equal(contour.polygon_in_sole, preemptive_polygon(sole, distance, contour.height))


def test_nothing_in_range_has_empty_polygons(sole):
    nothing = np.full(len(sole), np.inf)
    assert preemptive_polygon(sole, nothing, 0.05).shape == (0, 2)
    assert [len(c.polygon_in_sole) for c in height_contours(sole, nothing, [0.01, 0.05])] == [0, 0]
    assert height_contours(sole, nothing, []) == ()


def test_bad_arguments_are_refused(sole):
    with pytest.raises(InputError, match="NaN"):
        height_contours(sole, np.zeros(len(sole)), [math.nan])
