"""From the file to the report, and the command."""

import csv
import json
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import FormatError, InputError, LayoutError, cli, write_layout
from plantar.formats import read_recording
from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.analyse import analyse, analyse_recording
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.parameters import analyse_foot
from plantar.plotting import thinned
from plantar.recordings.recorder import Recorder

from ...plantar.formats.corruption import refusals
from .walks import made_walk

FIGURES = ("pressure", "regions", "force", "steps", "symmetry", "wrench", "summary")
FILES = {"metrics.json", "steps.csv", "regions.csv", "report.html", "summary.html"} | {
    f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg")
}


@pytest.fixture
def run(tmp_path, walk):
    """A robot's recording of 8 steps with its truth."""
    made = walk(steps=8, noise=1.4715)
    feet = made.recording.feet
    path = tmp_path / "run.mcap"
    layouts = {side: foot.layout for side, foot in feet.items()}
    with Recorder(path, {"robot": "h1"}, layouts) as recorder:
        channels = {s: recorder.channel(f"/skin/{s}", [("force", f.force.shape[1])]) for s, f in feet.items()}
        for i, t in enumerate(made.recording.time):
            for side, channel in channels.items():
                channel.write(t, feet[side].force[i])
    return path, made


@pytest.mark.drawn
def test_all_outputs_of_a_robot_recording(tmp_path, run):
    path, made = run
    calls: list[float] = []
    result = analyse_recording(path, tmp_path / "out", progress=lambda fraction, text: calls.append(fraction))
    assert {p.name for p in (tmp_path / "out").iterdir()} == FILES
    assert {Path(f).name for f in result["files"]} == FILES
    assert calls == sorted(calls)
    assert calls[-1] == 1.0
    stored = json.loads((tmp_path / "out" / "metrics.json").read_text())
    assert stored == {k: v for k, v in result.items() if k != "files"}
    assert stored["format"] == "mcap"
    assert stored["rate_hz"] == pytest.approx(250.0)
    for side, foot in stored["feet"].items():
        assert foot["steps"] == len(foot["events"]) == 3
        assert np.abs(np.array(foot["landings_s"]) - made.touchdowns[side]).max() < 0.010
        assert len(foot["incomplete"]) == 2
    assert stored["gait"]["landings"] == 8
    rows = list(csv.DictReader((tmp_path / "out" / "steps.csv").read_text().splitlines()))
    assert len(rows) == 6
    strikes = [float(r["heel_strike_s"]) for r in rows]
    assert strikes == sorted(strikes)
    assert {r["side"] for r in rows} == {"left", "right"}


def test_report_stands_alone(tmp_path, run):
    path, _ = run
    strange = path.rename(tmp_path / "a <b> & c.mcap")
    analyse_recording(strange, tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert len(page) < 3_000_000
    assert "a &lt;b&gt; &amp; c.mcap" in page
    assert "<b>" not in page
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page)
    assert "http" not in re.sub(r'base64,[^"]*', "", page).replace("http-equiv", "")
    assert page.count("<img alt=") == page.count("<img ") == len(FIGURES) - 1  # the sheet has its own
    assert "prefers-color-scheme: dark" in page
    assert "@media print" in page


def test_nothing_is_left_behind_on_an_error(tmp_path, run):
    (tmp_path / "bad.asc").write_bytes(b"nonsense")
    with pytest.raises(FormatError):
        analyse_recording(tmp_path / "bad.asc", tmp_path / "out")
    with pytest.raises(LayoutError):
        analyse_recording(run[0], tmp_path / "out", layout=tmp_path / "bad.asc")
    with pytest.raises(InputError, match="is a file"):
        analyse_recording(run[0], tmp_path / "bad.asc")
    assert not (tmp_path / "out").exists()


def test_a_recording_without_steps_still_gives_a_report(tmp_path):
    with Recorder(tmp_path / "still.mcap") as recorder:
        channel = recorder.channel("/skin/left", [("force", 3)])
        for i in range(100):
            channel.write(i * 0.004, np.zeros(3))
    result = analyse_recording(tmp_path / "still.mcap", tmp_path / "out")
    assert result["feet"]["left"]["steps"] == 0
    assert result["gait"]["cadence_steps_per_min"] is None
    assert any("no load above its noise" in w for w in result["warnings"])
    assert "no complete step" in (tmp_path / "out" / "report.html").read_text()


def test_random_corruption_never_breaks_the_analysis(tmp_path, run, share):
    bad = tmp_path / "bad.mcap"
    bad.write_bytes(run[0].read_bytes())

    def read(path):
        recording = read_recording(path)
        feet = {side: analyse_foot(recording, side) for side in recording.feet}
        json.dumps(metrics_of(recording, feet), allow_nan=False)

    trials = round(25 * share)
    assert len(refusals(bad, trials, read)) <= 0.6 * trials


def test_command_prints_one_json_object(tmp_path, run):
    done = CliRunner().invoke(cli.app, ["analyze", str(run[0]), "-o", str(tmp_path / "out"), "--json"])
    assert done.exit_code == 0
    result = json.loads(done.stdout)
    assert list(result["feet"]) == ["left", "right"]
    assert set(result["feet"]["left"]["events"][0]) == {"heel_strike_s", "toe_off_s"}


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["analyze", "bad.asc", "-o", "out"], "known: mcap"),
        (["analyze", "none.asc", "-o", "out"], "cannot be read"),
        (["analyze", "bad.asc", "-o", "out", "--format", "x"], "allowed: mcap, pedar"),
        (["list", "feet"], "allowed: robots, scenes, papers, formats, sources, settings"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(tmp_path, monkeypatch, capfd, arguments, text):
    (tmp_path / "bad.asc").write_bytes(b"\x00" * 100)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["plantar", *arguments])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    stdout, stderr = capfd.readouterr()
    assert ended.value.code == 2
    assert stdout == ""
    assert stderr.startswith("plantar: ")
    assert stderr.count("\n") == 1
    assert text in stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.asc"]


