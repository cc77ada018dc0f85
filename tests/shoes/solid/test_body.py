"""Tests of the body's parts: walls that follow the foot, and the mark."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from scipy.spatial import cKDTree

from plantar.shoes import build_shoe
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import mirrored_step
from plantar.shoes.plan.shoe_plan import mirrored_plan
from plantar.shoes.solid.body import bare_floor, cavity_levels, insole_steps, mark_outline, shoe_steps
from plantar.shoes.solid.retention import choose_retention

from ..foot_family import FAMILY, prism, small_turns, turned


def test_upright_walls_have_one_level(small_foot):
    p = ShoeParameters()
    plan = build_shoe(small_foot, layout_only=True).shoes[0].plan
    ((low, high, outline),) = cavity_levels(small_foot, plan, p)
    assert (low, high) == (0.0, p.rim_height)
    assert outline.symmetric_difference(plan.cavity).area < 1.0


@pytest.mark.parametrize("name", ["rounded", "flared", "plate"])
def test_walls_leave_room_for_all_that_passes(generated_feet, name):
    p = ShoeParameters()
    foot = foot_from_triangles(name, generated_feet[name], where=name)
    plan = build_shoe(foot, layout_only=True).shoes[0].plan
    levels = cavity_levels(foot, plan, p)
    assert len(levels) == (1 if name == "plate" else 3)
    assert [a[1] for a in levels[:-1]] == [b[0] for b in levels[1:]]
    for low, high, outline in levels:
        for height in np.linspace(low, high, 4):
            assert outline.buffer(0.01).covers(foot.passing(float(height)))
        gap = outline.exterior.hausdorff_distance(foot.passing(high).exterior)
        assert gap < 1.3 * p.clearance + 0.35  # and no more room than that
    below, above = levels[0][2], levels[-1][2]
    assert (above.area > below.area + 500.0) == (name != "plate")


@pytest.mark.parametrize(
    ("name", "turn"), [("concave", 3), ("concave", 4), ("pitched", 19), ("pitched", 3), ("large", 13)]
)
def test_levels_of_the_foots_place_have_no_short_edge_and_keep_the_gap(name, turn):
    p = ShoeParameters()
    foot = foot_from_triangles(name, turned(FAMILY[name](), *small_turns(name)[turn]), where=name)
    plan = build_shoe(foot, layout_only=True, parameters=replace(p, bed_length=500.0)).shoes[0].plan
    levels = cavity_levels(foot, plan, p)
    corners = [ring(outline) for _, _, outline in levels]
    for (_, high, outline), points in zip(levels, corners, strict=True):
        assert np.hypot(*(points - np.roll(points, 1, axis=0)).T).min() > 0.2
        assert foot.passing(high).distance(outline.exterior) > 0.44
    for one, other in pairwise(corners):  # and what two levels have nearly in common they have in common
        gaps, _ = cKDTree(other).query(one)
        assert not ((gaps > 1e-6) & (gaps < 0.05)).any()


def test_the_mark_says_side_and_name_and_fits(small_foot):
    p = ShoeParameters()
    plans = {s.side: s.plan for s in build_shoe(small_foot, layout_only=True).shoes}
    for side, plan in plans.items():
        mark = mark_outline(plan, p, side)
        assert plan.cavity.buffer(-3.9).covers(mark)
        assert mark.bounds[3] - mark.bounds[1] > 4.0
    assert not mark_outline(plans["left"], p, "left").equals(mark_outline(plans["left"], p, "right"))
    assert mark_outline(plans["left"], replace(p, mark_height=0.0), "left").is_empty
    tight = replace(plans["left"], cavity=shapely.box(0, 0, 9, 9))
    assert mark_outline(tight, p, "left").is_empty


def test_the_mark_lies_beside_what_rises_below_an_arch():
    sole = np.array(
        [[-80, -40], [-40, -40], [-38, 22], [55, 26], [60, -48], [190, -48], [190, 60], [60, 60], [-80, 40]]
    )
    plate = np.array([[-82, -42], [192, -50], [192, 62], [-82, 44]], dtype=float)
    surface = np.concatenate([prism(sole.astype(float), 0.0, 9.0), prism(plate, 8.0, 40.0)])
    foot = foot_from_triangles("arched foot", surface, where="arched")
    p = ShoeParameters()
    plan = build_shoe(foot, side="left", layout_only=True).shoes[0].plan
    floor = cavity_levels(foot, plan, p)[0][2]
    mark = mark_outline(plan, p, "left", floor)
    assert not mark.is_empty
    assert floor.buffer(-3.9).covers(mark)
    assert not floor.covers(mark_outline(plan, p, "left"))  # the middle lies on what rises
    steps = shoe_steps(foot, plan, choose_retention(foot, plan, p), p)
    assert bare_floor(steps) == floor
    other = bare_floor(tuple(mirrored_step(s) for s in steps))
    assert other.equals(shapely.affinity.scale(floor, 1.0, -1.0, origin=(0.0, 0.0)))
    assert other.buffer(-3.9).covers(mark_outline(mirrored_plan(plan), p, "right", other))
    assert bare_floor(insole_steps(plan, p)) is None


def test_levels_lie_on_each_other_or_clearly_apart():
    """A step of a hair between two levels gives faces of no width, and a surface that is not closed."""
    p = ShoeParameters()
    foot = foot_from_triangles("a", turned(FAMILY["pitched"](), *small_turns("pitched")[4]), where="a")
    plan = build_shoe(foot, layout_only=True).shoes[0].plan
    outlines = [outline for _, _, outline in cavity_levels(foot, plan, p)]
    assert len(outlines) > 2
    for lower, upper in pairwise(outlines):
        assert upper.buffer(1e-6).covers(lower)
        gaps = shapely.distance(shapely.points(shapely.get_coordinates(lower.exterior.segmentize(1.0))), upper.exterior)
        hair = (gaps > 1e-6) & (gaps < 0.04)
        assert hair.mean() < 0.01
