"""Rings with near-duplicates, spikes and points on edges, near and far: every function that takes a ring, 600 times.

The reference is the ring's hull in fractions, in a frame of its size; what a function gives is compared there. Allowed
are 1e-9 of the size, and some units in the last place where a ring is far away for its size.
"""

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from plantar import grid_layout, walking_tick
from plantar.geometry.enclosing import bounding_box, enclosing_parallelogram, oriented_box
from plantar.geometry.inscribed import (
    inscribed_circle,
    inscribed_parallelogram,
    inscribed_rectangle,
    inscribed_rectangle_any_angle,
    inscribed_triangle,
    rectangle_in_outline,
    safe_rectangle,
)
from plantar.geometry.outline import Outline
from plantar.geometry.polygon import area, centroid, closest_point, convex_hull, inner_offset, signed_margin
from plantar.kernels.geometry.clean import turning
from plantar.percepts.sole_pose import feet_support_polygon
from plantar.sensing.partial_contact import PartialContact

from .. import references as exact
from ..fuzz.dirty_rings import ExactRing, chamfered_rectangle, dirty_ring, vanishing_depths
from ..sample_soles import sole_of

COUNT = 600
"""Rings, of which the short tests take a quarter."""


@pytest.fixture(autouse=True)
def _fewer(share, monkeypatch):
    monkeypatch.setitem(globals(), "COUNT", round(share * 600))


@cache
def rings(count):
    """Each ring with its exact one, what its errors may be, and numbers to draw from."""
    found = []
    for seed in range(2 * count):
        ring = dirty_ring(np.random.default_rng(seed))
        one = ExactRing.of(ring)
        if len(one.polygon) > 2 and len(found) < count:
            found.append((ring, one, 1e-9 + 40.0 * one.step, np.random.default_rng(seed)))
    assert len(found) == count
    return found


def assert_none_is_wrong(error):
    """Assert that the error of no ring, in units of its size, is more than it may be."""
    wrong = {}
    for i, (ring, one, allowed, rng) in enumerate(rings(COUNT)):
        off = error(ring, one, rng)
        if not off <= allowed:
            wrong[i] = off, allowed
    assert wrong == {}


def size(corners):
    x, y = (corners - corners[0]).T
    return 0.5 * float(x @ np.roll(y, -1) - np.roll(x, -1) @ y)


def test_clean_rings_stay_as_they_are():
    for _, one, _, _ in rings(COUNT):
        for ring in (one.polygon, one.polygon[::-1]):
            assert turning(ring, 0.0, 0.0, 0.0) in (0, 1 if ring is one.polygon else -1)
            assert inner_offset(ring, 0.0) is not ring
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert (turning(square, 0.0, 0.0, 0.0), turning(square[::-1], 3.0, 0.0, 0.0)) == (1, -1)
    star = square[[0, 2, 1, 3]]
    twice = np.concatenate([square, square])
    dented = np.insert(square, 2, [1.0 - math.ulp(0.5), 0.5], axis=0)
    for ring in (star, twice, dented, square[[0, 1, 1, 2, 3]], square[:2], np.where(square == 1.0, np.nan, square)):
        assert turning(np.ascontiguousarray(ring), 0.0, 0.0, 0.0) == 0


def test_area_and_centroid():
    def error(ring, one, rng):
        local = [[(Fraction(float(v)) - low) / one.size for v, low in zip(p, one.origin, strict=True)] for p in ring]
        twice = x = y = Fraction(0)
        for (ax, ay), (bx, by) in zip(local, [*local[1:], local[0]], strict=True):
            cross = ax * by - bx * ay
            twice, x, y = twice + cross, x + (ax + bx) * cross, y + (ay + by) * cross
        off = abs(abs(area(ring)) / float(one.size) ** 2 - abs(float(twice)) / 2)
        if abs(twice) > 1e-6:
            middle = one.local(centroid(ring))[0]
            off = max(off, np.hypot(*(middle - [float(x / (3 * twice)), float(y / (3 * twice))])))
        return max(off, abs(abs(area(ring)) / float(one.size) ** 2 - size(one.polygon)))

    assert_none_is_wrong(error)


