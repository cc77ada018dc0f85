"""Exports are read again, by Plantar and by ezc3d, and say what they hold."""

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import InputError
from plantar.cli import app
from plantar.common.sides import SIDES
from plantar.formats.format import ReadOptions
from plantar.formats.nominal_insole import moticon_insole, nominal_insole
from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.gait.analysis.exports import export_analysis
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.parameters import analyse_feet

from ...fuzz.made_plates import made_laboratory, write_c3d
from .walks import made_walk


@pytest.fixture(scope="module")
def analysis():
    recording = made_walk(strides=3, rate=50.0).recording
    feet = analyse_feet(recording)
    return Analysis(recording, feet, metrics_of(recording, feet))


def test_cells_cut_from_an_outline_are_read_again(tmp_path):
    """Moticon's insole has corners that go round as those of any layout file."""
    recording = made_walk(strides=3, layouts={side: moticon_insole(7, side) for side in SIDES}).recording
    feet = analyse_feet(recording)
    path, _ = export_analysis(Analysis(recording, feet, metrics_of(recording, feet)), tmp_path / "walk.npz")
    again = analyse(path)
    assert not any("layout" in line for line in again.warnings)
    for side, gait in feet.items():
        assert again.feet[side].steps[0]["cop_path_m"] == pytest.approx(gait.steps[0]["cop_path_m"])


def test_a_gap_in_time_is_a_gap_of_a_c3d_file(tmp_path, analysis):
    """The format has no times: half a second that was not recorded must not make all after it early."""
    pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    keep = np.r_[0:100, 125 : len(analysis.recording.time)]
    soles = {s: replace(f, force=f.force[keep]) for s, f in analysis.recording.feet.items()}
    recording = replace(analysis.recording, time=analysis.recording.time[keep], feet=soles)
    feet = analyse_feet(recording)
    path, _ = export_analysis(Analysis(recording, feet, metrics_of(recording, feet)), tmp_path / "walk.c3d")
    again = analyse(path, options=ReadOptions(plates=("left", "right")))
    for side, gait in feet.items():
        steps = again.feet[side].steps
        assert [s.heel_strike_s for s in steps] == pytest.approx([s.heel_strike_s for s in gait.steps], abs=0.03)
        assert [s["peak_force_N"] for s in steps] == pytest.approx([s["peak_force_N"] for s in gait.steps], rel=0.01)


def test_frames_that_were_not_measured_are_no_forces_of_zero(tmp_path, analysis):
    soles = dict(analysis.recording.feet)
    soles["left"] = replace(soles["left"], force=soles["left"].force.copy())
    soles["left"].force[100:125] = np.nan
    recording = replace(analysis.recording, feet=soles)
    feet = analyse_feet(recording)
    path = export_analysis(Analysis(recording, feet, metrics_of(recording, feet)), tmp_path / "walk.mot")[0]
    names, *rows = [line.split("\t") for line in path.read_text().splitlines()[6:]]
    force = np.array([row[names.index("ground_force_left_vy")] for row in rows], dtype=float)
    assert np.flatnonzero(np.isnan(force)).tolist() == list(range(100, 125))


@pytest.mark.parametrize("suffix", [".npz", ".csv"])
def test_what_was_exported_measures_the_same(tmp_path, analysis, suffix):
    files = export_analysis(analysis, tmp_path / "made" / f"walk{suffix}")
    assert [f.name for f in files] == [f"walk{suffix}", f"walk{suffix}.json"]
    layout = nominal_insole("x", "left") if suffix == ".csv" else None
    again = analyse(files[0], options=ReadOptions(layout=layout))
    for side, gait in analysis.feet.items():
        assert again.recording.feet[side].force == pytest.approx(gait.foot.force, rel=1e-8, abs=1e-6)
        for one, other in zip(gait.steps, again.feet[side].steps, strict=True):
            assert other["peak_force_N"] == pytest.approx(one["peak_force_N"], rel=1e-6)
            assert other["cop_path_m"] == pytest.approx(one["cop_path_m"], rel=1e-5)


def test_the_sidecar_says_what_the_file_holds(tmp_path, analysis):
    _, sidecar = export_analysis(analysis, tmp_path / "walk.csv")
    held = json.loads(sidecar.read_text())
    assert held["SamplingFrequency"] == 50.0
    assert held["TaskName"] == "walking"
    assert held["Columns"] == {"left": 99, "right": 99}
    strikes = [e["onset"] for e in held["Events"] if (e["side"], e["trial_type"]) == ("left", "heel_strike")]
    assert strikes == [s.heel_strike_s for s in analysis.feet["left"].steps]


