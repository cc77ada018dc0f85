"""Tests of the solid: measured on what the kernel built, against the plan and the parameters."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from plantar.errors import FootError
from plantar.shoes import ShoeParameters, build_shoe
from plantar.shoes.geometry.section import section
from plantar.shoes.plan.block import Block, Groove, Step, box_block, tapered
from plantar.shoes.plan.wiring import cable_outlines, hole_outline, pocket_outlines
from plantar.shoes.solid.kernel import build_solid


def test_the_solid_is_one_and_its_sections_are_the_plan(exported):
    report, _ = exported
    p = report.build.parameters
    for shoe in report.build.shoes:
        solid, plan, surface = shoe.solid, shoe.plan, shoe.surface
        assert surface is not None
        low, high = solid.corners[:, 2].min(), solid.corners[:, 0].max()
        assert (low, high) == pytest.approx((p.bottom, plan.contact.bounds[2]), abs=0.01)
        below = section(surface, p.bottom + p.scribe + 0.5 * (p.pocket_depth - p.scribe))
        openings = shapely.union_all(pocket_outlines(plan, p))
        # Inside the contact face there are the openings; lugs and the board's holder stand out of it.
        assert (plan.contact - below).symmetric_difference(openings & plan.contact).area < 8.0
        assert (below - plan.contact.buffer(9.6)).area < 1.0
        floor = section(surface, p.thickness - p.mark_depth - 0.1)
        assert (plan.foot - floor).area < 1e-3
        wall = section(surface, p.thickness + 0.6 * p.rim_height)
        assert (wall & plan.cavity).area < 0.5
        assert ((plan.rim - plan.cavity) - wall).area < 0.5


def test_the_pockets_leave_their_ribs_but_for_the_cable(exported):
    report, _ = exported
    plan, p = report.build.shoes[0].plan, report.build.parameters
    openings = shapely.union_all(pocket_outlines(plan, p))
    cable = shapely.union_all(cable_outlines(plan, p))
    ribs = shapely.union_all(plan.cells) - shapely.union_all(list(plan.pockets)).buffer(1e-6)
    assert (openings & ribs - cable.buffer(p.wall_min + 0.01)).area < 1e-2  # nor what would be too thin beside it
    assert openings.buffer(1e-3).covers(shapely.Point(plan.heel.point(-0.4 * p.board_gap, 0.0)))  # the cable leaves
    assert hole_outline(plan, p).covers(shapely.Point(plan.heel.point(-0.5 * p.board_gap, 0.0)))


def test_the_surface_is_closed_and_points_outwards(exported):
    shoe = exported[0].build.shoes[0]
    assert shoe.surface is not None
    a, b, c = np.moveaxis(shoe.surface, 1, 0)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(shoe.solid.volume, rel=1e-6)
    np.testing.assert_allclose(np.cross(b - a, c - a).sum(axis=0), 0.0, atol=1e-4)


def test_the_sides_mirror_each_other_but_for_the_mark(small_foot, exported):
    area = round(1e6 * exported[0].build.shoes[0].layout.cell_area, 6)
    build = build_shoe(small_foot, cell_area=area, parameters=ShoeParameters(mark_height=0.0))
    left, right = (shoe.solid for shoe in build.shoes)
    assert left.volume == pytest.approx(right.volume, rel=1e-6)
    marked = exported[0].build.shoes[0].solid
    assert 5.0 < left.volume - marked.volume < 200.0


def test_blocks_have_the_volumes_they_should():
    square = shapely.box(0, 0, 10, 10)
    assert build_solid([Step("add", "a", (box_block((0, 0, 0), (10, 10, 5)),))]).volume == pytest.approx(500.0)
    frustum = tapered(square, 0.0, -2.0, 0.0, 3.0)
    assert frustum is not None
    assert build_solid([Step("add", "a", (frustum,))]).volume == pytest.approx((100 + 36 + 60) * 3 / 3)
    plate = Step("add", "a", (Block(shapely.box(-5, -5, 15, 15), 0.0, 5.0),))
    groove = Groove(square, shapely.box(1, 1, 9, 9), 0.0, 1.0)
    cut = build_solid([plate, Step("cut", "b", (groove,))])
    assert 2000.0 - cut.volume == pytest.approx(100 - (100 + 64 + 80) / 3)
    limited = Step("add", "c", (box_block((0, 0, 4), (40, 10, 8)),), within=shapely.box(-5, -5, 15, 15))
    assert build_solid([plate, limited]).volume == pytest.approx(2000 + 15 * 10 * 3)


def test_a_body_that_falls_apart_is_refused():
    apart = Step("add", "a", (box_block((0, 0, 0), (1, 1, 1)), box_block((5, 0, 0), (6, 1, 1))))
    with pytest.raises(FootError, match="falls into 2 solids"):
        build_solid([apart])


def test_other_dimensions_give_another_solid(small_foot):
    p = ShoeParameters(floor=4.0, pad_thickness=0.0, rim_height=5.0, rim_thickness=1.5, retention="none", scribe=0.0)
    build = build_shoe(small_foot, side="left", parameters=replace(p, board_length=0.0, fillet=0.0, lead_in=0.0))
    shoe = build.shoes[0]
    assert np.ptp(shoe.surface[..., 2]) == pytest.approx(2.5 + 4.0 + 5.0)
