"""The exact references of the shape kernels agree with what is known, and soles have the cells that were asked for."""

import numpy as np
import pytest

from . import references as exact
from .sample_soles import random_outline

TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@pytest.mark.long
def test_references_give_what_is_known_of_a_triangle():
    assert exact.hull_area_exact(TRIANGLE) == 6.0
    assert exact.triangle_area_exact(TRIANGLE) == 6.0
    assert exact.circle_radius(TRIANGLE) == pytest.approx(1.0, rel=1e-14)
    assert exact.rectangle_area(TRIANGLE) == pytest.approx(3.0, rel=1e-12)
    assert exact.rectangle_area_any_angle(TRIANGLE, samples=30) == pytest.approx(3.0, rel=1e-9)
    assert exact.parallelogram_area(TRIANGLE, samples=30) == pytest.approx(3.0, rel=1e-12)
    assert exact.least_parallelogram_area(TRIANGLE) == 12.0
    assert exact.least_box_area(TRIANGLE) == 12.0
    assert exact.centroid_exact(TRIANGLE).tolist() == [4.0 / 3.0, 1.0]
    assert exact.closest_point_exact(TRIANGLE, [4.0, 3.0]).tolist() == pytest.approx([2.56, 1.08])


def test_the_reference_of_the_inner_offset_is_right_where_edges_vanish():
    assert exact.inner_offset_area(SQUARE, 0.25) == pytest.approx(0.25, rel=1e-15)
    assert exact.inner_offset_area(SQUARE, 0.6) == 0.0


def test_the_reference_in_an_outline_sees_holes_and_upright_edges():
    corner = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
    assert exact.outline_rectangle_area([corner]) == pytest.approx(4.0, rel=1e-12)
    hole = 0.25 + 0.5 * SQUARE[::-1]
    assert exact.outline_rectangle_area([SQUARE, hole]) == pytest.approx(0.25, rel=1e-12)
    assert exact.outline_rectangle_area([SQUARE, SQUARE + np.array([1.5, 0.0])]) == pytest.approx(1.0, rel=1e-12)


def test_random_outlines_have_the_cells_that_were_asked_for():
    for active, share in ((250, 0.3), (1000, 0.9)):
        outline = random_outline(active, share, 1)
        assert outline.area == pytest.approx(active * 1e-5, rel=0.2)
        assert np.array_equal(outline.points, random_outline(active, share, 1).points)
        assert not np.array_equal(outline.points, random_outline(active, share, 2).points)
