"""Surfaces of many triangles: what they cover, whether they are closed, and their hull, against shapely's own."""

import time

import numpy as np
import pytest
import shapely

from plantar.errors import FootError
from plantar.shoes import build_shoe
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.geometry.outline import outline_below
from plantar.shoes.geometry.surface import convex_outline, corner_numbers, covered_area, is_closed, primitive
from plantar.shoes.solid.polyhedron import volume_of

from ..foot_family import FAMILY, rounded, turned


def united(flat):
    """The union of triangles, one by one; those without an area left out."""
    cells = shapely.polygons(np.concatenate([flat, flat[:, :1]], axis=1))
    return shapely.union_all(cells[shapely.area(cells) > 1e-6])


@pytest.mark.parametrize("seed", range(4))
def test_triangles_that_do_not_join_cover_their_union(seed):
    flat = np.random.default_rng(seed).uniform(-50.0, 50.0, (14, 3, 2)).round(3)
    covered = covered_area(flat)
    assert covered.is_valid
    assert covered.symmetric_difference(united(flat)).area < 0.1  # crossings lie on the grid


@pytest.mark.parametrize("name", ["split", "pitched", "concave", "toe_out"])
def test_a_surface_covers_the_union_of_its_triangles(name):
    flat = turned(FAMILY[name](), 3.0, -5.0, 20.0)[..., :2]
    assert covered_area(flat).symmetric_difference(united(flat.round(3))).area < 0.5


def test_what_covers_nothing_is_empty():
    upright = np.array([[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]])
    assert covered_area(upright).is_empty
    assert covered_area(np.empty((0, 3, 2))).is_empty


def test_a_hole_stays_and_twice_covered_counts_once():
    ring = [[(0, 0), (9, 0), (3, 3)], [(9, 0), (9, 9), (6, 3)], [(9, 9), (0, 9), (6, 6)], [(0, 9), (0, 0), (3, 6)]]
    ring += [[(9, 0), (6, 3), (3, 3)], [(9, 9), (6, 6), (6, 3)], [(0, 9), (3, 6), (6, 6)], [(0, 0), (3, 3), (3, 6)]]
    flat = np.array(ring, dtype=float)
    assert covered_area(flat).equals(shapely.box(0, 0, 9, 9) - shapely.box(3, 3, 6, 6))
    assert covered_area(np.concatenate([flat, flat[:, ::-1]])).area == pytest.approx(72.0)


def test_a_crowd_of_triangles_is_refused():
    crowd = np.random.default_rng(0).uniform(-50.0, 50.0, (30_000, 3, 2))
    with pytest.raises(FootError, match="overlap without joining"):
        covered_area(crowd)


def test_the_hull_of_many_points_is_that_of_all():
    points = np.random.default_rng(0).normal(size=(20_000, 2)) * [50.0, 20.0]
    assert convex_outline(points).equals(shapely.MultiPoint(points).convex_hull)
    assert convex_outline(np.repeat([[1.0, 2.0]], 3000, axis=0)).geom_type == "Point"


def test_corners_of_one_place_have_one_number():
    points = np.random.default_rng(0).uniform(-2e5, 2e5, (500, 3))
    numbers = corner_numbers(np.concatenate([points, points[::-1]]))
    np.testing.assert_array_equal(numbers[:500], numbers[:499:-1])
    assert len(set(numbers.tolist())) == 500


def test_a_surface_with_a_triangle_less_is_not_closed():
    surface = FAMILY["toe_out"]()
    assert is_closed(surface)
    assert not is_closed(surface[1:])


def test_a_fine_mesh_gives_the_outline_of_a_coarse_one():
    fine, coarse = rounded(1280, 6), rounded(320, 6)
    for height in (2.0, 12.0):
        assert outline_below(fine, height).symmetric_difference(outline_below(coarse, height)).area < 20.0


@pytest.mark.long
def test_a_million_triangles_take_seconds():
    surface = rounded(1250, 200)
    start = time.process_time()
    foot = foot_from_triangles("fine", surface, where="fine")
    build = build_shoe(foot, layout_only=True)
    assert time.process_time() - start < 20.0
    assert len(surface) == 1_000_000
    assert len(build.shoes[0].layout) > 20


@pytest.mark.parametrize(
    ("kind", "size", "half", "volume"),
    [
        ("box", [1.0, 2.0, 3.0], [1.0, 2.0, 3.0], 48.0),
        ("sphere", [2.0], [2.0, 2.0, 2.0], 4 / 3 * np.pi * 8),
        ("cylinder", [2.0, 3.0], [2.0, 2.0, 3.0], np.pi * 4 * 6),
        ("capsule", [2.0, 3.0], [2.0, 2.0, 5.0], np.pi * 4 * 6 + 4 / 3 * np.pi * 8),
        ("ellipsoid", [1.0, 2.0, 3.0], [1.0, 2.0, 3.0], 4 / 3 * np.pi * 6),
    ],
)
def test_shapes_have_their_size(kind, size, half, volume):
    triangles = primitive(kind, np.array(size), "g")
    points = triangles.reshape(-1, 3)
    np.testing.assert_allclose(points.max(axis=0), half, rtol=1e-2)
    np.testing.assert_allclose(points.min(axis=0), -np.array(half), rtol=1e-2)
    assert volume_of(triangles) == pytest.approx(volume, rel=0.03)


def test_what_is_no_shape_is_refused():
    for kind, size in (("torus", [1.0, 1.0]), ("box", [1.0, 1.0]), ("sphere", [0.0]), ("capsule", [1.0, np.nan])):
        with pytest.raises(FootError, match=r"^g: "):
            primitive(kind, np.array(size), "g")
