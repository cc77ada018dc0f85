"""Tests of the wiring list, the cells' outlines and the assembly, on the one shoe that all tests share."""

import csv
import json

import numpy as np
import pytest
import shapely
import trimesh

from plantar.shoes import ShoeParameters, build_shoe, export_shoe
from plantar.shoes.plan.wiring import cable_outlines, hole_outline


def test_each_cell_is_wired_once_from_one_that_is(exported):
    report, folder = exported
    with (folder / "wiring.csv").open() as file:
        rows = [r for r in csv.DictReader(file) if r["side"] == "left"]
    layout = report.build.shoes[0].layout
    assert sorted(int(r["cell"]) for r in rows) == sorted(layout.ids.tolist())
    hops = {r["cell"]: int(r["hop"]) for r in rows}
    for row in rows:
        i = layout.ids.tolist().index(int(row["cell"]))
        np.testing.assert_allclose([float(row["x_mm"]), float(row["y_mm"])], layout.positions[i, :2] * 1e3, atol=1e-3)
        if row["from_cell"]:
            assert hops[row["cell"]] == hops[row["from_cell"]] + 1
            port = np.array([float(row["port_x_mm"]), float(row["port_y_mm"])])
            edge = shapely.Polygon(layout.cell_polygon(i) * 1e3).exterior
            assert edge.distance(shapely.Point(port)) < 0.01
        else:
            assert row["hop"] == "0"


def test_cells_that_are_wired_by_themselves_have_no_route(small_foot):
    build = build_shoe(small_foot, parameters=ShoeParameters(port_width=0.0), layout_only=True)
    assert any("port_width 0" in note for note in build.notes)
    for shoe in build.shoes:
        assert shoe.plan.connectors == shoe.plan.route == ()
        assert not shoe.plan.heel.board
        assert cable_outlines(shoe.plan, build.parameters) == []
        assert hole_outline(shoe.plan, build.parameters).is_empty


@pytest.mark.long
def test_cells_that_are_wired_by_themselves_have_no_ways_for_a_cable_in_any_file(small_foot, tmp_path):
    build = build_shoe(small_foot, side="left", parameters=ShoeParameters(port_width=0.0))
    report = export_shoe(build, tmp_path)
    assert report.holds
    shoe = build.shoes[0]
    with (tmp_path / "wiring.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(shoe.layout)
    assert {r[k] for r in rows for k in ("patch", "hop", "from_cell", "port_x_mm")} == {""}
    told = json.loads((tmp_path / "layout_left.json").read_text())["shoe"]
    assert told["connectors"] == told["cable_route"] == []
    assert report.as_dict()["patches"] == 0
    parts = (tmp_path / "parts.csv").read_text()
    assert "cable" not in parts
    assert "board" not in parts
    mesh, height = trimesh.load(tmp_path / "shoe_left.stl"), build.parameters.ceiling - 0.1
    cut = trimesh.intersections.mesh_plane(mesh, [0, 0, 1], [0, 0, height])[..., :2]
    rings = shapely.polygonize([shapely.union_all(shapely.linestrings(cut), grid_size=1e-4)]).geoms
    assert len(rings) == len(shoe.layout) + 1  # the plate, and each pocket closed all round