def test_hull():
    assert_none_is_wrong(lambda ring, one, rng: abs(size(one.local(convex_hull(ring))) - size(one.polygon)))
    assert_none_is_wrong(
        lambda ring, one, rng: abs(size(one.local(feet_support_polygon([ring, ring[:3]]))) - size(one.polygon))
    )


def test_margin_and_closest_point():
    def error(ring, one, rng):
        worst = 0.0
        middle = one.polygon.mean(axis=0)
        for reach in (0.0, 0.3, 0.8):
            point = one.place(middle + reach * rng.uniform(-1.0, 1.0, 2))
            here = one.local(point)[0]
            depth = float(one.depth(here[None])[0])
            near = exact.closest_point_exact(one.polygon, here)
            wanted = depth if depth > 0.0 else -float(np.hypot(*(near - here)))
            worst = max(worst, abs(signed_margin(ring, point) / float(one.size) - wanted))
            worst = max(worst, float(np.abs(one.local(closest_point(ring, point))[0] - near).max()))
        return worst

    assert_none_is_wrong(error)


def test_inner_offset_is_right_and_clean():
    def error(ring, one, rng):
        depths = vanishing_depths(one.polygon)
        share = float(rng.choice([1e-6, 0.1, 0.5, 0.9, 0.999999, 1.2]))
        distance = float(depths[0]) * share if rng.random() < 0.7 else float(rng.choice(depths))
        distance = float(Fraction(distance) * one.size) / float(one.size)
        smaller = inner_offset(ring, distance * float(one.size))
        local = one.local(smaller)
        if len(smaller) < 3:  # nothing is left, and nothing lies deeper
            least = float(one.depth(local).min())
            if exact.inner_offset_area(one.polygon, least + 1e-9 + 40.0 * one.step):
                return math.inf
            return max(0.0, least - distance)
        if turning(smaller, 0.0, 0.0, 0.0) != 1:
            return math.inf
        off = abs(size(local) - exact.inner_offset_area(one.polygon, distance))
        off = max(off, float(np.abs(one.depth(local) - distance).max()))
        here = local.mean(axis=0)
        margin = signed_margin(smaller, one.place(here)) / float(one.size)
        return max(off, abs(margin - float(one.depth(here[None])[0]) + distance))

    assert_none_is_wrong(error)


def inside(corners, one):
    """How far local corners stand out of a ring."""
    return max(0.0, -float(one.depth(corners).min()))


def around(corners, one):
    """How far a ring stands out of local corners, counter-clockwise; one without area holds nothing."""
    edge = np.roll(corners, -1, axis=0) - corners
    length = np.hypot(*edge.T)
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.where(length > 0.0, length, math.inf)[:, None]
    return max(0.0, -float(((one.polygon[:, None] - corners) * normal).sum(axis=2).min()))


def test_shapes_against_exact_ones():
    def error(ring, one, rng):
        polygon = one.polygon
        triangle, box = one.local(inscribed_triangle(ring)), one.local(oriented_box(ring))
        slanted, straight = one.local(enclosing_parallelogram(ring)), one.local(bounding_box(ring))
        return max(
            abs(size(triangle) - exact.triangle_area_exact(polygon)),
            inside(triangle, one),
            abs(size(box) - exact.least_box_area(polygon)),
            around(box, one),
            abs(size(slanted) - exact.least_parallelogram_area(polygon)),
            around(slanted, one),
            abs(size(straight) - float(np.ptp(polygon, axis=0).prod())),
            around(straight, one),
        )

    assert_none_is_wrong(error)


def test_circle():
    def error(ring, one, rng):
        circle = inscribed_circle(ring)
        depth = float(one.depth(one.local(circle.center))[0])
        radius = circle.radius / float(one.size)
        wanted = exact.circle_radius(one.polygon) if len(one.polygon) < 12 else inscribed_circle(one.polygon).radius
        return max(abs(radius - wanted), abs(depth - radius))

    assert_none_is_wrong(error)


@pytest.mark.parametrize("shape", [inscribed_parallelogram, inscribed_rectangle, lambda r: inscribed_rectangle(r, 0.7)])
def test_shapes_are_those_of_the_clean_ring(shape):
    def error(ring, one, rng):
        corners = one.local(shape(ring))
        return max(abs(size(corners) - size(shape(one.polygon))), inside(corners, one))

    assert_none_is_wrong(error)


