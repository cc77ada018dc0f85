"""Tests of coupons: pieces of the shoe, met by rays where the shoe is."""

import numpy as np
import pytest
import shapely
import trimesh

from plantar.errors import InputError
from plantar.shoes import build_shoe
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.coupon import build_coupons, write_coupons
from plantar.shoes.foot.foot import foot_from_dimensions

from .shoe_witness import hits


def test_coupons_are_what_rays_meet_in_the_shoe(exported, tmp_path):
    report, folder = exported
    whole = np.asarray(trimesh.load(folder / "shoe_left.stl", force="mesh").triangles)
    coupons = build_coupons(report.build)
    assert [c.name for c in coupons] == ["cell", "lug"]
    assert write_coupons(coupons, tmp_path) == ("coupon_cell.stl", "coupon_lug.stl")
    chance, up = np.random.default_rng(3), np.array([0.0, 0.0, 1.0])
    mark = report.build.parameters.thickness
    for coupon in coupons:
        mesh = trimesh.load(tmp_path / f"coupon_{coupon.name}.stl", force="mesh")
        assert mesh.is_watertight
        assert mesh.body_count == 1
        within = coupon.window.buffer(-0.1)
        met = 0
        for point in chance.uniform(within.bounds[:2], within.bounds[2:], (150, 2)):
            if not within.contains(shapely.Point(point)):
                continue
            start = np.array([*point, -1.0])
            mine, shoes = hits(np.asarray(mesh.triangles), start, up), hits(whole, start, up)
            shoes = np.where(np.abs(shoes - 1.0 - mark) < 1.0, mark + 1.0, shoes)  # the mark is not in a coupon
            assert len(mine) == len(shoes)
            assert mine == pytest.approx(shoes, abs=2e-3)
            met += len(mine) > 0
        assert met > 40


def test_a_coupon_is_of_the_left_shoe(small_foot):
    with pytest.raises(InputError, match="a coupon is a piece of the left shoe"):
        build_coupons(build_shoe(small_foot, side="right", layout_only=True))


@pytest.mark.sample(1)
@pytest.mark.parametrize("cell", ["fsr_402_short", "hex", "velostat"])
def test_a_coupon_of_other_cells_has_their_pocket_and_walls_around_it(cell):
    foot = foot_from_dimensions("foot", length=0.2, width=0.09, corner_radius=0.01)
    build = build_shoe(foot, side="left", cell=read_cell(cell), layout_only=True)
    coupon = build_coupons(build)[0]
    plan, p = build.shoes[0].plan, build.parameters
    touched = [pocket for pocket in plan.pockets if coupon.window.contains(pocket.centroid)]
    if cell == "velostat":
        assert 100.0 < coupon.window.intersection(plan.pockets[0]).area < 0.5 * plan.pockets[0].area
        assert coupon.window.difference(plan.pockets[0]).area > 50.0
        assert "sheet" in coupon.text
    else:
        assert coupon.window.buffer(1e-3).covers(touched[0].buffer(p.rib, join_style="mitre"))
        assert ("tail" in coupon.text) == (cell == "fsr_402_short")
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(coupon.surface))
    assert mesh.is_watertight
    if cell == "hex":
        return  # its ribs end in grooves below
    # Just above where the pocket begins there is print around it that a nozzle can lay.
    lines = trimesh.intersections.mesh_plane(mesh, [0.0, 0.0, 1.0], [0.0, 0.0, mesh.bounds[0][2] + 0.2])
    walls = shapely.union_all(list(shapely.polygonize([shapely.LineString(s) for s in lines[:, :, :2].round(6)]).geoms))
    assert walls.buffer(-0.5 * p.wall_min).area > 10.0
