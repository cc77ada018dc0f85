"""Tests of the exported files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from plantar import read_layout
from plantar.errors import InputError
from shoes import Foot, ShoeReport, build_shoe, export_shoe
from shoes.tray import read_step


def test_every_file_is_there_and_says_the_same(exported: tuple[ShoeReport, Path]) -> None:
    report, folder = exported
    assert sorted(report.files) == sorted(f.name for f in folder.iterdir())
    assert len(report.files) == 9
    figures = json.loads((folder / "check.json").read_text())
    assert figures == json.loads(json.dumps(report.as_dict()))
    assert figures["holds"] is True
    for side in ("left", "right"):
        mesh = trimesh.load(folder / f"shoe_{side}.stl", force="mesh")
        assert mesh.is_watertight
        assert mesh.volume / 1000 == pytest.approx(figures["sides"][side]["volume_cm3"], rel=5e-3)
        np.testing.assert_allclose(mesh.extents, figures["sides"][side]["size_mm"], atol=2e-3)
        assert mesh.bounds[0, 2] == 0.0
        solid = read_step(str(folder / f"shoe_{side}.step"))
        assert solid.isValid()
        assert solid.Volume() == pytest.approx(mesh.volume, rel=5e-3)
        layout = read_layout(folder / f"layout_{side}.json")
        assert (layout.side, len(layout)) == (side, figures["taxels"])
        low, high = layout.outline.min(axis=0) * 1000, layout.outline.max(axis=0) * 1000
        np.testing.assert_allclose(mesh.bounds[:, :2], [low, high], atol=2e-3)
        assert (folder / f"drawing_{side}.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_the_same_foot_gives_the_same_bytes(
    small_foot: Foot, exported: tuple[ShoeReport, Path], tmp_path: Path
) -> None:
    export_shoe(build_shoe(small_foot, side="right"), tmp_path)
    for name in ("shoe_right.stl", "shoe_right.step", "layout_right.json", "drawing_right.png"):
        assert (tmp_path / name).read_bytes() == (exported[1] / name).read_bytes(), name


def test_only_layouts_are_written_where_only_they_were_asked_for(small_foot: Foot, tmp_path: Path) -> None:
    report = export_shoe(build_shoe(small_foot, layout_only=True), tmp_path)
    assert sorted(f.name for f in tmp_path.iterdir()) == ["layout_left.json", "layout_right.json"]
    assert report.holds
    assert "watertight" not in report.as_dict()
    assert report.as_dict()["taxels"] == len(report.build.shoes[0].layout)


def test_a_missing_folder_is_refused(small_foot: Foot, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot write"):
        export_shoe(build_shoe(small_foot, layout_only=True), tmp_path / "none")
