"""Tests of the pad: closed, of the right volume, with a rim beside the taxels."""

import math

import pytest
import shapely
import trimesh

from plantar.shoes import ShoeParameters, build_shoe
from plantar.shoes.cells.cell import Cell
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.plan.shoe_plan import pad_rim
from plantar.shoes.solid.pad import mould_surface, pad_surface, taxel_surfaces
from plantar.shoes.solid.polyhedron import volume_of


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("protrusion", [0.0, 2.5])
def test_the_pad_is_closed_and_encloses_the_taxels(small_foot, side, protrusion):
    build = build_shoe(small_foot, layout_only=True, parameters=ShoeParameters(taxel_protrusion=protrusion))
    p, plan = build.parameters, build.shoes[side].plan
    surface = pad_surface(plan, p)
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(surface))
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    rim = pad_rim(plan, p)
    assert (rim.area > 0.0) == (protrusion > 0.0)
    expected = plan.contact.area * p.pad_thickness + rim.area * p.pad_rim_height
    assert mesh.volume == pytest.approx(expected, rel=1e-5)
    assert volume_of(surface) == pytest.approx(expected, rel=1e-5)
    assert surface[..., 2].max() == pytest.approx(p.bottom - p.pad_relief if protrusion else p.pad_thickness)
    cells = shapely.union_all(plan.cells)
    assert rim.is_empty or rim.distance(cells) == pytest.approx(0.3, abs=0.01)
    assert rim.is_empty or plan.contact.buffer(2e-3).covers(rim)


@pytest.mark.parametrize(("length", "width"), [(0.24, 0.08), (0.2, 0.1), (0.11, 0.07)])
def test_the_taxels_of_a_fine_rim_are_solids_of_their_volumes(length, width):
    """Cut cells with an edge that vanishes where the rib is taken off came out inside out."""
    foot = foot_from_dimensions("foot", length=length, width=width, corner_radius=0.0)
    build = build_shoe(foot, side="left", rim="fine", layout_only=True)
    p, plan = build.parameters, build.shoes[0].plan
    for cell, pocket, surface in zip(plan.cells, plan.pockets, taxel_surfaces(plan, p), strict=True):
        mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(surface))
        assert mesh.is_winding_consistent
        true = cell.area * p.taxel_protrusion + pocket.area * p.pocket_depth
        assert volume_of(surface) == pytest.approx(true, rel=1e-6)


def test_a_films_body_has_its_size_its_tail_and_its_connector(small_foot):
    cell = Cell(shape="round", size=16.0, active=10.0, thickness=0.5, play=0.3, tail_length=9.0, tail_width=6.0,
                connector_length=4.0, connector_height=2.0)  # fmt: skip
    build = build_shoe(small_foot, side="left", cell=cell, layout_only=True)
    p, plan = build.parameters, build.shoes[0].plan
    within = 2.0 * math.sqrt(8.0**2 - 3.0**2)  # of the tail within the disc
    tail = 6.0 * (8.0 + 9.0 - 0.5 * within) - (64.0 * math.asin(3.0 / 8.0) - 3.0 * 0.5 * within)
    for pocket, land, surface in zip(plan.pockets, plan.lands, taxel_surfaces(plan, p), strict=True):
        true = (math.pi * 64.0 + tail) * 0.5 + 4.0 * 6.0 * 1.5
        assert volume_of(surface) == pytest.approx(true, rel=0.02)  # a circle has corners
        assert surface[..., 2].min() == pytest.approx(p.ceiling - 2.0)
        low = surface[surface[..., 2].max(axis=1) < p.ceiling - 0.6]
        connector = shapely.MultiPoint(low.reshape(-1, 3)[:, :2]).convex_hull
        assert connector.area == pytest.approx(24.0, rel=1e-6)
        assert pocket.covers(connector)
        assert connector.distance(land) > 3.0


def test_the_mould_is_what_the_pad_leaves_of_a_block(small_foot):
    build = build_shoe(small_foot, layout_only=True)
    p, plan = build.parameters, build.shoes[0].plan
    mould = trimesh.Trimesh(**trimesh.triangles.to_kwargs(mould_surface(plan, p)))
    assert mould.is_watertight
    assert mould.is_winding_consistent
    height = p.pad_thickness + p.pad_rim_height + 3.0
    block = plan.contact.buffer(6.0, join_style="mitre").area * height
    assert mould.volume + volume_of(pad_surface(plan, p)) == pytest.approx(block, rel=1e-5)
    assert mould.bounds[:, 2] == pytest.approx([0.0, height])
    low, high = plan.contact.bounds[1], plan.contact.bounds[3]
    assert mould.bounds[:, 1] == pytest.approx([-high - 6.0, -low + 6.0], abs=1e-6)  # turned about x
