import math

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError
from plantar.sensing.ground_plane import fit_ground_plane

seeds = st.integers(0, 2**32 - 1)


def distances_to(layout, height, slope):
    """Distance along each taxel's -z to the plane z = -height + slope . (x, y): one ray at a time."""
    out = []
    normal = np.array([-slope[0], -slope[1], 1.0])
    for r, rotation in zip(layout.positions, layout.rotations, strict=True):
        ray = -rotation[:, 2]
        out.append((-height - normal @ r) / (normal @ ray))
    return np.array(out)


@given(seeds, st.floats(0.0, 0.04), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
def test_a_plane_is_found_exactly_also_from_tilted_taxels(tilted_sole, seed, height, a, b):
    layout = tilted_sole(seed)
    plane = fit_ground_plane(layout, distances_to(layout, height, (a, b)), sensing_range=10.0)
    assert plane.height == pytest.approx(height, abs=1e-9)
    assert plane.slope == pytest.approx((a, b), abs=1e-8)
    assert plane.residual < 1e-9
    assert plane.directions == 2
    assert plane.inliers.all()
    normal = np.cross([1, 0, a], [0, 1, b])
    assert plane.normal == pytest.approx(normal / np.linalg.norm(normal), abs=1e-8)


@given(seeds)
def test_with_little_noise_it_is_the_least_squares_plane(sole, seed):
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(-0.1, 0.1, 2)
    distance = distances_to(sole, 0.03, (a, b)) + rng.normal(0, 5e-4, len(sole))
    distance[rng.random(len(sole)) < 0.2] = np.inf
    distance[rng.random(len(sole)) < 0.1] = np.nan
    plane = fit_ground_plane(sole, distance, sensing_range=0.06, tolerance=5e-3)
    seen = np.isfinite(distance)
    system = np.column_stack([np.ones(seen.sum()), sole.positions[seen, :2]])
    solution, *_ = scipy.linalg.lstsq(system, sole.positions[seen, 2] - distance[seen])
    assert [-plane.height, *plane.slope] == pytest.approx(solution, abs=1e-10)
    residual = system @ solution - (sole.positions[seen, 2] - distance[seen])
    assert plane.residual == pytest.approx(math.sqrt(np.mean(residual**2)), rel=1e-6)
    assert plane.inliers.tolist() == seen.tolist()


@given(seeds, st.floats(0.02, 0.35))
def test_outliers_do_not_move_the_plane(sole, seed, share):
    rng = np.random.default_rng(seed)
    slope = rng.uniform(-0.1, 0.1, 2)
    distance = distances_to(sole, 0.03, slope) + rng.normal(0, 3e-4, len(sole))
    wrong = rng.permutation(len(sole)) < share * len(sole)
    distance[wrong] -= rng.uniform(0.01, 0.025, wrong.sum())  # something lies on the ground there
    plane = fit_ground_plane(sole, distance, sensing_range=0.1)
    assert plane.height == pytest.approx(0.03, abs=6e-4)
    assert plane.slope == pytest.approx(slope, abs=0.01)
    assert not (plane.inliers & wrong).any()
    assert plane.inliers[~wrong].all()
    plain = scipy.linalg.lstsq(
        np.column_stack([np.ones(len(sole)), sole.positions[:, :2]]), sole.positions[:, 2] - distance
    )[0]
    assert abs(plane.height - 0.03) < abs(-plain[0] - 0.03)


def test_a_kerb_under_the_toes_leaves_the_ground_of_the_heel(sole):
    kerb = sole.positions[:, 0] > 0.06
    plane = fit_ground_plane(sole, np.where(kerb, 0.01, 0.04), sensing_range=0.05)
    assert plane.height == pytest.approx(0.04)
    assert plane.slope == pytest.approx((0, 0), abs=1e-9)
    assert plane.inliers.tolist() == (~kerb).tolist()


def test_the_same_reading_gives_the_same_plane(sole):
    distance = np.random.default_rng(0).uniform(0.0, 0.05, len(sole))
    one, other = fit_ground_plane(sole, distance), fit_ground_plane(sole, distance)
    assert one.height == other.height
    assert one.slope == other.slope


def test_few_taxels_give_what_they_can(sole):
    distance = np.full(len(sole), np.inf)
    assert fit_ground_plane(sole, distance) is None
    assert fit_ground_plane(sole, np.full(len(sole), np.nan)) is None
    assert fit_ground_plane(sole, np.full(len(sole), sole.proximity_range)) is None
    distance[5] = 0.02
    plane = fit_ground_plane(sole, distance)
    assert (plane.height, plane.slope, plane.residual, plane.directions) == (0.02, (0.0, 0.0), 0.0, 0)
    # Two taxels, and all in a row: the slope along the row, level across it.
    row = np.flatnonzero(np.abs(sole.positions[:, 1] - np.median(sole.positions[:, 1])) < 1e-6)
    assert len(row) >= 4
    for taxels in (row[:2], row):
        distance = np.full(len(sole), np.inf)
        distance[taxels] = 0.03 - 0.1 * sole.positions[taxels, 0]
        plane = fit_ground_plane(sole, distance)
        assert plane.directions == 1
        assert plane.slope == pytest.approx((0.1, 0.0), abs=1e-9)
        assert _height(plane, sole.positions[taxels]) == pytest.approx(distance[taxels])
    three = [row[0], row[1], int(np.argmax(sole.positions[:, 1]))]
    distance = np.full(len(sole), np.inf)
    distance[three] = [0.01, 0.02, 0.04]
    plane = fit_ground_plane(sole, distance)
    assert plane.directions == 2
    assert _height(plane, sole.positions[three]) == pytest.approx(distance[three])


def _height(plane, places):
    return plane.height - places[:, :2] @ np.array(plane.slope)


@given(seeds)
def test_any_reading_gives_a_finite_plane_or_none(sole, seed):
    rng = np.random.default_rng(seed)
    distance = rng.choice([np.nan, np.inf, -np.inf, 0.0, -0.01, 0.049, 0.02, 1e-12], len(sole))
    distance[rng.random(len(sole)) < rng.random()] = np.inf
    plane = fit_ground_plane(sole, distance)
    if plane is None:
        assert not ((distance < 0.05) & (distance > -np.inf)).any()
    else:
        assert np.isfinite([plane.height, *plane.slope, plane.residual, *plane.normal]).all()
        assert not (plane.inliers & ~(np.abs(distance) < 0.05)).any()


def test_bad_arguments_are_refused(sole):
    with pytest.raises(InputError, match="tolerance"):
        fit_ground_plane(sole, np.zeros(len(sole)), tolerance=0.0)
    for reach in (0.0, math.nan, math.inf):
        with pytest.raises(InputError, match="sensing range"):
            fit_ground_plane(sole, np.zeros(len(sole)), sensing_range=reach)


def test_a_reading_below_minus_the_range_is_no_distance(sole):
    assert fit_ground_plane(sole, np.full(len(sole), -1e300)) is None
    distance = np.full(len(sole), 0.02)
    distance[0] = -1.0
    assert fit_ground_plane(sole, distance).height == pytest.approx(0.02)
