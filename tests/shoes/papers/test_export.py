"""Tests of the exported files."""

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
import trimesh

from plantar import read_layout
from plantar.errors import InputError
from plantar.shoes import build_shoe, export_shoe
from plantar.shoes.checks import check
from plantar.shoes.checks.printability import Weights
from plantar.shoes.foot.mesh_file import read_mesh
from plantar.shoes.papers.bill import bill_of_parts
from plantar.shoes.parameters import ShoeParameters, read_parameters
from plantar.shoes.plan.wiring import channel_lines, length_of
from plantar.shoes.solid.step_model import read_step


def test_every_file_is_there_and_says_the_same(exported):
    report, folder = exported
    assert sorted(report.files) == sorted(f.name for f in folder.iterdir())
    assert len(report.files) == 2 * 12 + 4
    figures = json.loads((folder / "check.json").read_text())
    assert figures == json.loads(json.dumps(report.as_dict()))
    assert figures["holds"] is True
    p = report.build.parameters
    for side in ("left", "right"):
        mesh = trimesh.load(folder / f"shoe_{side}.stl", force="mesh")
        assert mesh.is_watertight
        assert mesh.volume / 1000 == pytest.approx(figures["sides"][side]["volume_cm3"], rel=5e-3)
        np.testing.assert_allclose(mesh.extents, figures["sides"][side]["size_mm"], atol=2e-3)
        assert mesh.bounds[0, 2] == pytest.approx(p.bottom)
        solid = read_step(folder / f"shoe_{side}.step")
        assert solid.valid
        assert solid.volume == pytest.approx(mesh.volume, rel=5e-3)
        triangles, unit = read_mesh(folder / f"shoe_{side}.3mf")
        assert unit == "mm"
        same = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles))
        assert same.is_watertight
        assert same.volume == pytest.approx(mesh.volume, rel=1e-5)
        pad = trimesh.load(folder / f"pad_{side}.stl", force="mesh")
        assert pad.is_watertight
        assert pad.bounds[:, 2] == pytest.approx([0.0, p.bottom - p.pad_relief], abs=1e-6)
        for name in (f"drawing_{side}.png", f"picture_{side}.png"):
            assert (folder / name).read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
        assert (folder / f"drawing_{side}.pdf").read_bytes().startswith(b"%PDF")


def test_the_layout_tells_a_simulator_of_the_shoe(exported):
    report, folder = exported
    for side in ("left", "right"):
        layout = read_layout(folder / f"layout_{side}.json")
        assert (layout.side, len(layout)) == (side, len(report.build.shoes[0].layout))
        pad = trimesh.load(folder / f"pad_{side}.stl", force="mesh")
        low = layout.outline.min(axis=0) * 1000
        high = layout.outline.max(axis=0) * 1000
        np.testing.assert_allclose(pad.bounds[:, :2], [low, high], atol=2e-3)
        told = json.loads((folder / f"layout_{side}.json").read_text())["shoe"]
        assert told["thickness"] == pytest.approx(report.build.parameters.thickness / 1000)
        weights = report.weights[side]
        assert told["mass"] == pytest.approx(weights.total / 1000, abs=1e-6)
        assert told["mass_printed"] == pytest.approx(report.checks[side].mass_g / 1000, abs=1e-5)
        assert weights.pad == pytest.approx(pad.volume / 1000 * 0.32, rel=1e-3)
        assert told["connectors"] == [int(layout.ids[i]) for i in report.build.shoes[0].plan.connectors]
        assert len(told["cable_route"]) == len(layout) - len(told["connectors"])


def test_the_bill_lists_what_a_shoe_needs(exported):
    report, folder = exported
    rows = list(csv.DictReader(io.StringIO((folder / "parts.csv").read_text())))
    left = {row["part"]: row for row in rows if row["side"] == "left"}
    assert set(left) == {"shoe, left", "pad, left", "taxel", "connection board", "cable", "adhesive", "strap"}
    assert int(left["taxel"]["quantity"]) == len(report.build.shoes[0].layout)
    assert float(left["shoe, left"]["mass_g"]) == report.checks["left"].mass_g
    assert left["shoe, left"]["material"] == "PA12"


