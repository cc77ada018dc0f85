"""Real recordings against what is known of them; skipped where PLANTAR_REAL_DATA is not set."""

import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import numpy as np
import pytest

from plantar.formats import read_recording
from plantar.gait.analysis.analyse import analyse
from plantar.gait.analysis.steps.swing_levels import swing_levels

from ...plantar.formats.corruption import refusals

EXAMPLES = ("pedar_walk.asc", "emed_step.lst", "fscan_walk_left.asf", "xsensor_walk.csv", "moticon_walk_a.txt")


def vendor_events(report: Path, sheet: int) -> np.ndarray:
    """Initial contact and toe off (n, 2) in s of one foot, from the vendor's report."""
    name = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
    with zipfile.ZipFile(report) as archive:
        root = ElementTree.fromstring(archive.read(f"xl/worksheets/sheet{sheet}.xml"))
    rows = [[(c.findtext(f"{name}v") or "") for c in row] for row in root.iter(f"{name}row")]
    return np.array([[float(r[1]), float(r[2])] for r in rows[1:]])


def test_moticon_events_agree_with_the_vendors(real_data):
    folder = real_data / "recordings"
    analysis = analyse(folder / "moticon_walk_a.txt")
    strides = []
    for side, sheet in (("left", 2), ("right", 3)):
        truth = vendor_events(folder / "moticon_walk_a_report.xlsx", sheet)
        strides += np.diff(truth[:, 0]).tolist()
        foot = analysis.metrics["feet"][side]
        events = np.array([[e["heel_strike_s"], e["toe_off_s"]] for e in foot["events"]])
        assert events.shape == truth.shape  # all of them and no others
        assert np.abs(events[:, 0] - truth[:, 0]).max() < 0.020
        assert np.abs(events[:, 1] - truth[:, 1]).max() < 0.020
        stance = [(e[:-1, 1] - e[:-1, 0]) / np.diff(e[:, 0]) for e in (events, truth)]
        assert abs(float(np.mean(stance[0]) - np.mean(stance[1]))) < 0.01  # of a stride
        assert len(foot["incomplete"]) == 2  # the standing at both ends
        assert foot["missing_percent"] > 0.0
    cadence = analysis.metrics["gait"]["cadence_steps_per_min"]
    assert cadence == pytest.approx(120.0 / np.mean(strides), rel=0.003)


def test_steps_of_the_other_recordings(real_data):
    found = {}
    for name in EXAMPLES:
        metrics = analyse(real_data / "recordings" / name).metrics
        found[name] = {side: foot["steps"] for side, foot in metrics["feet"].items()}
    assert found == {
        "pedar_walk.asc": {"left": 9, "right": 8},
        "emed_step.lst": {"right": 1},
        "fscan_walk_left.asf": {"left": 5},
        "xsensor_walk.csv": {"left": 1, "right": 0},
        "moticon_walk_a.txt": {"left": 7, "right": 7},
    }


def test_the_emed_step_is_a_foot(real_data):
    metrics = analyse(real_data / "recordings" / "emed_step.lst").metrics
    assert metrics["frames"] == 106
    assert metrics["grid"] == {"rows": 95, "columns": 64}
    (foot,) = metrics["feet"].values()
    measures = {k: v["mean"] for k, v in foot["measures"].items()}
    assert measures["peak_force_N"] == pytest.approx(818.63, abs=0.02)
    assert measures["peak_pressure_Pa"] == 370e3
    assert 0.24 < measures["foot_length_m"] < 0.29
    assert 0.20 < measures["arch_index"] < 0.27
    assert 0.0 < measures["foot_progression_deg"] < 20.0
    assert 10.0 < measures["cpei_percent"] < 30.0
    assert set(foot["regions"]) >= {"heel", "midfoot", "forefoot_central", "hallux", "toes"}


def test_the_emed_step_by_another_packages_definitions(real_data):
    """pressuRe's definitions, computed here from the frames: sums times frame time, cells above 0."""
    analysis = analyse(real_data / "recordings" / "emed_step.lst")
    (gait,) = analysis.feet.values()
    (step,) = gait.steps
    pressure, layout = gait.foot.pressure(), gait.foot.layout
    force, frame = pressure @ layout.areas, 1.0 / analysis.recording.rate_hz
    theirs = {
        "peak_pressure_Pa": (pressure.max(), 1e-9),
        "peak_force_N": (force.max(), 1e-9),
        "impulse_Ns": (force.sum() * frame, 0.001),
        "pressure_time_integral_Pas": (pressure.max(axis=1).sum() * frame, 0.005),
        "pressure_time_integral_cell_Pas": (pressure.sum(axis=0).max() * frame, 0.002),
        "contact_area_m2": (((pressure > 0.0) * layout.areas).sum(axis=1).max(), 1e-9),
        "footprint_area_m2": (layout.areas[(pressure > 0.0).any(axis=0)].sum(), 0.005),
        "contact_time_s": ((force > 0.0).sum() * frame, 0.01),
    }
    for key, (value, share) in theirs.items():
        assert step[key] == pytest.approx(value, rel=share), key


