"""Polygons as careless callers hand them over: any shape, size, place and kind of array, against exact fractions.

Whatever an array looks like, a function gives what it gives for the same numbers in a plain array, to the last bit,
leaves the array as it was, and that is right; or it raises one `InputError`.
"""

import math
import warnings
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import shapely

from plantar import InputError
from plantar.geometry import enclosing, inscribed, polygon
from plantar.percepts.sole_pose import feet_support_polygon

from ..references import exact_hull, inner_offset_area, turn

LEAVES_OUT = (polygon.convex_hull,)
"""Functions that leave out points that are not finite; the others refuse them."""

OF_POLYGON = (
    *LEAVES_OUT,
    enclosing.bounding_box,
    enclosing.oriented_box,
    enclosing.enclosing_parallelogram,
    inscribed.inscribed_triangle,
    inscribed.inscribed_parallelogram,
    inscribed.inscribed_circle,
    inscribed.inscribed_rectangle,
    inscribed.inscribed_rectangle_any_angle,
    polygon.area,
    polygon.centroid,
    lambda ring: polygon.closest_point(ring, (0.3, -0.2)),
    lambda ring: polygon.signed_margin(ring, [0.3, -0.2]),
    lambda ring: polygon.inner_offset(ring, 0.05),
    lambda ring: polygon.inner_offset(ring, 1e6),
    lambda ring: feet_support_polygon([ring, ring]),
)


