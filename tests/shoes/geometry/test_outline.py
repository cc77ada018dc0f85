"""Tests of outlines: a sole's, of any number of patches."""

import numpy as np
import pytest
import shapely

from plantar.errors import FootError
from plantar.shoes.geometry.outline import (
    cut_below,
    flush,
    grown,
    joined_corners,
    outline_below,
    outlines_below,
    ring,
    rounded_rectangle,
    single_outline,
    tidy,
)
from plantar.shoes.geometry.surface import corner_numbers

from ..foot_family import rounded


def test_the_outline_of_a_box_is_its_rectangle(box):
    outline = outline_below(box((-50, 100), (-30, 40), (0, 60)), 5.0)
    assert outline.equals(shapely.box(-50, -30, 100, 40))
    assert outline.exterior.is_ccw


def test_two_patches_give_their_hull(box):
    patches = np.concatenate([box((-80, -20), (-30, 30), (0, 40)), box((60, 120), (-40, 40), (0, 40))])
    outline = outline_below(patches, 5.0)
    corners = [(-80, -30), (-80, 30), (60, 40), (120, 40), (120, -40), (60, -40)]
    assert outline.equals(shapely.MultiPoint(corners).convex_hull)


def test_a_groove_and_a_hole_are_bridged():
    area = shapely.box(-80, -40, 80, 40) - shapely.box(-5, -40, 5, 30) - shapely.Point(40, 0).buffer(6)
    outline = single_outline(area, area.convex_hull)
    assert outline.equals(shapely.box(-80, -40, 80, 40))


def test_a_marked_waist_is_kept(prism):
    angle = np.linspace(0, 2 * np.pi, 120, endpoint=False)
    x, y = 120 * np.cos(angle), 50 * np.sin(angle)
    waist = y * (1 - 0.6 * np.exp(-((x / 40) ** 2)))
    outline = outline_below(prism(np.column_stack([x, waist]), 0, 30), 5.0)
    shape = shapely.Polygon(np.column_stack([x, waist]))
    assert outline.symmetric_difference(shape).area < 0.02 * shape.area
    assert outline.area < 0.9 * outline.convex_hull.area


def test_only_what_lies_below_the_height_counts(box):
    wide_above = np.concatenate([box((-50, 50), (-20, 20), (0, 10)), box((-90, 90), (-60, 60), (10, 40))])
    assert outline_below(wide_above, 5.0).bounds == (-50, -20, 50, 20)
    assert outline_below(wide_above, 12.0).bounds == (-90, -60, 90, 60)


def test_a_wedge_is_cut_at_the_height():
    # A slope from z = 0 at x = 0 to z = 20 at x = 100: its lowest 5 mm end at x = 25.
    slope = np.array([[[0, 0, 0], [100, 0, 20], [100, 50, 20]], [[0, 0, 0], [100, 50, 20], [0, 50, 0]]], dtype=float)
    assert outline_below(slope, 5.0).bounds == pytest.approx((0, 0, 25, 50))
    cut = cut_below(slope, 5.0)
    area = 0.5 * np.linalg.norm(np.cross(cut[:, 1] - cut[:, 0], cut[:, 2] - cut[:, 0]), axis=1).sum()
    assert area == pytest.approx(np.hypot(25, 5) * 50)


def test_an_edge_is_no_sole():
    ridge = np.array([[[0, 0, 0], [100, 0, 0], [50, 0, 30]], [[0, 0, 0], [50, 0, 30], [100, 0, 0]]], dtype=float)
    with pytest.raises(FootError, match="no area"):
        outline_below(ridge, 5.0)
    with pytest.raises(FootError, match="no surface in its lowest 5 mm"):
        outline_below(ridge + np.array([0, 0, 50]), 5.0)


def test_tidy_takes_the_largest_part_without_holes():
    shape = shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(5, 5, 15, 15) - shapely.box(7, 7, 9, 9)])
    assert tidy(shape).equals(shapely.box(5, 5, 15, 15))
    assert len(ring(tidy(shape))) == 4
    with pytest.raises(FootError):
        tidy(shapely.Polygon())


@pytest.mark.parametrize("radius", [0.0, 10.0, 35.0, 50.0])
def test_a_rounded_rectangle_has_its_size_and_area(radius):
    shape = rounded_rectangle(200.0, 100.0, (20.0, -5.0), radius)
    assert shape.bounds == pytest.approx((-80, -55, 120, 45), abs=1e-3)
    assert shape.area == pytest.approx(200 * 100 - (4 - np.pi) * radius**2, rel=5e-3)