def test_the_cable_of_the_bill_reaches_the_board_through_a_floor_of_any_thickness(small_foot):
    lengths = []
    for floor in (5.0, 30.0):
        build = build_shoe(small_foot, side="left", layout_only=True, parameters=ShoeParameters(floor=floor))
        (shoe,) = build.shoes
        p = build.parameters
        (cable,) = (q for q in bill_of_parts(shoe, build, Weights(0.0, 0.0, 0.0, 0.0)) if q.part == "cable")
        lengths.append(float(cable.size.removesuffix(" mm or longer")))
        channel = length_of(channel_lines(shoe.plan, p)[0])
        assert lengths[-1] >= channel + p.thickness - p.bottom
    assert lengths[1] - lengths[0] == pytest.approx(25.0)


def test_a_report_gives_the_same_shoe_again(exported):
    report, folder = exported
    assert read_parameters(folder / "check.json") == report.build.parameters


def cell_area_of(exported) -> float:
    """Area in mm^2 of the cells of the shoes that all tests share."""
    return round(1e6 * exported[0].build.shoes[0].layout.cell_area, 6)


@pytest.mark.long
def test_the_same_foot_gives_the_same_bytes(small_foot, exported, tmp_path):
    export_shoe(build_shoe(small_foot, side="right", cell_area=cell_area_of(exported)), tmp_path)
    for path in tmp_path.iterdir():
        if path.name not in ("assembly.html", "check.json", "parts.csv", "wiring.csv"):  # which list both sides there
            assert path.read_bytes() == (exported[1] / path.name).read_bytes(), path.name


def test_the_same_foot_gives_the_same_layout_to_the_last_bit(small_foot, exported):
    (again,) = build_shoe(small_foot, side="right", cell_area=cell_area_of(exported), layout_only=True).shoes
    (before,) = (shoe for shoe in exported[0].build.shoes if shoe.side == "right")
    for name in ("positions", "rotations", "vertices", "areas", "outline", "ids"):
        assert getattr(again.layout, name).tobytes() == getattr(before.layout, name).tobytes(), name


def test_only_layouts_are_written_where_only_they_were_asked_for(small_foot, tmp_path):
    report = export_shoe(build_shoe(small_foot, layout_only=True), tmp_path)
    assert sorted(f.name for f in tmp_path.iterdir()) == ["layout_left.json", "layout_right.json"]
    assert report.holds
    assert "watertight" not in report.as_dict()
    assert report.as_dict()["taxels"] == len(report.build.shoes[0].layout)
    told = json.loads((tmp_path / "layout_left.json").read_text())["shoe"]
    assert told["thickness"] == ShoeParameters().thickness / 1000
    assert "mass" not in told


def test_a_face_that_reaches_too_far_beyond_the_foot_is_no_good_layout_either(small_foot, tmp_path):
    tight = ShoeParameters(overhang_max=1.0)
    near = build_shoe(small_foot, side="left", layout_only=True, cell_area=400.0, parameters=tight)
    assert near.shoes[0].plan.overhang > 1.1
    report = export_shoe(near, tmp_path)
    assert [c.name for c in report.plan_checks["left"] if not c.holds] == ["overhang, mm"]
    assert not report.holds


def test_a_missing_folder_is_refused(small_foot, tmp_path):
    with pytest.raises(InputError, match="cannot write"):
        export_shoe(build_shoe(small_foot, layout_only=True), tmp_path / "none")


def test_every_figure_of_a_report_has_its_unit_limit_and_source_in_the_docs(exported, repository):
    """The names of all checks, and of all other figures, stand in the tables of docs/shoes.md."""
    _, folder = exported
    text = (repository / "docs" / "shoes.md").read_text()
    part = text.split("### What `check.json` states")[1].split("### The table `shoe`")[0]
    rows = [[c.strip() for c in line.split("|")[1:-1]] for line in part.splitlines() if line.startswith("|")]
    assert all(len(row) in (3, 4) and all(row) for row in rows)
    named = " ".join(row[0] for row in rows)
    names = re.findall(r'(?:Check|_least|_most)\(\s*f?"([^"]+)"', Path(check.__file__).read_text())
    assert len(names) > 25
    for name in names:  # the words before the unit, and before what differs from shoe to shoe
        words = name.split("{")[0].removesuffix(" the ").split(",")[0].strip()
        assert words in named, name
    figures = json.loads((folder / "check.json").read_text())
    keys = keys_of(figures | {"parameters": None}) - {"left", "right"}  # parameters have their own table
    told = {name for row in rows if len(row) == 3 for name in re.findall(r"`(\w+)`", row[0])}
    assert keys == told


def keys_of(value: object) -> set[str]:
    """Names of all figures in JSON values, at any depth."""
    if isinstance(value, dict):
        return set(value).union(*(keys_of(v) for v in value.values()))
    return set().union(*(keys_of(v) for v in value)) if isinstance(value, list) else set()