@pytest.mark.parametrize(("side", "share"), [("left", 0.065), ("right", 0.017)])
def test_the_pedar_steps_by_another_packages_definitions(real_data, side, share):
    """pressuRe's steps reach from 30 N to 30 N; all that does not depend on where they begin is the same."""
    gait = analyse(real_data / "recordings" / "pedar_walk.asc").feet[side]
    force, pressure, layout = gait.foot.vertical_force, gait.foot.pressure(), gait.foot.layout
    theirs: dict[str, list[float]] = {key: [] for key in ("contact_time_s", "impulse_Ns", "contact_area_m2")}
    for step in gait.used:
        middle = (step.contact.begin + step.contact.end) // 2
        light = np.flatnonzero(force <= 30.0)
        begin, end = light[light < middle][-1] + 1, light[light > middle][0]
        theirs["contact_time_s"].append((end - begin) / 100.0)
        theirs["impulse_Ns"].append(force[begin : end + 1].sum() / 100.0)
        theirs["contact_area_m2"].append(((pressure[begin : end + 1] > 10e3) * layout.areas).sum(axis=1).max())
    ours = {key: np.mean([step[key] for step in gait.used]) for key in theirs}
    assert ours["contact_area_m2"] == pytest.approx(np.mean(theirs["contact_area_m2"]), rel=1e-9)
    assert ours["impulse_Ns"] == pytest.approx(np.mean(theirs["impulse_Ns"]), rel=0.01)
    assert ours["contact_time_s"] == pytest.approx(np.mean(theirs["contact_time_s"]), rel=share)


@pytest.mark.long
@pytest.mark.parametrize("name", EXAMPLES)
def test_a_hundred_corruptions_of_each(real_data, tmp_path, name):
    """Never anything but one clear line or a result; a wrong unit never without a new warning."""
    whole = (real_data / "recordings" / name).read_bytes()
    whole = whole[:300_000] if name != "pedar_walk.asc" else whole  # the first part is as good and faster
    bad = tmp_path / f"bad{Path(name).suffix}"
    bad.write_bytes(whole)
    base = analyse(bad)
    usual = {s: f["measures"]["peak_force_N"]["mean"] for s, f in base.metrics["feet"].items()}

    def read(path):
        metrics = analyse(path).metrics
        json.dumps(metrics, allow_nan=False)
        for side, foot in metrics["feet"].items():
            peak, before = foot["measures"].get("peak_force_N", {}).get("mean"), usual.get(side)
            if peak is not None and before is not None and not 0.7 < peak / before < 1.4:
                assert set(metrics["warnings"]) - set(base.metrics["warnings"]), (side, peak)

    refusals(bad, 100, read, header=3000, seed=17)


@pytest.mark.long
def test_a_long_recording_is_quick_and_small(tmp_path):
    """12 minutes of two 99-cell insoles at 100 Hz, within a fifth of the 12 s and 1 GB of an hour, and a start."""
    random = np.random.default_rng(0)
    path = tmp_path / "long.asc"
    phase = np.arange(110) / 110 / 0.62
    share = np.where(phase < 1, np.sin(np.pi * np.clip(phase, 0, 1)), 0.0)[:, None] * random.uniform(0, 160, (1, 198))
    share[:, 99:] = np.roll(share[:, 99:], 55, axis=0)
    rows = ["\t".join(f"{v:7.3f}" for v in row) + "\t\n" for row in np.round(share / 2.5) * 2.5]
    cells = ",".join(str(i) for i in range(1, 100)) + ","
    n = 12 * 60 * 100
    with path.open("w") as stream:
        stream.write("file name:  x.sol\nsensor type:  y-1865l-1870r \n")
        stream.write(f"total time [secs]:  {n / 100:.3f}\tscanning rate [Hz]:   100\npressure values in  kPa\n\n")
        stream.write(f"mask definition: \nleft insole: {cells}\nright insole: {cells}\n\n")
        stream.write("time[secs]    \t" + "\t".join(f"{i:7d}" for _ in "lr" for i in range(1, 100)) + "\t\n")
        for k in range(n):
            stream.write(f"{(k + 1) / 100:12.5f}\t{rows[k % 110]}")
    code = (
        "import sys, time, cli\n"
        f"sys.argv = ['plantar', 'analyze', {str(path)!r}, '-o', {str(tmp_path / 'out')!r}]\n"
        "try:\n    cli.main()\nexcept SystemExit as end:\n    assert not end.code\n"
        # Not getrusage: there a child's peak is at least what its parent held when it started it.
        "peak = next(line.split()[1] for line in open('/proc/self/status') if line.startswith('VmHWM'))\n"
        "print('USED', time.process_time(), peak)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    _, seconds, kilobytes = done.stdout.splitlines()[-1].split()
    assert float(seconds) < 12.0 / 5.0 + 6.0  # imports and figures do not grow with the recording
    assert float(kilobytes) < 1e6 / 5.0 + 2.5e5


@pytest.mark.parametrize("end", [6.0, 8.0, 9.0, 11.0, 13.0])
def test_an_insole_that_stops_in_mid_load_changes_nothing_before(real_data, end):
    """What is drawn on from its last value is flat, and was taken for a swing at 74 N."""
    recording = read_recording(real_data / "recordings" / "moticon_walk_a.txt")
    right = recording.feet["right"]
    total = right.vertical_force.copy()
    total[recording.time > end] = np.nan
    stopped = swing_levels(total, recording.rate_hz)
    cut = swing_levels(total[recording.time <= end], recording.rate_hz)
    assert (stopped is None) == (cut is None)
    if stopped is not None and cut is not None:
        # One swing more or less at the end: they differ from each other by up to 4 N.
        assert stopped.level[: len(cut.level)] == pytest.approx(cut.level, abs=5.0)
