"""Tests of sections and of wall thickness measured in them."""

import math

import numpy as np
import pytest
import shapely
import trimesh

from plantar.shoes.geometry.section import cut_segments, section, section_along, thinnest_wall, wall_thickness


@pytest.fixture
def hollow(box):
    """A box with walls of 5, 6, 3 and 4 mm, 10 mm above and below."""
    return np.concatenate([box((0, 50), (0, 40), (0, 30)), box((5, 44), (3, 36), (10, 20))[:, ::-1]])


def test_sections_of_a_hollow_box(hollow):
    assert section(hollow, 5.0).equals(shapely.box(0, 0, 50, 40))
    assert section(hollow, 15.0).area == pytest.approx(50 * 40 - 39 * 33)
    assert section(hollow, 40.0).is_empty
    assert section_along(hollow, 1, 20.0).area == pytest.approx(50 * 30 - 39 * 10)  # over x and z
    assert section_along(hollow, 0, 20.0).bounds == (0.0, 0.0, 40.0, 30.0)  # over y and z


def test_the_thinnest_of_its_walls_counts(hollow):
    assert wall_thickness(*cut_segments(hollow, 15.0)) == pytest.approx(3.0)
    assert wall_thickness(*cut_segments(hollow, 5.0)) == pytest.approx(40.0)
    assert thinnest_wall(hollow) == pytest.approx(3.0)
    assert wall_thickness(np.empty((0, 2, 2)), np.empty((0, 3))) == math.inf
    turned = trimesh.transformations.rotation_matrix(0.4, [0, 0, 1])[:3, :3]
    assert thinnest_wall(hollow @ turned.T) == pytest.approx(3.0, abs=1e-3)


def test_a_floor_and_a_bar_are_walls_too(box):
    inside = box((5, 45), (5, 35), (2, 29.9))[:, ::-1]  # closed a little below the top
    assert thinnest_wall(np.concatenate([box((0, 50), (0, 40), (0, 30)), inside])) == pytest.approx(0.1, abs=1e-6)
    bar = np.concatenate([box((0, 50), (0, 30), (0, 30)), box((10, 40), (5, 25), (8, 28.8))[:, ::-1]])
    assert thinnest_wall(bar) == pytest.approx(1.2)


def test_engraved_bands_and_sharp_edges_are_no_walls(box, prism):
    fins = np.concatenate([box((0, 50), (0, 40), (0, 10)), box((10, 20), (5, 35), (9, 10))[:, ::-1]])
    thin = np.concatenate([fins, box((20.4, 30), (5, 35), (9, 10))[:, ::-1]])
    assert thinnest_wall(thin) < 1.01
    assert thinnest_wall(thin, ((8.99, 10.01),)) in (pytest.approx(9.0), pytest.approx(10.0))
    wedge = prism(np.array([[0, 0], [40, 0], [40, 25]]), 0, 20)
    assert thinnest_wall(wedge) == pytest.approx(20.0, abs=1e-3)  # its height: its acute corner is no wall


def test_the_two_triangles_of_an_edge_are_cut_at_one_point():
    """Tetrahedra with corners on a grid of 1/8 mm, so that many points lie halfway between two rounded ones."""
    draw = np.random.default_rng(0)
    for _ in range(1000):
        corners = draw.integers(-100, 100, (4, 3)) / 8.0
        height = float(np.sort(corners[:, 2])[1:3].mean())
        if height in corners[:, 2]:
            continue
        segments, _ = cut_segments(corners[[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]], height)
        ends, counts = np.unique(segments.reshape(-1, 2), axis=0, return_counts=True)
        assert (counts % 2 == 0).all(), (corners, ends)