def test_list_names_what_there_is():
    for what, name in (("formats", "pedar"), ("robots", "h1"), ("scenes", "flat")):
        done = CliRunner().invoke(cli.app, ["list", what, "--json"])
        assert done.exit_code == 0
        assert name in [entry["name"] for entry in json.loads(done.stdout)[what]]


def test_analysis_loads_neither_mujoco_nor_cadquery(tmp_path, run):
    """What help and lists load is asked in `test_startup.py`."""
    code = (
        "import atexit, sys, cli\n"
        "heavy = ('mujoco', 'cadquery', 'OCP', 'trimesh', 'mink')\n"
        "atexit.register(lambda: print('LOADED', [m for m in heavy if m in sys.modules]))\n"
        "sys.argv[0] = 'plantar'\n"
        "cli.main()\n"
    )
    command = [sys.executable, "-c", code, "analyze", str(run[0]), "-o", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "LOADED []"


def test_thinned_lines_keep_their_extremes():
    x = np.arange(100_000.0)
    y = np.sin(x / 900.0)
    y[54_321] = 5.0
    few_x, few_y = thinned(x, y)
    assert len(few_x) <= 6002
    assert few_y.max() == 5.0
    assert few_y.min() == y.min()
    assert (np.diff(few_x) > 0).all()


def test_real_pedar_walk_has_9_and_8_complete_steps(tmp_path, real_data):
    path = real_data / "recordings" / "pedar_walk.asc"
    result = analyse_recording(path, tmp_path / "out")
    assert {side: foot["steps"] for side, foot in result["feet"].items()} == {"left": 9, "right": 8}
    assert 600.0 < result["feet"]["right"]["measures"]["peak_force_N"]["mean"] < 1200.0
    assert 85.0 < result["gait"]["cadence_steps_per_min"] < 100.0


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("gain", "lost"), [(0.03, None), (1e9, None), (0.03, "cells"), (1.0, "cells"), (1.0, "all"), (1e9, "all")]
)
def test_odd_recordings_still_give_a_report(tmp_path, gain, lost):
    """Forces of no foot, cells that never measure, and nothing at all: a page and warnings, never an exception."""
    time = np.arange(0.0, 4.0, 0.01)
    phase = ((time - 0.2) % 1.1) / 0.65
    force = np.where(phase < 1.0, 700.0 * gain * np.sin(np.pi * np.clip(phase, 0.0, 1.0)), 0.0)[:, None] * np.full(
        99, 1 / 99
    )
    if lost is not None:
        force[:, : 3 if lost == "cells" else 99] = np.nan
    layout = write_layout(nominal_insole("y", "left"), tmp_path / "layout.json")
    np.savez(tmp_path / "odd.npz", time=time, left=force, unit="N")
    if gain == 0.03:
        np.savez(tmp_path / "none.npz", time=time, left=1e-9 * force, unit="N")
        with pytest.raises(FormatError, match="nobody's load"):
            analyse_recording(tmp_path / "none.npz", tmp_path / "none", layout=layout)
        assert not (tmp_path / "none").exists()
    result = analyse_recording(tmp_path / "odd.npz", tmp_path / "out", layout=layout)
    assert result["feet"]["left"]["steps"] == (0 if lost == "all" else 3)
    assert any("unusual" in w for w in result["warnings"]) == (gain != 1.0 and lost != "all")
    assert (tmp_path / "out" / "report.html").stat().st_size > 10_000


def test_every_form_of_a_walk_gives_the_same_steps(tmp_path, monkeypatch):
    """A file, a folder, a recording, arrays with a layout, and a data frame; `.to_pandas()` holds the same columns."""
    walk = made_walk().recording
    sole = walk.feet["left"].layout
    arrays = {side: foot.force for side, foot in walk.feet.items()}
    (tmp_path / "all").mkdir()
    path = tmp_path / "all" / "walk.npz"
    np.savez(path, time=walk.time, unit="N", **arrays)
    columns = {"time (s)": walk.time} | {
        f"{side} {cell} (N)": force
        for side, foot in arrays.items()
        for cell, force in zip(sole.ids, foot.T, strict=True)
    }
    frame = type("Frame", (), {"columns": list(columns), "__getitem__": lambda self, name: columns[name]})()
    forms = [path, path.parent, walk, {"time": walk.time, "unit": "N", **arrays}, frame]
    found = [analyse(form, layout=sole) for form in forms]
    expected = found[0].steps
    assert len(expected["side"]) > 10
    for one in found[1:]:
        for name in ("side", "contact_time_s", "peak_force_N", "impulse_Ns", "cop_path_m", "peak_pressure_Pa"):
            if expected[name].dtype == object:
                assert one.steps[name].tolist() == expected[name].tolist()
            else:
                np.testing.assert_allclose(one.steps[name], expected[name], rtol=1e-6)
    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=dict))
    assert list(found[0].to_pandas()) == list(expected)
    assert "<html" in found[2].report()


def test_a_single_frame_has_no_steps():
    one = np.full((1, 3), 20.0)
    walk = analyse({"left": one, "right": one, "unit": "N"}, rate_hz=100.0)
    assert [len(foot.steps) for foot in walk.feet.values()] == [0, 0]
