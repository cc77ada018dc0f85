"""Tests of `plantar shoe` as it is called: files, JSON, exit codes, and nothing left behind."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import cli

Shape = Callable[..., NDArray[np.float64]]
Writer = Callable[..., Path]
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Run:
    """Runs `plantar shoe` with arguments; gives exit code, stdout, stderr."""

    def call(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["plantar", "shoe", *map(str, arguments)])
        code = 0
        try:
            cli.main()
        except SystemExit as stop:
            code = int(stop.code or 0)
        out, err = capfd.readouterr()
        return code, out, err

    return call


def refused(result: tuple[int, str, str], folder: Path) -> str:
    """The one line of a refusal, after checking that nothing else happened."""
    code, out, err = result
    assert code == 2
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("plantar: ")
    assert "Traceback" not in err
    assert not folder.exists()
    return err


def test_a_mesh_gives_files_and_one_json_object(run: Run, stl: Writer, box: Shape, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "shoe"
    code, out, err = run(stl(box((-40, 90), (-35, 35), (0, 50))), "--side", "left", "-o", folder, "--json")
    assert (code, err) == (0, "")
    figures = json.loads(out)
    assert {
        "taxels",
        "covered_area_ratio",
        "watertight",
        "volume_cm3",
        "mass_g",
        "min_wall_mm",
        "size_mm",
        "files",
    } <= set(figures)
    assert figures["watertight"] is True
    assert figures["taxels"] == 8
    assert all(Path(f).is_file() for f in figures["files"])
    assert sorted(p.name for p in folder.iterdir()) == sorted(Path(f).name for f in figures["files"])
    assert any("unit mm" in n for n in figures["notes"])


def test_a_robot_gives_its_layouts(run: Run, tmp_path: Path, repository: Path) -> None:
    code, out, err = run("--robot", "h1", "--layout-only", "-o", tmp_path / "out")
    assert (code, err) == (0, "")
    assert "42 taxels of 691 mm^2" in out
    for side in ("left", "right"):
        made = (tmp_path / "out" / f"layout_{side}.json").read_text()
        stored = (repository / "sim" / "robots" / "h1" / f"layout_{side}.json").read_text()
        np.testing.assert_allclose(json.loads(made)["vertices"], json.loads(stored)["vertices"], atol=1e-6)


def test_a_check_that_does_not_hold_is_exit_1(run: Run, stl: Writer, box: Shape, tmp_path: Path) -> None:
    (tmp_path / "wide.toml").write_text("clearance = 5.0\nrim_thickness = 8.0\n")
    code, out, err = run(
        stl(box((-40, 90), (-35, 35), (0, 50))), "--side", "left", "--parameters", tmp_path / "wide.toml",
        "-o", tmp_path / "out", "--json",
    )  # fmt: skip
    assert code == 1
    assert re.search(r"overhang, mm is 1[3-5]\.\d+, allowed 10 or less", err)
    assert json.loads(out)["holds"] is False
    assert json.loads((tmp_path / "out" / "check.json").read_text())["holds"] is False


def test_bad_meshes_are_refused_in_one_line(run: Run, stl: Writer, box: Shape, tmp_path: Path) -> None:
    good = box((-50, 150), (-40, 40), (0, 60))
    broken = good.copy()
    broken[2, 0, 0] = np.nan
    whole = stl(good, "whole.stl").read_bytes()
    (tmp_path / "cut.stl").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "empty.stl").write_bytes(b"")
    (tmp_path / "foreign.stl").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(500))
    cases = {
        stl(good * 25, "huge.stl"): "fits neither m nor mm",
        stl(good * 0.025, "huge_m.stl"): "fits neither m nor mm",
        stl(broken, "nan.stl"): "not finite",
        stl(good[:2], "two.stl"): "has 2 triangles",
        stl(trimesh.creation.icosphere(radius=60).triangles, "sphere.stl"): "no flat sole",
        stl(box((0, 100), (0, 100), (0, 100)), "cube.stl"): "not a foot",
        tmp_path / "cut.stl": "cut short",
        tmp_path / "empty.stl": "is empty",
        tmp_path / "foreign.stl": "cut short or no STL",
        tmp_path / "missing.stl": "No such file",
    }
    for path, reason in cases.items():
        line = refused(run(path, "-o", tmp_path / "out"), tmp_path / "out")
        assert reason in line
        assert path.name in line


def test_bad_options_are_refused_in_one_line(run: Run, stl: Writer, box: Shape, tmp_path: Path) -> None:
    foot, out = stl(box((-50, 150), (-40, 40), (0, 60))), tmp_path / "out"
    for arguments, reason in (
        ((), "give either a mesh of the foot or --robot"),
        ((foot, "--robot", "h1"), "give either a mesh of the foot or --robot"),
        (("--robot", "h9"), "unknown robot 'h9'; allowed: h1"),
        ((foot, "--side", "up"), "--side is 'up'; allowed: left, right, both"),
        ((foot, "--unit", "furlong"), "--unit is 'furlong'; allowed: m, cm, mm, in"),
        ((foot, "--forward", "z"), "--forward is 'z'; allowed: x, -x, y, -y"),
        ((foot, "--mesh-side", "both"), "--mesh-side is 'both'; allowed: left, right"),
        ((foot, "--cell-area", "0"), "cell area is 0.0 mm^2; allowed: 100 to 5000 mm^2"),
        ((foot, "--cell-area", "nan"), "cell area is nan"),
        ((foot, "--taxels", "0"), "number of taxels is 0"),
        ((foot, "--taxels", "500"), "500 taxels of 691 mm^2 do not fit: at most"),
        ((foot, "--overhang", "-1"), "overhang is -1.0 mm"),
        ((foot, "--sole-z", "nan"), "sole plane is at nan mm"),
        ((foot, "--parameters", tmp_path / "none.toml"), "none.toml cannot be read"),
    ):
        assert reason in refused(run(*arguments, "-o", out), out)


def test_an_output_that_cannot_be_written_is_refused(run: Run, stl: Writer, box: Shape, tmp_path: Path) -> None:
    foot = stl(box((-50, 150), (-40, 40), (0, 60)))
    (tmp_path / "file").write_text("kept")
    code, out, err = run(foot, "--layout-only", "-o", tmp_path / "file")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert (tmp_path / "file").read_text() == "kept"
    code, out, err = run(foot, "--layout-only", "-o", tmp_path / "file" / "below")
    assert (code, out, err.count("\n")) == (2, "", 1)
    if os.geteuid() != 0:  # root writes everywhere
        locked = tmp_path / "locked"
        locked.mkdir(mode=0o500)
        assert run(foot, "--layout-only", "-o", locked / "out")[0] == 2
        assert not list(locked.iterdir())
    assert run(foot, "--layout-only", "-o", "/proc/none")[0] == 2


def test_files_of_others_stay(run: Run, stl: Writer, box: Shape, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "mine.txt").write_text("mine")
    assert run(stl(box((-50, 150), (-40, 40), (0, 60))), "--layout-only", "-o", folder)[0] == 0
    assert sorted(p.name for p in folder.iterdir()) == ["layout_left.json", "layout_right.json", "mine.txt"]
