import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from plantar import InputError
from plantar.geometry.polygon import area, centroid, closest_point, convex_hull, inner_offset, signed_margin
from plantar.layouts.hex_lattice import HexLattice

from ..references import exact_hull

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
seeds = st.integers(0, 2**32 - 1)
coordinates = st.floats(-2.0, 2.0).map(lambda v: round(v, 12))  # squares of less than a picometre may underflow
points = st.tuples(coordinates, coordinates)


def cells_of_a_patch(seed: int) -> np.ndarray:
    """Axial coordinates of a random patch of lattice cells."""
    rng = np.random.default_rng(seed)
    axial = np.array([(q, r) for q in range(-4, 5) for r in range(-4, 5)])
    return axial[rng.random(len(axial)) < rng.uniform(0.05, 0.9)]


# --- hull ---------------------------------------------------------------------------------------------------------


@given(seeds, st.floats(0.0, math.pi), coordinates)
def test_hull_of_lattice_corners_keeps_true_corners_only(seed, angle, shift):
    """Whole rows of hexagon corners are collinear up to the last bit; the reference is the hull in exact integers."""
    axial = cells_of_a_patch(seed)
    assume(len(axial))
    lattice = HexLattice(691e-6, (shift, -shift), angle)
    keys = lattice.corner_keys(axial).reshape(-1, 2)
    expected = {tuple(k) for k in exact_hull(map(tuple, keys.tolist()))}
    corners = lattice.corners(axial).reshape(-1, 2)
    got = convex_hull(corners)
    key_of = {tuple(c): tuple(k) for c, k in zip(corners.tolist(), keys.tolist(), strict=True)}
    assert {key_of[tuple(p)] for p in got.tolist()} == expected
    assert len(got) == len(expected)


@pytest.mark.parametrize(
    ("cloud", "expected"),
    [
        ([], []),
        ([[1, 2]], [[1, 2]]),
        ([[1, 2], [1, 2], [1, 2]], [[1, 2]]),
        ([[1, 1], [0, 0], [0.5, 0.5], [0.25, 0.25]], [[0, 0], [1, 1]]),
        ([[0, 1], [0, 0], [0, 0.3]], [[0, 0], [0, 1]]),
        ([[0, 0], [5e-324, 0]], [[0, 0]]),
    ],
)
def test_hull_of_degenerate_points(cloud, expected):
    assert convex_hull(cloud).reshape(-1, 2).tolist() == expected


@given(seeds, st.sampled_from([5e-324, 1e-308, 1e-200, 1e-130, 1e-17]))
def test_hull_keeps_its_corners_beside_tiny_coordinates(seed, tiny):
    """Next to 0 comes 5e-324: products of such a difference are 0, and a turn made of them says nothing."""
    rng = np.random.default_rng(seed)
    between = np.column_stack([tiny * rng.integers(-3, 4, 4), rng.uniform(0.0, 1.0, 4)])
    cloud = np.concatenate([SQUARE, between, between[:, ::-1]])
    hull = convex_hull(cloud)
    assert area(hull) == pytest.approx(1.0, rel=1e-12)
    assert {(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)} <= {(round(x, 12), round(y, 12)) for x, y in hull.tolist()}


# --- area and centroid --------------------------------------------------------------------------------------------


def test_area_and_centroid_without_area():
    assert area(np.empty((0, 2))) == 0.0
    assert centroid(np.empty((0, 2))) is None
    assert area(SQUARE[:2]) == 0.0
    assert centroid(SQUARE[:1]).tolist() == [0.0, 0.0]
    assert centroid(SQUARE[:2]).tolist() == [0.5, 0.0]
    assert centroid(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]])).tolist() == [1.0, 1.0]


# --- closest point (T Algorithm 1) --------------------------------------------------------------------------------


def printed_algorithm_1(polygon, point):
    """T Algorithm 1 word for word: for each edge, outside if (d x l)_z > 0, then the closest point of that edge."""
    best, nearest = math.inf, np.asarray(point, dtype=float)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        edge, d = b - a, point - a
        if d[0] * edge[1] - d[1] * edge[0] > 0.0:
            t = np.clip(d @ edge / (edge @ edge), 0.0, 1.0)
            distance = float(np.hypot(*(point - (a + t * edge))))
            if distance < best:
                best, nearest = distance, a + t * edge
    return nearest


