import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar.errors import InputError
from plantar.geometry.enclosing import bounding_box, enclosing_parallelogram, oriented_box
from plantar.geometry.polygon import area, convex_hull

seeds = st.integers(0, 2**32 - 1)


def random_hull(seed):
    rng = np.random.default_rng(seed)
    cloud = rng.normal(0.0, 0.1, (int(rng.integers(3, 40)), 2)) * [1.0, rng.uniform(0.02, 1.0)]
    return convex_hull(cloud + rng.normal(0.0, 2.0, 2))


@given(seeds)
def test_bounding_box_is_that_of_shapely(seed):
    hull = random_hull(seed)
    box = bounding_box(hull)
    assert (*box[0], *box[2]) == shapely.MultiPoint(hull).bounds
    assert (*box[1], *box[3]) == (box[2, 0], box[0, 1], box[0, 0], box[2, 1])


@given(seeds)
def test_boxes_have_right_angles_and_parallelograms_parallel_sides(seed):
    """That they hold the ring and are the least that do is tested in test_dirty_rings.py."""
    hull = random_hull(seed)
    sides = np.roll(box := oriented_box(hull), -1, axis=0) - box
    assert np.abs((sides * np.roll(sides, -1, axis=0)).sum(axis=1)).max() < 1e-15
    corners = enclosing_parallelogram(hull)
    assert np.allclose(corners[0] + corners[2], corners[1] + corners[3], atol=1e-13)


@pytest.mark.parametrize("shape", [bounding_box, oriented_box, enclosing_parallelogram])
def test_degenerate_points_have_defined_shapes(shape):
    assert shape([]).shape == (0, 2)
    with pytest.raises(InputError, match="not finite"):
        shape(np.full((3, 2), np.nan))
    assert shape([[1.0, 2.0]]).tolist() == [[1.0, 2.0]] * 4
    assert shape([[1.0, 2.0]] * 5).tolist() == [[1.0, 2.0]] * 4
    line = shape([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.25, 0.0]])
    assert line.shape == (4, 2)
    assert area(line) == 0.0
    assert sorted({tuple(p) for p in line.tolist()}) == [(0.0, 0.0), (1.0, 0.0)]