def test_rectangles_at_any_angle():
    """Found to 1e-6 of the area, so that two of them may differ by that; it does not stand out of the ring."""

    def error(ring, one, rng):
        wanted = size(inscribed_rectangle_any_angle(one.polygon))
        corners = one.local(inscribed_rectangle_any_angle(ring))
        return max(0.0, abs(size(corners) - wanted) - 1e-6 * wanted, inside(corners, one))

    assert_none_is_wrong(error)


def test_rectangle_in_an_outline():
    def error(ring, one, rng):
        outline = Outline.of_rings([ring if area(ring) > 0.0 else ring[::-1]])
        corners = one.local(rectangle_in_outline(outline))
        return max(abs(size(corners) - size(inscribed_rectangle(one.polygon))), inside(corners, one))

    assert_none_is_wrong(error)


def test_safe_rectangle():
    def error(ring, one, rng):
        offset = 0.05 * float(one.size)
        corners = one.local(safe_rectangle(ring, offset))
        wanted = inscribed_rectangle(one.polygon)
        low, high = np.minimum(wanted[0] + 0.05, wanted.mean(axis=0)), np.maximum(wanted[2] - 0.05, wanted.mean(axis=0))
        return abs(size(corners) - float((high - low).prod()))

    assert_none_is_wrong(error)


# --- rings that the library makes itself --------------------------------------------------------------------------


def offset_where_an_edge_vanishes(ring, rng):
    """Inner offset at a depth where an edge vanishes, that depth, and a point in what is left."""
    depth = float(rng.choice(vanishing_depths(ring)[:4]))
    smaller = inner_offset(ring, depth)
    middle = smaller.mean(axis=0)
    return smaller, depth, middle + rng.uniform(0.0, 0.99) * (smaller[rng.integers(len(smaller))] - middle)


def test_margins_of_the_library_s_own_inner_offsets(share):
    wrong = []
    for seed in range(round(2000 * share)):
        rng = np.random.default_rng(seed)
        ring = convex_hull(chamfered_rectangle(rng))
        smaller, depth, point = offset_where_an_edge_vanishes(ring, rng)
        one = ExactRing.of(ring)
        wanted = float(one.depth(one.local(point[None]))[0]) * float(one.size) - depth
        if len(smaller) > 2 and not abs(signed_margin(smaller, point) - wanted) < 1e-9:
            wrong.append(seed)
    assert wrong == []


def test_a_tick_leaves_an_aim_inside_where_it_is(share):
    layout = sole_of(51)
    wrong, count = [], 0
    for seed in range(round(5000 * share)):
        rng = np.random.default_rng(seed)
        force = np.where(rng.random(len(layout)) < rng.choice([0.05, 0.1, 0.2, 0.5]), 20.0, 0.0)
        hull, *_ = layout.kernel.hull(force > 0.0)
        if not len(hull):
            continue
        smaller, depth, aim = offset_where_an_edge_vanishes(hull, rng)
        edge = np.roll(hull, -1, axis=0) - hull
        across = edge[:, 0] * (aim[1] - hull[:, 1]) - edge[:, 1] * (aim[0] - hull[:, 0])
        inside_by = float((across / np.hypot(*edge.T)).min()) - depth
        foot = walking_tick(layout, force, aim, depth)
        assert foot.safe_polygon.tolist() == smaller.tolist()
        if len(smaller) > 2 and inside_by > 1e-12:
            count += 1
            if foot.clamped.tolist() != aim.tolist() or abs(signed_margin(smaller, aim) - inside_by) > 1e-9:
                wrong.append(seed)
    assert wrong == []
    assert count > 3000 * share


def test_what_ground_edges_leave_is_clean():
    layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.05, 0.05))
    fit = PartialContact(layout)
    for k in range(200):
        rng = np.random.default_rng(k)
        way = rng.normal(size=2)
        way /= np.hypot(*way)
        corner = [0.2 if way[0] > 0.0 else 0.0, 0.1 if way[1] > 0.0 else 0.0]
        lines = np.array([[*way, way @ corner - 10.0 ** rng.uniform(-18.0, -1.5)], [-1.0, 0.0, -1e-17]])
        left = fit.polygon(lines)
        assert turning(left, 0.0, 0.0, 0.0) == 1, k
        assert 0.0 < signed_margin(left, left.mean(axis=0)) < 0.06
