"""The compiled kernels of outlines and shapes against their interpreted forms, to the last bit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout
from plantar.geometry.polygon import convex_hull
from plantar.kernels import compiled, python_form
from plantar.kernels.geometry import outline, shapes
from plantar.layouts.cell_edges import edge_table

from ...examples import examples

pytestmark = pytest.mark.skipif(not compiled, reason="without a compiler there is one form only")

seeds = st.integers(0, 2**32 - 1)
SOLE = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], cell_area=4e-4, angle=0.2)
METHODS = ["triangle", "parallelogram", "circle", "box", "parallelogram_around"]


def polygons(seed):
    """A convex polygon, also one without area, with NaN, far away, or not convex."""
    rng = np.random.default_rng(seed)
    cloud = rng.normal(0.0, 0.1, (int(rng.integers(0, 30)), 2))
    kind = seed % 7
    if kind == 0:
        return cloud
    hull = convex_hull(cloud)
    if kind == 1 and len(hull):
        hull = np.vstack([hull, [[math.nan, 0.0]], hull[:1]])
    if kind == 2:
        hull = hull[::-1] + 1e6
    if kind == 3:
        hull = hull * [1.0, 0.0]
    return hull


def same(a, b):
    return np.array_equal(np.asarray(a), np.asarray(b), equal_nan=True)


@examples(60)
@given(seeds)
def test_shapes_of_convex_polygons_agree_to_the_last_bit(seed):
    polygon = np.ascontiguousarray(polygons(seed))
    ours, oracle = shapes.ConvexShapes(False), python_form("shapes").ConvexShapes(True)
    assert type(ours).__module__ == "plantar.kernels.geometry.shapes"
    for name in METHODS:
        a, b = getattr(ours, name)(polygon), getattr(oracle, name)(polygon)
        assert same(a[0], b[0]) if isinstance(a, tuple) else same(a, b), name
        assert not isinstance(a, tuple) or a[1] == b[1], name
    assert same(ours.rectangle(polygon, 0.3), oracle.rectangle(polygon, 0.3))
    assert same(ours.bounding_box(polygon), oracle.bounding_box(polygon))


@given(seeds, st.floats(0.0, 1.0), st.floats(-3.0, 3.0))
def test_outlines_and_their_rectangles_agree_to_the_last_bit(seed, share, angle):
    table = edge_table(SOLE.vertices[:, :2], SOLE.corners)
    arguments = table.__reduce__()[1]
    oracle = python_form("outline").EdgeTable(*arguments[:-1], False)
    cells = (np.random.default_rng(seed).random(len(SOLE)) < share).tobytes()
    found, again = (table.rings(cells, outline.Rings) for _ in range(2))  # the work arrays are as they were
    points, starts = found.points, found.starts
    for other in (again, oracle.rings(cells, python_form("outline").Rings)):
        assert same(points, other.points)
        assert (starts, found.ring_areas) == (other.starts, other.ring_areas)
    if len(points):
        moments = python_form("outline").area_and_centroid(points, starts)
        assert outline.area_and_centroid(points, starts) == moments
        ours, oracle = shapes.ConvexShapes(False), python_form("shapes").ConvexShapes(True)
        found = ours.rectangle_in_outline(points, starts, angle)
        assert same(found, oracle.rectangle_in_outline(points, starts, angle))
