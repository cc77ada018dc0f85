"""Shoes of other cells than hexagons: built, written, and judged by the witness; and as the command makes them."""

import csv
import json
import sys

import numpy as np
import pytest

from plantar import cli
from plantar.layouts.layout_file import read_layout
from plantar.shoes import ShoeParameters, build_shoe, export_shoe
from plantar.shoes.cells.cell import Cell, read_cell

from .foot_family import prism
from .shoe_witness import Witness

OWN = """shape = "rectangle"
length = 26.0
width = 14.0
active_length = 20.0
active_width = 9.0
thickness = 0.8
"""


@pytest.mark.long
@pytest.mark.parametrize("name", ["own", "fsr_402_short", "velostat", "fx29_25"])
def test_the_witness_finds_nothing_wrong(name, small_foot, tmp_path):
    (tmp_path / "own.toml").write_text(OWN)
    cell = read_cell(str(tmp_path / "own.toml") if name == "own" else name)
    folder = tmp_path / "shoe"
    folder.mkdir()
    build = build_shoe(small_foot, side="left", cell=cell, parameters=ShoeParameters(robot_mass=4.0))
    report = export_shoe(build, folder)
    assert report.holds
    foot = prism(np.array(small_foot.sole.exterior.coords)[:-1], 0.0, 40.0)
    assert Witness(folder, foot).problems() == []
    layout = read_layout(folder / "layout_left.json")
    with (folder / "wiring.csv").open(newline="") as file:
        assert len(list(csv.DictReader(file))) == len(layout)


def test_squares_reach_beyond_a_sole_on_which_they_would_not_see_the_center_of_pressure(small_foot):
    build = build_shoe(small_foot, side="left", cell=Cell(shape="square", size=23.9), layout_only=True)
    assert any("the cells reach up to" in note for note in build.notes)
    assert 0.0 < build.shoes[0].plan.overhang <= build.parameters.overhang_max
    assert np.ptp(build.shoes[0].layout.positions[:, 1]) > 0.5 * 0.07


def test_the_command_writes_a_layout_of_the_stated_cell(monkeypatch, capfd, stl, box, tmp_path):
    own, out = tmp_path / "own.toml", tmp_path / "shoe"
    own.write_text(OWN)
    foot = stl(box((-40, 90), (-35, 35), (0, 50)))
    words = ["plantar", "shoe", str(foot), "--cell", str(own), "--layout-only", "--json", "-o", str(out)]
    monkeypatch.setattr(sys, "argv", words)
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert stop.value.code in (0, None)
    figures = json.loads(capfd.readouterr().out)
    layout = read_layout(out / "layout_left.json")
    assert figures["taxels"] == len(layout) > 10
    np.testing.assert_allclose(layout.areas, 20e-3 * 9e-3, rtol=1e-6)