def test_algorithm_1_as_printed_moves_an_inside_point():
    """The erratum: on a clockwise square, as printed, the middle goes to an edge; counter-clockwise it stays."""
    middle = np.array([0.5, 0.5])
    clockwise = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])
    moved = printed_algorithm_1(clockwise, middle)
    assert np.hypot(*(moved - middle)) == 0.5
    assert moved.tolist() in [[0.0, 0.5], [0.5, 1.0], [1.0, 0.5], [0.5, 0.0]]
    assert closest_point(SQUARE, middle).tolist() == [0.5, 0.5]
    assert printed_algorithm_1(SQUARE, middle).tolist() == [0.5, 0.5]


@given(st.integers(1, 2), points)
def test_closest_point_of_a_point_and_a_segment(k, point):
    got = closest_point(SQUARE[:k], point)
    assert got == pytest.approx([min(max(point[0], 0.0), 1.0) if k == 2 else 0.0, 0.0], abs=1e-15)


def test_closest_point_of_nothing():
    assert closest_point(np.empty((0, 2)), [1.0, 2.0]) is None


# --- margin -------------------------------------------------------------------------------------------------------


def test_margin_without_area():
    assert signed_margin(np.empty((0, 2)), [0, 0]) == -math.inf
    assert signed_margin(SQUARE[:1], [3.0, 4.0]) == -5.0
    assert signed_margin(SQUARE[:2], [0.5, 0.25]) == -0.25
    assert signed_margin(SQUARE[:2], [0.5, 0.0]) == 0.0
    assert signed_margin(SQUARE, [0.5, 1.0]) == 0.0


# --- inner offset -------------------------------------------------------------------------------------------------


def test_inner_offset_of_a_sliver_far_away_is_not_turned_over():
    polygon = [
        [40008154.23239806, -39957629.36556947],
        [40016308.46479613, -39971752.91037965],
        [40040771.16199034, -39985876.455189824],
        [40057079.62678646, -39985876.455189824],
        [40065233.85918453, -39971752.91037965],
        [40032616.92959227, -39915258.731138945],
        [40016308.46479613, -39915258.731138945],
        [40008154.23239807, -39929382.27594912],
    ]
    got = inner_offset(polygon, 21185.317215263844)  # just less than the deepest point's depth
    corners = [tuple(map(Fraction, p)) for p in got.tolist()]
    assert len(corners) > 1
    assert sum(a * d - b * c for (a, b), (c, d) in zip([corners[-1], *corners], corners, strict=False)) >= 0


def test_inner_offset_without_area():
    assert inner_offset(np.empty((0, 2)), 0.1).shape == (0, 2)
    assert inner_offset(SQUARE, 0.0).tolist() == SQUARE.tolist()
    assert inner_offset(SQUARE[:2], 0.1).tolist() == [[0.5, 0.0]]
    assert inner_offset(SQUARE[:1], 0.1).tolist() == [[0.0, 0.0]]


def test_inner_offset_gives_a_copy():
    for distance in (0.0, 0.1):
        inner_offset(SQUARE, distance)[0] = 9.0
    assert SQUARE[0].tolist() == [0.0, 0.0]


# --- on a line and not finite -------------------------------------------------------------------


def test_a_tip_on_a_nearly_upright_side_is_kept():
    """Three corners in a column that differ by a rounding in x: the middle one may go, the ends may not."""
    for x in ([0.0, 1e-17, 2e-17], [2e-17, 0.0, 1e-17], [1e-17, 2e-17, 0.0]):
        cloud = np.array([[x[0], 0.0], [x[1], 1.0], [x[2], 0.5]])
        hull = convex_hull(cloud)
        assert sorted(hull[:, 1].tolist()) == [0.0, 1.0]


def test_a_point_or_distance_that_is_not_finite_has_a_defined_answer():
    for x in (math.nan, math.inf):
        assert np.isnan(closest_point(SQUARE, [x, 0.0])).all()
        assert math.isnan(signed_margin(SQUARE, [x, 0.0]))
    assert inner_offset(SQUARE, math.nan).tolist() == [[0.5, 0.5]]
    assert inner_offset(SQUARE, math.inf) == pytest.approx(np.array([[0.5, 0.5]]))


# --- what is no polygon --------------------------------------------------------------------------------------------


def test_a_point_is_checked_also_beside_an_empty_polygon():
    for function in (closest_point, signed_margin):
        for point in (np.zeros(3), [0.0], None, "ab"):
            for ring in ([], SQUARE):
                with pytest.raises(InputError, match="point"):
                    function(ring, point)
    with pytest.raises(InputError, match="distance is None"):
        inner_offset([], None)
