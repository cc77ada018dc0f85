import math

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


def gap_outside(corners, points):
    """How far points stand out of a convex counter-clockwise shape."""
    edge = np.roll(corners, -1, axis=0) - corners
    inward = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    return max(0.0, -float(((points[:, None] - corners) * inward).sum(axis=2).min()))


@given(seeds)
def test_bounding_box_is_that_of_shapely(seed):
    hull = random_hull(seed)
    box = bounding_box(hull)
    assert (*box[0], *box[2]) == shapely.MultiPoint(hull).bounds
    assert (*box[1], *box[3]) == (box[2, 0], box[0, 1], box[0, 0], box[2, 1])


@given(seeds)
def test_oriented_box_is_the_least_of_those_along_an_edge(seed):
    hull = random_hull(seed)
    directions = np.roll(hull, -1, axis=0) - hull
    directions /= np.hypot(*directions.T)[:, None]
    least = min(np.ptp(hull @ d) * np.ptp(hull @ [-d[1], d[0]]) for d in directions)
    box = oriented_box(hull)
    assert area(box) == pytest.approx(least, rel=1e-12)
    assert gap_outside(box, hull) < 1e-14
    sides = np.roll(box, -1, axis=0) - box
    assert np.abs((sides * np.roll(sides, -1, axis=0)).sum(axis=1)).max() < 1e-15


@given(seeds)
def test_enclosing_parallelogram_is_the_least_of_all_pairs_of_directions(seed):
    """No pair of directions out of a dense scan, of which the edges are a part, gives less."""
    hull = random_hull(seed)
    edges = np.roll(hull, -1, axis=0) - hull
    angles = np.concatenate([np.linspace(0.0, math.pi, 120), np.arctan2(edges[:, 1], edges[:, 0])])
    widths = np.ptp(hull @ np.array([-np.sin(angles), np.cos(angles)]), axis=0)
    turn = np.abs(np.sin(angles[:, None] - angles))
    least = (np.outer(widths, widths)[turn > 1e-9] / turn[turn > 1e-9]).min()
    corners = enclosing_parallelogram(hull)
    assert area(corners) == pytest.approx(least, rel=1e-11)
    assert gap_outside(corners, hull) < 1e-13
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


@given(seeds)
def test_direction_repeats_and_offset_change_nothing(seed):
    hull = random_hull(seed) - 2.0
    twice = np.repeat(hull, 2, axis=0)
    spoilt = np.vstack([hull, hull[:1]])
    for shape in (bounding_box, oriented_box, enclosing_parallelogram):
        expected = area(shape(hull))
        for variant in (hull[::-1], twice, spoilt, np.vstack([hull, hull[:1]])):
            assert area(shape(variant)) == pytest.approx(expected, rel=1e-12)
        far = shape(hull + 1e6)
        assert area(far) == pytest.approx(expected, rel=1e-5)  # 1e6 m leaves 1e-10 m of a coordinate
