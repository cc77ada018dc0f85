"""Points whose coordinates agree to the last bits, to nanometres or to micrometres, through every function of points.

Corners that a simulator or a lattice computes twice differ so. A hull is compared with one in exact fractions; a
measure of a polygon is continuous, so points that move by a hair change it by little.
"""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.geometry.cell_cutting import CellCutter
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
from plantar.geometry.polygon import (
    area,
    centroid,
    closest_point,
    convex_hull,
    convex_ring,
    inner_offset,
    part_inside,
    signed_margin,
)
from plantar.kernels.geometry.few_points import FewPoints
from plantar.percepts.sole_pose import feet_support_polygon

from ...examples import examples
from ..references import exact_hull, turn

HAIRS = (0.0, 1e-17, 1e-16, 1e-13, 1e-11, 3e-9, 1e-7, 1e-6)  # m
LANDED = [(0.029, 0.655), (0.029, 0.815), (0.149, 0.655), (0.149, 0.815), (0.149 + 3e-9, 0.625)]


@st.composite
def near_equal(draw, least=4):
    """A coarse lattice's points, and the same with each coordinate off by a hair."""
    n = draw(st.integers(least, 14))
    steps = st.integers(-3, 3)
    coarse = np.array(draw(st.lists(st.tuples(steps, steps), min_size=n, max_size=n)), dtype=float)
    coarse = 0.04 * coarse + draw(st.sampled_from([0.0, 0.2, 17.3]))
    hair = draw(st.sampled_from(HAIRS))
    offs = draw(st.lists(st.tuples(steps, steps), min_size=n, max_size=n))
    return coarse, coarse + hair * np.array(offs, dtype=float), 3.0 * hair


def exact_area(ring):
    return sum(turn(ring[0], a, b) for a, b in pairwise(ring)) / 2 if ring else 0


def few_hull(points):
    cloud = FewPoints()
    for x, y in points:
        cloud.add(float(x), float(y))
    cloud.hull(0, cloud.count)
    return cloud


def test_a_corner_three_nanometres_beyond_another_one_costs_no_corner():
    hull = few_hull(LANDED)
    assert hull.area() == pytest.approx(0.021, rel=1e-6)
    assert set(hull.corners_of()) == {p for p in LANDED if p != (0.149, 0.655)}
    assert hull.margin(0.1, 0.75) == pytest.approx(0.049, abs=1e-6)
    assert area(convex_hull(LANDED)) == hull.area()


@examples(100)
@given(near_equal(least=1))
def test_hulls_are_those_in_exact_fractions(drawn):
    _, points, _ = drawn
    wanted = exact_hull((Fraction(x), Fraction(y)) for x, y in points.tolist())
    largest = float(np.abs(points).max())
    few = np.array(few_hull(points).corners_of()).reshape(-1, 2)
    for ring in (convex_hull(points), feet_support_polygon([points[:1], points[1:]]), few):
        corners = [(Fraction(x), Fraction(y)) for x, y in ring.tolist()]
        assert set(corners) <= {(Fraction(x), Fraction(y)) for x, y in points.tolist()}
        for a, b, c in zip(corners, corners[1:] + corners[:1], corners[2:] + corners[:2], strict=True):
            assert len(corners) < 3 or turn(a, b, c) > 0
        # What is left out lies on an edge, to the rounding of the coordinates.
        room = len(points) * 9e-16 * largest
        assert abs(float(exact_area(wanted) - exact_area(corners))) <= room
        for x, y in wanted if len(corners) > 2 else ():
            for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
                outside = float(-turn(a, b, (x, y))) / float((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5
                assert outside <= room


def cut_area(ring):
    """Area of what a polygon's edges leave of a square around it."""
    edge = np.roll(ring, -1, axis=0) - ring
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    lines = np.column_stack([normal, (normal * ring).sum(axis=1)])
    return float(SQUARE.cut(lines)[0][:, 0].sum())


def sides_area(corners):
    return abs(area(np.asarray(corners)))


SQUARE = CellCutter.of_polygons([np.array([[-1.0, -1.0], [30.0, -1.0], [30.0, 30.0], [-1.0, 30.0]])])
MEASURES = {
    "cells cut": cut_area,
    "safe rectangle": lambda ring: sides_area(safe_rectangle(ring, 0.005)),
    "area": lambda ring: area(convex_ring(ring)),
    "outline": lambda ring: Outline.of_rings([ring]).area,
    "rectangle in an outline": lambda ring: sides_area(rectangle_in_outline(Outline.of_rings([ring]))),
    "part inside": lambda ring: area(part_inside(ring, 0.6, 0.8, float(centroid(ring) @ [0.6, 0.8]))),
    "bounding box": lambda ring: sides_area(bounding_box(ring)),
    "oriented box": lambda ring: sides_area(oriented_box(ring)),
    "enclosing parallelogram": lambda ring: sides_area(enclosing_parallelogram(ring)),
    "inscribed triangle": lambda ring: sides_area(inscribed_triangle(ring)),
    "inscribed parallelogram": lambda ring: sides_area(inscribed_parallelogram(ring)),
    "inscribed rectangle": lambda ring: sides_area(inscribed_rectangle(ring)),
    "inscribed rectangle turned": lambda ring: sides_area(inscribed_rectangle(ring, 0.3)),
    "inscribed rectangle at any angle": lambda ring: sides_area(inscribed_rectangle_any_angle(ring)),
    "inscribed circle": lambda ring: inscribed_circle(ring).radius,
    "inner offset": lambda ring: area(inner_offset(ring, 0.005)),
    "margin": lambda ring: signed_margin(ring, centroid(ring)),
    "closest point": lambda ring: float(np.hypot(*(closest_point(ring, ring[0] + [1.0, 0.3]) - ring[0]))),
    "centroid": lambda ring: float(np.hypot(*(centroid(ring) - ring[0]))),
}


@pytest.mark.parametrize("measure", MEASURES)
@given(near_equal())
def test_a_hair_changes_a_measure_by_a_hair(measure, drawn):
    """Rings hold all corners, also those on edges and those a hair apart; a ring without hairs is the reference."""
    coarse, points, hair = drawn
    clean = convex_hull(coarse)
    if len(clean) < 3 or area(clean) < 1e-3:  # thin ones may lose all of an offset to a hair
        return
    order = np.lexsort((points[:, 1], points[:, 0]))
    ring = convex_hull(points[order])
    start = ring[np.argmin(np.hypot(*(ring - clean[0]).T))]
    ring = np.roll(ring, -int(np.flatnonzero((ring == start).all(axis=1))[0]), axis=0)
    room = 1e-5 * float(np.ptp(clean, axis=0).max()) if measure.endswith("any angle") else 0.0  # it is exact to 1e-6
    assert MEASURES[measure](ring) == pytest.approx(MEASURES[measure](clean), abs=1e-12 + 400.0 * hair + room)