def test_a_c3d_file_has_forces_and_events(tmp_path, analysis):
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    path, _ = export_analysis(analysis, tmp_path / "walk.c3d")
    file = ezc3d.c3d(str(path))
    labels = file["parameters"]["ANALOG"]["LABELS"]["value"]
    force = file["data"]["analogs"][0, labels.index("left.Fz")]
    assert force == pytest.approx(analysis.feet["left"].foot.vertical_force, rel=1e-5, abs=1e-3)
    event = file["parameters"]["EVENT"]
    left = [
        seconds
        for seconds, side, label in zip(
            event["TIMES"]["value"][1], event["CONTEXTS"]["value"], event["LABELS"]["value"], strict=True
        )
        if (side, label) == ("Left", "Foot Strike")
    ]
    assert left == pytest.approx([s.heel_strike_s for s in analysis.feet["left"].steps], abs=1e-4)


def test_a_c3d_file_has_no_centre_of_pressure_without_load(tmp_path, analysis):
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    path, _ = export_analysis(analysis, tmp_path / "walk.c3d")
    file = ezc3d.c3d(str(path))
    cop = analysis.feet["left"].cop
    there = file["data"]["meta_points"]["residuals"][0, 0] >= 0.0
    assert there.tolist() == np.isfinite(cop[:, 0]).tolist()
    written = file["data"]["points"][:2, 0, there].T
    assert written == pytest.approx(cop[there], abs=1e-6)


def test_the_command_exports_beside_its_report(tmp_path, analysis):
    pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    walk, _ = export_analysis(analysis, tmp_path / "walk.npz")
    arguments = ["analyze", str(walk), "-o", str(tmp_path / "out"), "--json", "--figures"]
    done = CliRunner().invoke(app, [*arguments, "--export", "c3d", "--export", "CSV"])
    assert done.exit_code == 0, done.output
    names = {Path(file).name for file in json.loads(done.stdout)["files"]}
    assert {"walk.c3d", "walk.c3d.json", "walk.csv", "walk.csv.json", "report.html"} <= names
    held = json.loads((tmp_path / "out" / "walk.c3d.json").read_text())
    assert held["Sha256"] == hashlib.sha256((tmp_path / "out" / "walk.c3d").read_bytes()).hexdigest()
    for more, message in (
        ([str(walk), "--export", "xls"], "--export is 'xls'; allowed: npz, csv, c3d, mot"),
        (["--compare", str(walk), str(walk), "--export", "npz"], "--export is for one recording"),
        ([str(tmp_path), "--export", "npz"], "--export is for one recording"),
    ):
        wrong = CliRunner().invoke(app, ["analyze", *more, "-o", str(tmp_path / "none")])
        assert message in str(wrong.exception)
    assert not (tmp_path / "none").exists()


def test_other_suffixes_are_refused(tmp_path, analysis):
    with pytest.raises(InputError, match=r"cannot export to 'walk.xls'; allowed: .npz, .csv, .c3d"):
        export_analysis(analysis, tmp_path / "walk.xls")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".c3d", ".mot"])
def test_forces_are_read_back_as_plates(tmp_path, analysis, suffix):
    if suffix == ".c3d":
        pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    path = export_analysis(analysis, tmp_path / f"walk{suffix}")[0]
    assert export_analysis(analysis, tmp_path / f"same{suffix}")[0].read_bytes() == path.read_bytes()
    again = analyse(path, options=ReadOptions(plates=("left", "right") if suffix == ".c3d" else ())).recording
    assert again.kind == "plate"
    for side, gait in analysis.feet.items():
        force = gait.foot.vertical_force
        assert np.abs(again.feet[side].vertical_force - force).max() < 1e-6 * force.max()
        cop, read = gait.foot.center_of_pressure(100.0), again.feet[side].cop
        there = np.isfinite(cop[:, 0])
        axes = read[there] if suffix == ".c3d" else read[there][:, ::-1] * [1.0, -1.0]  # (right, ahead) in OpenSim
        assert np.abs(axes - cop[there]).max() < 1e-5


