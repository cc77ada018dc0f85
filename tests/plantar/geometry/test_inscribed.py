import math
import re
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout
from plantar.errors import InputError
from plantar.geometry.enclosing import bounding_box
from plantar.geometry.inscribed import (
    inscribed_circle,
    inscribed_parallelogram,
    inscribed_rectangle,
    inscribed_rectangle_any_angle,
    inscribed_triangle,
    rectangle_in_outline,
    safe_rectangle,
)
from plantar.geometry.outline import Outline, concave_outline
from plantar.geometry.polygon import area, closest_point, convex_hull, inner_offset, signed_margin
from plantar.kernels import compiled
from plantar.layouts.hex_lattice import HexLattice

from ...examples import examples
from ..references import outline_rectangle_area, parallelogram_area, rectangle_area

seeds = st.integers(0, 2**32 - 1)
CONVEX = [inscribed_triangle, inscribed_parallelogram, inscribed_rectangle, inscribed_rectangle_any_angle]


def random_hull(seed):
    """A convex polygon: of random points, of an ellipse, or of a patch of hexagons with many parallel edges."""
    rng = np.random.default_rng(seed)
    kind = seed % 3
    if kind == 0:
        axial = rng.integers(-3, 4, (int(rng.integers(1, 12)), 2))
        lattice = HexLattice(691e-6, (0.0, 0.0), [0.0, 0.5, math.pi / 6][seed % 9 // 3])
        return convex_hull(lattice.corners(axial).reshape(-1, 2))
    if kind == 1:
        return convex_hull(rng.normal(0.0, 0.1, (int(rng.integers(3, 14)), 2)) * [1.0, rng.uniform(0.05, 1.0)])
    t = np.sort(rng.uniform(0.0, 2 * math.pi, int(rng.integers(3, 30))))
    return convex_hull(np.column_stack([0.12 * np.cos(t), 0.06 * np.sin(t)]))


def half_planes(polygon):
    """Inward unit normals (k, 2) and levels (k,) of the edges: inside where normal . p >= level."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    return normal, (normal * polygon).sum(axis=1)


def gap_outside(polygon, points):
    normal, level = half_planes(polygon)
    return max(0.0, -float((np.asarray(points) @ normal.T - level).min()))


# --- convex polygon -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [math.nan, math.inf, "steep", None])
def test_an_angle_that_is_none_is_refused(angle):
    square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    with pytest.raises(InputError, match="angle is"):
        inscribed_rectangle(square, angle)
    with pytest.raises(InputError, match="angle is"):
        rectangle_in_outline(Outline.of_rings([square]), angle)
    with pytest.raises(InputError, match="outline is a list; expected"):
        rectangle_in_outline(square)


def test_triangle_where_the_linear_walk_fails():
    """The polygon with which Keikha et al. 2017 (arXiv:1705.11035) refuted the walk in O(n)."""
    polygon = convex_hull([[1, 1000], [1250, 5], [2500, 30], [3000, 150], [1500, 1500], [400, 1350]])
    best = max(area(polygon[list(t)]) for t in combinations(range(len(polygon)), 3))
    assert area(inscribed_triangle(polygon)) == best


@examples(10)
@given(seeds)
def test_parallelogram_is_the_best_of_a_search(seed):
    hull = random_hull(seed)
    corners = inscribed_parallelogram(hull)
    assert area(corners) == pytest.approx(parallelogram_area(hull), rel=1e-9)
    assert gap_outside(hull, corners) < 1e-15
    assert np.allclose(corners[0] + corners[2], corners[1] + corners[3], atol=1e-15)


@pytest.mark.long
@examples(10)
@given(seeds)
def test_rectangle_is_the_best_of_a_search(seed):
    hull = random_hull(seed)
    corners = inscribed_rectangle(hull)
    assert gap_outside(hull, corners) < 1e-15
    assert area(corners) == pytest.approx(rectangle_area(hull), rel=1e-9)


@given(seeds)
def test_rectangle_of_the_transposed_polygon_is_the_same(seed):
    """x and y go different ways through the kernel, so that their agreement bounds the error: 1e-12."""
    hull = random_hull(seed)
    flipped = convex_hull(hull[:, ::-1])
    assert area(inscribed_rectangle(flipped)) == pytest.approx(area(inscribed_rectangle(hull)), rel=1e-12)


@examples(25 if compiled else 3)
@given(seeds)
def test_rectangle_at_any_angle_is_the_best_of_a_dense_scan(seed):
    hull = random_hull(seed)
    corners = inscribed_rectangle_any_angle(hull)
    assert gap_outside(hull, corners) < 1e-14
    best = max(area(inscribed_rectangle(hull, a)) for a in np.linspace(0.0, math.pi / 2, 300))
    assert area(corners) >= best * (1 - 1e-6)


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6])
@examples(20)
@given(seeds)
def test_rectangle_at_any_angle_of_a_needle(width, seed):
    """Its summits are as narrow as the needle is slim; the reference is a scan about its length, ever finer."""
    rng = np.random.default_rng(seed)
    needle = convex_hull(rng.uniform(0.0, 1.0, (int(rng.integers(3, 9)), 2)) * [1.0, width])
    angles = np.linspace(-3.0 * width, 3.0 * width, 121)
    best = 0.0
    for _ in range(6):
        areas = [area(inscribed_rectangle(needle, float(angle))) for angle in angles]
        best = max(best, *areas)
        step = angles[1] - angles[0]
        angles = angles[int(np.argmax(areas))] + step * np.linspace(-2.0, 2.0, 41)
    turn = rng.uniform(0.0, 1.5)
    turned = needle @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    for ring in (needle, turned):
        assert area(inscribed_rectangle_any_angle(ring)) >= best * (1.0 - 1e-6 - 1e-15 / width)


@given(seeds, st.floats(-4.0, 4.0))
def test_rectangle_at_an_angle_is_that_of_the_turned_polygon(seed, angle):
    hull = random_hull(seed)
    c, s = math.cos(angle), math.sin(angle)
    turned = hull @ np.array([[c, -s], [s, c]])
    assert area(inscribed_rectangle(hull, angle)) == pytest.approx(area(inscribed_rectangle(turned)), rel=1e-11)


@pytest.mark.parametrize("shape", CONVEX)
def test_degenerate_polygons_have_defined_shapes(shape):
    corners = 3 if shape is inscribed_triangle else 4
    assert shape([]).shape == (0, 2)
    assert shape([[1.0, 2.0]] * 3).tolist() == [[1.0, 2.0]] * corners
    line = shape([[0.0, 0.0], [1.0, 1.0], [0.5, 0.5], [0.2, 0.2]])
    assert line.shape == (corners, 2)
    assert area(line) == 0.0
    assert np.isfinite(line).all()
    assert (line[:, 0] == line[:, 1]).all()


def test_circle_of_degenerate_polygons():
    assert inscribed_circle([]) is None
    assert inscribed_circle([[1.0, 2.0]]).radius == 0.0
    center, radius = inscribed_circle([[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]])
    assert (center.tolist(), radius) == ([0.5, 0.0], 0.0)


@given(st.lists(st.tuples(st.floats(), st.floats()), max_size=12))
def test_any_points_get_an_answer_or_one_error(points):
    """Not convex, not finite, crossing: one error of ours, else no NaN where the products of coordinates are finite."""
    given_points = np.array(points).reshape(-1, 2)
    calm = np.where(np.abs(given_points) > 1e9, 1e9, given_points)
    for shape in (*CONVEX, lambda p: np.array([*(inscribed_circle(p) or (np.zeros(2),))[0]])):
        try:
            corners = shape(calm)
        except InputError as error:
            assert re.search("not convex|not finite", str(error))  # noqa: PT017
        else:
            assert not np.isnan(corners).any()


def test_what_is_not_convex_is_refused():
    bend = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
    calls = [*CONVEX, inscribed_circle, lambda p: signed_margin(p, [1.5, 1.5])]
    for call in (*calls, lambda p: closest_point(p, [3.0, 3.0]), lambda p: inner_offset(p, 0.1)):
        with pytest.raises(InputError, match="not convex: 86 % of its hull"):
            call(bend)
    with pytest.raises(InputError, match="allowed: 0 or more"):
        inner_offset(bend[:3], -0.1)
    assert inner_offset([], 0.1).shape == (0, 2)


# --- concave outline ----------------------------------------------------------------------------------------------

SOLE = hex_layout([[-0.12, -0.06], [0.12, -0.06], [0.12, 0.06], [-0.12, 0.06]], cell_area=300e-6, angle=0.2)
UPRIGHT = hex_layout([[-0.12, -0.06], [0.12, -0.06], [0.12, 0.06], [-0.12, 0.06]], cell_area=400e-6, clip=False)


def random_contact(seed):
    rng = np.random.default_rng(seed)
    sole = (SOLE, UPRIGHT)[seed % 2]
    active = rng.random(len(sole)) < rng.uniform(0.3, 1.0)
    if seed % 3 == 0:
        centre = sole.positions[rng.integers(len(sole)), :2]
        active = np.hypot(*(sole.positions[:, :2] - centre).T) < rng.uniform(0.01, 0.1)
    active[rng.integers(len(sole))] = True
    return concave_outline(sole, active)


def as_shape(outline):
    return shapely.union_all([shapely.Polygon(part[0], part[1:]) for part in outline.islands])


@examples(8)
@given(seeds)
def test_rectangle_in_outline_is_no_smaller_than_a_search_finds(seed):
    outline = random_contact(seed)
    corners = rectangle_in_outline(outline)
    assert area(corners) >= outline_rectangle_area(outline.rings) * (1 - 1e-9)
    assert shapely.Polygon(corners).difference(as_shape(outline)).area <= 1e-12


@given(seeds)
def test_rectangle_in_outline_of_the_transposed_outline_is_the_same(seed):
    outline = random_contact(seed)
    flipped = Outline.of_rings([ring[::-1, ::-1] for ring in outline.rings])
    expected = area(rectangle_in_outline(outline))
    assert area(rectangle_in_outline(flipped)) == pytest.approx(expected, rel=1e-12)


def test_islands_that_share_an_edge_are_crossed():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    beside = square + np.array([1.0, 0.0])
    assert area(rectangle_in_outline(Outline.of_rings([square, beside]))) == 2.0


def test_rectangle_goes_round_a_hole():
    frame = Outline.of_rings([[[0, 0], [5, 0], [5, 5], [0, 5]], [[1, 1], [1, 3], [3, 3], [3, 1]]])
    assert rectangle_in_outline(frame).tolist() == [[0, 3], [5, 3], [5, 5], [0, 5]]


def test_empty_and_tiny_outlines_have_rectangles():
    assert rectangle_in_outline(Outline.of_rings([])).shape == (0, 2)
    far = np.array([[0.0, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.1]]) + 1e6
    assert area(rectangle_in_outline(Outline.of_rings([far]))) == pytest.approx(0.02, rel=1e-8)


# --- safe rectangle -----------------------------------------------------------------------------------------------


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