def cloud(rng):
    """Points (n, 2): none, one, two, on a line, in one place, on a lattice, in general; tiny, huge, far away."""
    n = int(rng.integers(1, 30))
    around = np.sort(rng.uniform(0.0, 2.0 * math.pi, n))
    points = (
        np.empty((0, 2)),
        rng.normal(size=(1, 2)),
        rng.normal(size=(2, 2)),
        np.outer(rng.normal(size=n), (1.0, 0.3)),
        np.repeat(rng.normal(size=(1 + n // 3, 2)), 3, axis=0),
        np.tile(rng.normal(size=(1, 2)), (n, 1)),
        rng.integers(-3, 4, (n, 2)).astype(float),
        np.column_stack([np.cos(around), np.sin(around)]),
        rng.normal(size=(n, 2)),
    )[rng.integers(9)]
    points = points * 10.0 ** rng.choice([0, 0, 0, -3, -9, -90, 6, 90])
    return points + rng.normal(size=2) * 10.0 ** rng.choice([3, 6, 9]) if rng.random() < 0.3 else points


def dressed(points):
    """The same numbers as other arrays that a caller may hold; lists and what only turns into an array among them."""
    closed = points.copy()
    closed.setflags(write=False)
    wide = np.full((2 * len(points), 5), np.nan)
    wide[::2, 1:4:2] = points
    yield from (closed, wide[::2, 1:4:2], np.asfortranarray(points), points[::-1].copy()[::-1], points.astype(">f8"))
    packed = np.zeros(len(points), dtype=[("mark", "u1"), ("at", "<f8", (2,))])
    packed["at"] = points
    yield packed["at"]  # not aligned
    if len(points):
        yield from (points.tolist(), [tuple(p) for p in points.tolist()])
        yield Held(points.copy())


class Held:
    """What holds numbers and says so the way pandas, torch and others do."""

    def __init__(self, points):
        self.points = points

    def __array__(self, dtype=None, copy=None):
        return self.points if dtype is None else self.points.astype(dtype)


def flat(result):
    """All numbers of a result, to be compared to the last bit."""
    if result is None:
        return b"none"
    parts = result if isinstance(result, tuple) else (result,)
    return b"".join(np.asarray(part, dtype=float).tobytes() for part in parts)


def check_right(points, rng):
    """Hull, area, closest point, margin and inner offset of points are those of fractions and of GEOS."""
    hull = polygon.convex_hull(points)
    assert {tuple(p) for p in hull.tolist()} <= {tuple(p) for p in points.tolist()}
    truth = exact_hull((Fraction(x), Fraction(y)) for x, y in points.tolist())
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    rounding = 1e-12 * size + 1e-14 * float(np.abs(points).max(initial=0.0))
    area = abs(sum((turn(truth[0], a, b) for a, b in pairwise(truth)), Fraction(0))) / 2
    assert abs(Fraction(polygon.area(hull)) - area) <= Fraction(10.0 * rounding) * Fraction(size)
    exact = [tuple(map(Fraction, p)) for p in hull.tolist()]
    assert len(hull) < 3 or all(
        turn(a, b, c) > 0 for a, b, c in zip(exact, exact[1:] + exact[:1], exact[2:] + exact[:2], strict=True)
    )
    if size < 1e-80 or size > 1e80 or rounding > 1e-6 * size:
        return
    at = points[rng.integers(len(points))] + rng.normal(size=2) * size * rng.choice([0.0, 1e-9, 1.0])
    shape = shapely.convex_hull(shapely.multipoints((hull - hull[0]) / size))
    away = shape.distance(shapely.Point((at - hull[0]) / size)) * size
    tolerance = 1e-9 * (size + away) + 10.0 * rounding
    assert math.hypot(*(polygon.closest_point(hull, at) - at)) == pytest.approx(away, abs=tolerance)
    assert max(-polygon.signed_margin(hull, at), 0.0) == pytest.approx(away, abs=tolerance)
    distance = size * rng.choice([1e-9, 0.02, 0.1])
    left = polygon.inner_offset(hull, distance)
    if len(hull) > 2:
        exact_area = inner_offset_area(hull, distance)  # GEOS's buffer is 1e-5 off on some
        assert polygon.area(left) == pytest.approx(exact_area, abs=1e-9 * size**2 + 10.0 * rounding * size)
    for name in ("inscribed_triangle", "inscribed_parallelogram", "inscribed_rectangle_any_angle"):
        corners = getattr(inscribed, name)(hull)
        assert all(polygon.signed_margin(hull, p) >= -1e-9 * size - 10.0 * rounding for p in corners), name
    if area < Fraction(1e-9) * Fraction(size) ** 2:
        return  # of a sliver the sides' directions are rounding
    for around in (enclosing.bounding_box, enclosing.oriented_box, enclosing.enclosing_parallelogram):
        corners = around(hull)
        assert all(polygon.signed_margin(corners, p) >= -1e-9 * size - 10.0 * rounding for p in hull), around


def check(seed):
    rng = np.random.default_rng(seed)
    points = cloud(rng)
    check_right(points, rng)
    points = polygon.convex_hull(points)
    wanted = [flat(function(points)) for function in OF_POLYGON]
    ours = points.tobytes()
    for given in dressed(points):
        before = bytes(np.asarray(given).tobytes())
        for function, right in zip(OF_POLYGON, wanted, strict=True):
            assert flat(function(given)) == right, (seed, type(given))
        assert np.asarray(given).tobytes() == before
    assert points.tobytes() == ours
    for kind in (np.float32, np.int64):  # other numbers, and the same as those in float64
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            other = points.astype(kind)
        if np.abs(other.astype(float)).max(initial=0.0) < 1e9:
            other = polygon.convex_hull(other).astype(kind)  # rounding makes dents
            assert [flat(f(other)) for f in OF_POLYGON] == [flat(f(other.astype(float))) for f in OF_POLYGON], seed
    bad = np.vstack([points, np.zeros((1, 2))])
    bad[rng.integers(len(bad)), rng.integers(2)] = rng.choice([math.nan, math.inf, -math.inf])
    finite = bad[(np.abs(bad) <= 1e100).all(axis=1)]
    turned = bad.T if len(bad) != 2 else bad[None]
    wrong = (turned, bad[:, 0], bad[None], [[1.0, 2.0], [3.0]], "polygon", None, np.ones((3, 2), complex))
    for function in OF_POLYGON:
        for value in wrong if function in LEAVES_OUT else (*wrong, bad):
            with pytest.raises(InputError, match=r"^[^\n]*$"):
                function(value)
        if function in LEAVES_OUT:
            assert flat(function(bad)) == flat(function(finite)), seed


@pytest.mark.sample(6)
@pytest.mark.parametrize("seed", range(80))
def test_any_array_gives_the_right_result_or_one_error(seed):
    check(seed)


@pytest.mark.long
def test_thousands_of_arrays_give_the_right_result_or_one_error():
    for seed in range(1000, 4000):
        check(seed)
