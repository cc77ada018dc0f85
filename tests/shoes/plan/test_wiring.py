"""Openings of the plate for pockets and cable: no steps so small that they would be walls of no width."""

import numpy as np
import pytest
import shapely

from plantar.shoes import build_shoe
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.geometry.section import wall_thickness
from plantar.shoes.plan.wiring import _without_posts, pocket_outlines

from ..foot_family import FAMILY, small_turns, turned


@pytest.mark.sample(3)
@pytest.mark.parametrize("cell", ["fsr_402_short", "fx29_100"])
@pytest.mark.parametrize(("length", "width"), [(0.215, 0.0756), (0.205, 0.0756), (0.235, 0.1), (0.25, 0.08)])
def test_outlines_have_no_edge_of_some_thousandths(length, width, cell):
    foot = foot_from_dimensions("a", length=length, width=width, sole_center=(0.02, 0.0), corner_radius=0.45 * width)
    build = build_shoe(foot, side="left", cell=read_cell(cell), layout_only=True)
    for outline in pocket_outlines(build.shoes[0].plan, build.parameters):
        for ring in (outline.exterior, *outline.interiors):
            assert np.hypot(*np.diff(shapely.get_coordinates(ring), axis=0).T).min() > 0.005


def test_no_post_hangs_on_a_rib_by_a_line():
    """Where a hole of an opening touches its edge in a point, the print would have an edge of four faces."""
    post = [(0.0, 5.0), (6.0, 2.0), (6.0, 8.0)]
    alone = [(12.0, 2.0), (12.0, 8.0), (16.0, 8.0), (16.0, 2.0)]
    opening = shapely.Polygon([(0, 0), (20, 0), (20, 10), (0, 10)], [post, alone])
    assert opening.is_valid
    found = _without_posts(opening, 1.2)
    assert found.is_valid
    nearest, other = sorted(found.interiors, key=lambda ring: ring.bounds)
    assert nearest.distance(found.exterior) > 0.9
    assert shapely.Polygon(nearest).area > 0.9 * shapely.Polygon(post).area
    assert shapely.Polygon(other).equals(shapely.Polygon(alone))
    short = shapely.Polygon(opening.exterior, [[(0.0, 5.0), (2.0, 4.0), (2.0, 6.0)]])
    assert not _without_posts(short, 1.2).interiors


def test_no_wedge_next_to_a_slanting_channel_is_thinner_than_a_wall():
    build = build_shoe(
        foot_from_triangles("a", FAMILY["of_65_mm"](), where="a"), side="left", cell_area=258.0, layout_only=True
    )
    openings = pocket_outlines(build.shoes[0].plan, build.parameters)
    rings = [shapely.segmentize(r, 0.2) for q in openings for r in (q.exterior, *q.interiors)]
    segments = np.concatenate([np.stack([c[:-1], c[1:]], axis=1) for c in map(shapely.get_coordinates, rings)])
    along = segments[:, 1] - segments[:, 0]
    outwards = np.column_stack([along[:, 1], -along[:, 0], 0.0 * along[:, 0]]) / np.hypot(*along.T)[:, None]
    middles = segments.mean(axis=1) + 1e-3 * outwards[:, :2]
    outwards *= np.where(shapely.contains_xy(shapely.union_all(openings), *middles.T), 1.0, -1.0)[:, None]
    assert wall_thickness(segments, outwards) > build.parameters.wall_min


@pytest.mark.parametrize("turn", [36, 37])
def test_nothing_thinner_than_a_wall_stands_alone_in_an_opening(turn):
    triangles = turned(FAMILY["of_65_mm"](), *small_turns("of_65_mm")[turn])
    build = build_shoe(foot_from_triangles("a", triangles, where="a"), side="left", cell_area=258.0, layout_only=True)
    openings = pocket_outlines(build.shoes[0].plan, build.parameters)
    posts = [shapely.Polygon(hole) for opening in openings for hole in opening.interiors]
    assert all(not post.buffer(-0.5 * build.parameters.wall_min).is_empty for post in posts)
    assert all(post.distance(q.exterior) > 0.2 for q in openings for post in posts)  # touching, it is no solid