def test_a_fine_mesh_keeps_its_waist():
    x, y = np.meshgrid(np.linspace(-100, 100, 160), np.linspace(-1, 1, 80))
    grid = np.stack([x, y * 40 * (1 - 0.5 * np.exp(-((x / 30) ** 2))), np.zeros_like(x)], axis=-1)
    a, b, c, d = (s.reshape(-1, 3) for s in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    assert len(triangles) > 20_000
    shape = shapely.Polygon(np.concatenate([grid[0, :, :2], grid[-1, ::-1, :2]]))
    assert outline_below(triangles, 5.0).symmetric_difference(shape).area < 0.02 * shape.area


@pytest.mark.parametrize("seed", range(12))
def test_outlines_that_are_about_the_same_are_the_same(seed):
    # A rim and a face around it, a hair apart on the grid for most of their way, as bridging and rounding leave them.
    chance = np.random.default_rng(seed)
    angle = np.sort(chance.uniform(0.0, 2.0 * np.pi, 60))
    rim = tidy(shapely.Polygon(np.column_stack([110.0 * np.cos(angle), 50.0 * np.sin(angle)])).buffer(3.0))
    x, y = ring(rim)[chance.integers(len(ring(rim)))]
    face = tidy(rim.buffer(chance.uniform(0.0, 0.01)).union(shapely.Point(x, y).buffer(chance.uniform(4.0, 20.0), 2)))
    joined = flush(face, rim)
    assert joined.covers(rim.buffer(-1e-9))
    assert joined.symmetric_difference(face).area < 0.02 * rim.length
    own = set(map(tuple, ring(rim).tolist()))
    points = ring(joined)
    gaps = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    new = np.array([tuple(p) not in own for p in points.tolist()])
    assert (gaps[new | np.roll(new, -1)] > 0.019).all()
    beside = rim.exterior.distance(shapely.points(points[new]))
    assert ((beside < 1e-9) | (beside > 0.019)).all()


def test_outlines_of_a_rough_scan_are_those_of_all_its_triangles():
    triangles = rounded(140, 29)
    triangles[..., 1] *= 1.0 - 0.5 * np.exp(-(((triangles[..., 0] - 25.0) / 34.0) ** 2))
    corners = corner_numbers(triangles)
    rough = triangles + np.random.default_rng(1).normal(0.0, 0.05, (corners.max() + 1, 3))[corners]
    scan = rough[np.random.default_rng(2).random(len(rough)) > 0.004]  # with holes
    of_height = outlines_below(scan)
    for height in (3.0, 20.0):
        whole = outline_below(scan, height)
        assert whole.area < 0.9 * whole.convex_hull.area
        assert of_height(height).hausdorff_distance(whole) < 0.1
        assert abs(of_height(height).area - whole.area) < 1e-3 * whole.area
    with pytest.raises(FootError, match="no surface in its lowest"):
        of_height(-1.0)


@pytest.mark.parametrize("seed", range(8))
def test_grown_outlines_have_no_short_edges_and_keep_their_distance(seed):
    chance = np.random.default_rng(seed)
    angle = np.sort(chance.uniform(0.0, 2.0 * np.pi, 60))
    angle = np.concatenate([angle, angle[::6] + 1e-4])  # corners of some hundredths, as a tilted mesh's have
    angle = np.sort(angle)
    sole = tidy(shapely.Polygon(np.column_stack([110.0 * np.cos(angle), 45.0 * np.sin(angle)])).convex_hull)
    outline = grown(sole, 0.5)
    edges = ring(outline) - np.roll(ring(outline), 1, axis=0)
    assert np.hypot(*edges.T).min() > 0.2
    assert sole.distance(outline.exterior) > 0.45
    assert max(sole.distance(shapely.points(ring(outline)))) < 0.85


def test_corners_that_nearly_coincide_with_another_outlines_are_joined_with_them():
    outer = shapely.Polygon([(0, 0), (40, 0), (60, 3), (60, 30), (0, 30)])
    whisker = [(0, 0), (40, 0), (40.18, 0.027), (40.16, 0.06), (40.2, 0.1), (55, 20), (0, 20)]
    joined = joined_corners(shapely.Polygon(whisker), outer)
    assert ring(joined).tolist() == [[0, 0], [40, 0], [55, 20], [0, 20]]
