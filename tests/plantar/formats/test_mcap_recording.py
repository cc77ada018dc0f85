"""The project's own recordings, read as plantar pressure."""

from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError, hex_layout, mirrored
from plantar.formats import read_recording
from plantar.layouts.layout import SoleLayout
from plantar.recordings.recorder import Recorder


@pytest.fixture
def layout():
    return hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])


def write(path: Path, layouts: dict[str, SoleLayout], sides: tuple[str, ...], taxels: int) -> np.ndarray:
    force = np.random.default_rng(1).uniform(0, 20, size=(100, taxels))
    with Recorder(path, {"robot": "h1"}, layouts) as recorder:
        channels = [recorder.channel(f"/skin/{side}", [("force", taxels), ("proximity", 2)]) for side in sides]
        for i, row in enumerate(force):
            for channel in channels:
                channel.write(i * 0.004, np.concatenate([row, [0.05, 0.05]]))
    return force


def test_two_soles(tmp_path, layout):
    layouts = {"left": layout, "right": mirrored(layout)}
    force = write(tmp_path / "run.mcap", layouts, ("left", "right"), len(layout))
    recording = read_recording(tmp_path / "run.mcap")
    assert (recording.format, recording.metadata["robot"]) == ("mcap", "h1")
    assert recording.rate_hz == pytest.approx(250.0)
    assert recording.warnings == ()
    assert (recording.feet["right"].force == force).all()
    assert recording.feet["left"].layout is not None
    assert recording.feet["left"].vertical_force == pytest.approx(force.sum(axis=1))


def test_a_sole_that_joins_late_and_pauses_was_not_measured_then(tmp_path, layout):
    n = len(layout)
    with Recorder(tmp_path / "run.mcap", {"kind": "insole"}, {"left": layout, "right": mirrored(layout)}) as recorder:
        left, right = (recorder.channel(f"/skin/{side}", [("force", n)]) for side in ("left", "right"))
        for i in range(100):
            if i < 80:
                left.write(0.01 * i, np.full(n, 1.0))
            if i >= 30 and not 50 <= i < 60:
                right.write(0.01 * i + 0.004, np.full(n, 2.0))
    recording = read_recording(tmp_path / "run.mcap")
    assert recording.kind == "insole"
    time, left, right = recording.time, *(recording.feet[side].vertical_force for side in ("left", "right"))
    assert time[-1] == pytest.approx(0.994)
    assert (np.isfinite(left) == (time < 0.792)).all()
    assert (np.isfinite(right) == ((time > 0.303) & ~((time > 0.495) & (time < 0.603)))).all()


def test_one_sole_without_layout_says_so(tmp_path, layout):
    write(tmp_path / "run.mcap", {}, ("right",), len(layout))
    recording = read_recording(tmp_path / "run.mcap")
    assert recording.feet["right"].pressure() is None
    assert recording.feet["right"].center_of_pressure(1.0) is None
    assert any("--layout" in w for w in recording.warnings)
    assert "the recording holds the right foot only" in recording.warnings
    given = read_recording(tmp_path / "run.mcap", layout=layout).feet["right"].layout
    assert given.side == "right"


def test_a_recording_without_skin_names_its_topics(tmp_path):
    with Recorder(tmp_path / "run.mcap") as recorder:
        recorder.channel("/joints", [("position", 2)]).write(0.0, np.zeros(2))
    with pytest.raises(FormatError, match=r"no taxel forces .* its topics: /joints"):
        read_recording(tmp_path / "run.mcap")


def test_a_layout_of_another_size_is_refused(tmp_path, layout):
    write(tmp_path / "run.mcap", {"left": layout}, ("left",), 5)
    with pytest.raises(FormatError, match="5 cells"):
        read_recording(tmp_path / "run.mcap")


def test_a_frame_that_is_written_twice_counts_once(tmp_path, layout):
    """A run writes its first instant when it begins and again with its first tick: nothing of that is damage."""
    path = tmp_path / "run.mcap"
    with Recorder(path, {}, {"left": layout}) as recorder:
        channel = recorder.channel("/skin/left", [("force", len(layout))])
        for i, t in enumerate([0.0, 0.0, *(0.004 * np.arange(1, 60))]):
            channel.write(t, np.full(len(layout), float(i)))
    recording = read_recording(path)
    assert not any("damaged" in w for w in recording.warnings)
    assert recording.time == pytest.approx(0.004 * np.arange(60))
    assert recording.feet["left"].force[:3, 0].tolist() == [1.0, 2.0, 3.0]
