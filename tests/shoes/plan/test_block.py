"""Tests of blocks: edges that move, and mirror images."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar.shoes.geometry.outline import ring
from plantar.shoes.plan.block import Block, Groove, Step, box_block, mirrored_block, mirrored_step, moved_edges, tapered


@given(st.lists(st.tuples(st.integers(-90, 90), st.integers(-50, 50)), min_size=4, max_size=9), st.floats(-3, 3))
def test_moved_edges_keep_their_corners_and_lie_at_their_distance(points, distance):
    hull = shapely.geometry.polygon.orient(shapely.MultiPoint(points).convex_hull.buffer(20, quad_segs=2))
    corners = ring(hull)
    moved = moved_edges(corners, distance)
    assert moved.shape == corners.shape
    for i in range(len(corners)):
        line = shapely.LineString([moved[i - 1], moved[i]])
        edge = corners[i] - corners[i - 1]
        normal = np.array([edge[1], -edge[0]]) / np.hypot(*edge)
        for point in line.coords:
            assert (np.array(point) - corners[i]) @ normal == pytest.approx(distance, abs=1e-6)


def test_an_edge_that_would_vanish_is_told():
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])
    assert moved_edges(square, -1.1) is None
    assert moved_edges(np.array([[0.0, 0.0], [0.0, 0.0], [4.0, 2.0]]), 0.1) is None
    assert tapered(shapely.box(0, 0, 4, 2), 0.0, -1.1, 0.0, 1.0) is None


def test_mirror_images_stay_in_step():
    block = tapered(shapely.box(1, 2, 5, 9), 0.0, -0.5, 0.0, 1.0)
    assert block is not None
    mirror = mirrored_block(block)
    assert isinstance(mirror, Block)
    assert mirror.low.bounds == (1.0, -9.0, 5.0, -2.0)
    assert mirror.low.exterior.is_ccw
    gaps = ring(mirror.low) - ring(mirror.high)
    np.testing.assert_allclose(np.abs(gaps), 0.5)  # corner by corner
    holed = Block(shapely.box(0, 0, 9, 9) - shapely.box(3, 2, 4, 5), 0.0, 1.0)
    flipped = mirrored_block(holed)
    assert isinstance(flipped, Block)
    assert flipped.low.equals(shapely.box(0, -9, 9, 0) - shapely.box(3, -5, 4, -2))
    groove = mirrored_block(Groove(shapely.box(0, 1, 4, 5), shapely.box(1, 2, 3, 4), 0.0, 1.0))
    assert isinstance(groove, Groove)
    assert groove.line.bounds == (0.0, -5.0, 4.0, -1.0)
    step = mirrored_step(Step("add", "a", (box_block((0, 1, 0), (2, 3, 1)),), within=shapely.box(0, 0, 9, 9)))
    assert step.within.bounds == (0.0, -9.0, 9.0, 0.0)
