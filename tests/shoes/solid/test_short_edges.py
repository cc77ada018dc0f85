"""Short edges are contracted without folds and overhangs: the surface stays closed."""

import numpy as np
import pytest
import shapely

from plantar.shoes import build_shoe
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.geometry.section import thinnest_wall
from plantar.shoes.geometry.surface import is_closed
from plantar.shoes.plan.block import Block, Step, box_block
from plantar.shoes.solid.kernel import build_solid
from plantar.shoes.solid.polyhedron import Polyhedron
from plantar.shoes.solid.short_edges import without_short_edges

from ..foot_family import FAMILY, small_turns, turned


def _beam(off: float) -> Polyhedron:
    """Prism along y whose lower edge is cut at 45 degrees, with an end corner that is off by so much in y."""
    front = [[0.4, 0.0, 0.0], [5.0, 0.0, 0.0], [5.0, 0.0, 3.0], [0.0, 0.0, 3.0], [0.0, 0.0, 0.4]]
    back = [[x, 5.0, z] for x, _, z in front]
    corners = np.array([*front, *back, [0.0, off, 0.4]])
    sides = [(1, 0, 5, 6), (2, 1, 6, 7), (3, 2, 7, 8)]
    faces = [(0, 1, 2, 3, 4), (9, 8, 7, 6, 5), *sides, (4, 3, 8, 9, 10), (0, 4, 10, 9, 5)]
    return Polyhedron(corners, tuple((loop,) for loop in faces))


def test_a_short_edge_is_contracted():
    body = _beam(0.1)
    assert is_closed(body.surface)
    short = without_short_edges(body, 0.2)
    assert len(short.corners) == len(body.corners) - 1
    assert is_closed(short.surface)
    assert abs(short.volume - body.volume) < 1e-3 * body.volume


def test_the_surface_of_a_shoe_has_no_fold_and_no_short_edge():
    triangles = turned(FAMILY["of_65_mm"](), *small_turns("of_65_mm")[1])
    shoe = build_shoe(foot_from_triangles("a", triangles, where="a"), side="left", cell_area=258.0).shoes[0]
    assert is_closed(shoe.surface)
    assert shoe.solid is not None
    ends = shoe.solid.corners[np.array(list(shoe.solid.neighbours))]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).min() >= 0.2
    cross = np.cross(shoe.surface[:, 1] - shoe.surface[:, 0], shoe.surface[:, 2] - shoe.surface[:, 0])
    down = -cross[:, 2] / np.linalg.norm(cross, axis=1)
    assert not ((down > 0.7082) & (down < 0.999)).any()


@pytest.mark.parametrize(("facet", "window"), [(0.1, 0.022), (0.135, 0.113), (0.11, 0.085)])
def test_a_narrow_facet_next_to_a_window_is_not_turned_over(facet, window):
    # The facet's left edge moved to the right, and the window's edge within it to the left of that.
    front = [(-19.65, 0.019 + 0.209 * 19.55), (-facet, 0.19 * facet), (0.0, 0.0), (0.177, -0.044), (19.86, -3.604)]
    outline = shapely.Polygon([*front, (20.0, 20.0), (-20.0, 20.0)])
    plate, hole = Block(outline, 0.0, 12.0), box_block((-window, -10.0, 4.0), (6.0, 5.0, 8.0))
    body = build_solid([Step("add", "plate", (plate,)), Step("cut", "window", (hole,))])
    assert thinnest_wall(body.surface) == pytest.approx(4.0, abs=1e-3)