def test_plates_in_a_table_are_plates_again(tmp_path, analysis):
    """Not insoles of one cell, whose contacts begin at another level."""
    first = analyse(export_analysis(analysis, tmp_path / "walk.mot")[0])
    assert first.recording.kind == "plate"
    path, sidecar = export_analysis(first, tmp_path / "plates.csv")
    assert json.loads(sidecar.read_text())["Columns"] == {"left": 6, "right": 6}
    again = analyse(path)
    assert again.recording.kind == "plate"
    for side, gait in first.feet.items():
        loaded = np.isfinite(gait.foot.center_of_pressure(1.0)[:, 0])
        wrenches = [np.nan_to_num(a.feet[side].foot.wrench)[loaded] for a in (first, again)]
        np.testing.assert_allclose(wrenches[1], wrenches[0], atol=1e-4)
        assert again.feet[side].heel_strikes == pytest.approx(gait.heel_strikes, abs=1e-6)
        assert again.feet[side].toe_offs == pytest.approx(gait.toe_offs, abs=1e-6)


def test_ezc3d_reads_force_platforms(tmp_path, analysis):
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    path, _ = export_analysis(analysis, tmp_path / "walk.c3d")
    plates = ezc3d.c3d(str(path), extract_forceplat_data=True)["data"]["platform"]
    for side, plate in zip(analysis.feet, plates, strict=True):
        force = analysis.feet[side].foot.vertical_force
        assert np.abs(plate["force"][2] - force).max() < 1e-6 * force.max()


def test_opensim_reads_the_motion_file(tmp_path, analysis):
    opensim = pytest.importorskip("opensim", reason="opensim is not installed: pip install opensim")
    motion, loads, _ = export_analysis(analysis, tmp_path / "walk.mot")
    table = opensim.TimeSeriesTable(str(motion))
    for side, gait in analysis.feet.items():
        force = gait.foot.vertical_force
        read = table.getDependentColumn(f"ground_force_{side}_vy").to_numpy()
        assert np.abs(read - force).max() < 1e-6 * force.max()
    assert opensim.ExternalLoads(str(loads), True).getSize() == len(analysis.feet)


def test_an_export_does_not_replace_its_recording(tmp_path):
    np.savez(tmp_path / "walk.npz", left=np.tile(np.sin(np.arange(400) / 10.0).clip(0.0) * 400.0, (2, 1)).T, unit="N")
    before = (tmp_path / "walk.npz").read_bytes()
    with pytest.raises(InputError, match="it is what this is made of"):
        export_analysis(analyse(tmp_path / "walk.npz"), tmp_path / "walk.npz")
    assert (tmp_path / "walk.npz").read_bytes() == before


def test_a_c3d_file_keeps_what_it_held(tmp_path):
    """Markers, channels, parameters and stated events stay; centres of pressure, forces and other events are added."""
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    lab, random = made_laboratory(1)
    write_c3d(tmp_path / "lab.c3d", lab, random, shown="markers")
    walk = analyse(tmp_path / "lab.c3d")
    path, _ = export_analysis(walk, tmp_path / "out.c3d")
    before, after = ezc3d.c3d(str(tmp_path / "lab.c3d")), ezc3d.c3d(str(path))
    points, analogs = (np.array(before["data"][name]) for name in ("points", "analogs"))
    np.testing.assert_array_equal(np.array(after["data"]["points"])[:, : points.shape[1]], points)
    np.testing.assert_array_equal(np.array(after["data"]["analogs"])[:, : analogs.shape[1]], analogs)
    assert set(before["parameters"]) <= set(after["parameters"])
    labels = after["parameters"]["ANALOG"]["LABELS"]["value"]
    for side, gait in walk.feet.items():
        three = [np.array(after["data"]["analogs"])[0, labels.index(f"{side}.F{axis}")] for axis in "xyz"]
        size = np.linalg.norm(np.nan_to_num(gait.foot.wrench[:, :3]), axis=1)
        np.testing.assert_allclose(np.linalg.norm(three, axis=0), size, atol=1e-3 * size.max())
    again = analyse(path)
    for side, gait in walk.feet.items():
        found = [s.heel_strike_s for s in again.feet[side].steps]
        assert found == pytest.approx([s.heel_strike_s for s in gait.steps], abs=1e-6)
        assert again.recording.events[side].heel_strikes == pytest.approx(gait.heel_strikes, abs=1e-3)
