"""What a folder of output holds, and files and values that no writer should fail at."""

import os
import sys
from contextlib import suppress

import numpy as np
import pytest

from plantar import PlantarError
from plantar.gait.analysis.analyse_one import analyse_recording
from plantar.gait.analysis.study.run_study import run_study

TIME = np.arange(0.0, 8.0, 0.01)
LEFT = 700.0 * np.clip(np.sin(2.0 * np.pi * TIME) + 0.3, 0.0, None)
RIGHT = np.roll(LEFT, 50)
NAMES = ("left Fz (N),right Fz (N)", "left 1 (N),right 1 (N)", "left 1,right 1", "FP1 Fz (N),FP2 Fz (N)")


def write(path, names=NAMES[1], left=LEFT, right=RIGHT):
    rows = np.column_stack([TIME, left, right]).tolist()
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(f"time (s),{names}\n" + "\n".join(",".join(map(repr, row)) for row in rows) + "\n")


def test_a_folder_holds_one_analysis(tmp_path):
    write(tmp_path / "one.csv")
    write(tmp_path / "two.csv", left=1.2 * LEFT)
    out = tmp_path / "out"
    analyse_recording(tmp_path / "one.csv", out)
    (out / "notes.txt").write_text("mine")
    assert (out / "force.png").is_file()
    found = analyse_recording(tmp_path / "two.csv", out, figures=False)
    assert sorted(p.name for p in out.iterdir()) == ["metrics.json", "notes.txt", "steps.csv"]
    assert all(os.path.isfile(name) for name in found["files"])


def test_figures_in_a_folder_that_no_analysis_wrote_stay(tmp_path):
    write(tmp_path / "one.csv")
    (tmp_path / "force.png").write_bytes(b"mine")
    analyse_recording(tmp_path / "one.csv", tmp_path, figures=False)
    assert (tmp_path / "force.png").read_bytes() == b"mine"


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has names of any bytes")
def test_a_name_of_a_file_may_be_of_any_bytes(tmp_path):
    folder = tmp_path / "study"
    folder.mkdir()
    path = folder / os.fsdecode(b"walk\xff\xe9.csv")
    write(path)
    analyse_recording(path, tmp_path / "out")
    assert "walk" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    run_study(folder, tmp_path / "all")
    assert (tmp_path / "all" / "study.html").is_file()


@pytest.mark.sample(8)
@pytest.mark.parametrize("value", [np.inf, -np.inf, 1e308, -1e308, 1e155, 5e-324, -0.0])
@pytest.mark.parametrize("names", NAMES)
def test_values_that_no_sensor_gives_were_not_measured(tmp_path, value, names):
    path = tmp_path / "walk.csv"
    for at in (250, slice(100, 400, 37)):
        left = LEFT.copy()
        left[at] = value
        write(path, names, left)
        found = analyse_recording(path, tmp_path / "out", figures=False)
        key = "peak_force_raw" if names == NAMES[2] else "peak_force_N"
        assert found["feet"]["left"]["measures"][key]["mean"] == pytest.approx(LEFT.max(), rel=0.02)


@pytest.mark.parametrize("value", [np.inf, 1e308, -1e308, 1e155])
def test_a_foot_of_such_values_alone_ends_in_a_report_or_one_line(tmp_path, value):
    for names in NAMES:
        write(tmp_path / "walk.csv", names, np.full_like(LEFT, value))
        with suppress(PlantarError):
            analyse_recording(tmp_path / "walk.csv", tmp_path / "out", figures=False)
