"""Live sources: what comes is what is recorded, and what cannot be is refused in one line."""

import io
import math
import time

import numpy as np
import pytest

from plantar import FormatError, InputError, PlantarError, grid_layout, mirrored
from plantar.commands.live import live
from plantar.formats import ReadOptions, read_recording
from plantar.live import CheckedStream, LiveSource, LiveStream, open_live
from plantar.live.fault_log import KINDS
from plantar.live.record import record
from plantar.recordings.recording import read_mcap
from plantar.sensing.reading import Reading

SOLE = grid_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], pitch=(0.05, 0.05), side="left")


def readings(times, force=2.0):
    for at in times:
        yield "left", Reading(at, np.full(len(SOLE), force))


def stream_of(arrivals, soles=None, kind="robot", **options) -> CheckedStream:
    return CheckedStream(LiveStream(soles or {"left": SOLE}, iter(arrivals), kind), **options)


def lines(monkeypatch, text: str, **options) -> CheckedStream:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    return open_live("lines", SOLE, **options)


NO_FAULTS = dict.fromkeys([*KINDS, "before_start"], 0)


def test_what_comes_is_recorded_and_shown(tmp_path):
    path, shown = tmp_path / "run.mcap", []
    stream = stream_of(readings(np.arange(1000.0, 1004.0, 1 / 64)))
    found = record(stream, path, 2.0, lambda share, text: shown.append((share, text)))
    feet = {"left": {"frames": 129, "rate_hz": 64.0, "gap_max_s": 0.0156}}
    assert found == {"seconds": 2.0, "feet": feet, "faults": NO_FAULTS, "clocks": None}
    foot = read_recording(path).feet["left"]
    assert foot.vertical_force == pytest.approx(np.full(129, 2.0 * len(SOLE)))
    assert foot.layout.positions == pytest.approx(SOLE.positions)
    assert len(shown) == 10
    assert shown[0] == (0.0, f"0.0 s  left {2 * len(SOLE)} N at 0, 0 mm")


def test_a_reading_of_no_sole_is_counted(tmp_path):
    def named():
        return ((side.title() if reading.time == 0.0 else side, reading) for side, reading in readings([0.0, 0.1]))

    found = record(stream_of(named()), tmp_path / "run.mcap")
    assert (found["feet"]["left"]["frames"], found["faults"]["garbled"]) == (1, 1)
    with pytest.raises(InputError, match="a reading is of a sole 'Left'; allowed: left"):
        record(stream_of(named(), strict=True), tmp_path / "run.mcap")


def test_a_recording_begins_with_its_first_reading_and_has_one_clock(tmp_path):
    def both(late: float):
        """The right sole's readings from 10 s on, each before the left one's, whose clock is late."""
        for k in range(100):
            for side, at in (("right", 10.0 + 0.01 * k), ("left", 10.0 + 0.01 * k - late)):
                yield side, Reading(at, np.full(len(SOLE), float(k)))

    soles = {"left": SOLE, "right": mirrored(SOLE)}
    found = record(stream_of(both(0.505), soles), tmp_path / "run.mcap")
    assert found["faults"] == {**NO_FAULTS, "before_start": 51}
    assert {side: foot["frames"] for side, foot in found["feet"].items()} == {"left": 49, "right": 100}
    left = read_mcap(tmp_path / "run.mcap").topics["/skin/left"]
    assert left.time == pytest.approx(0.005 + 0.01 * np.arange(49))
    assert left.fields["force"][:, 0].tolist() == [float(k) for k in range(51, 100)]
    with pytest.raises(InputError, match=r"the left sole got 7 s after 10 s of the right one; .* by one clock"):
        record(stream_of(both(3.0), soles, strict=True), tmp_path / "run.mcap")
    found = record(stream_of(both(3.0), soles), tmp_path / "run.mcap")
    assert {side: foot["frames"] for side, foot in found["feet"].items()} == {"left": 100, "right": 100}
    assert found["faults"]["two_clocks"] == 1
    assert found["clocks"]["right_minus_left_s"] == pytest.approx(3.0, abs=0.01)


def test_a_source_that_gives_something_else_is_named(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="reading is a tuple; expected a Reading"):
        record(stream_of([("left", (0.0, [1.0] * 8))]), tmp_path / "run.mcap")
    mine = LiveSource("mine", "none", lambda address, layout: None)
    monkeypatch.setattr("plantar.live.source.live_sources", lambda: {"mine": mine})
    with pytest.raises(InputError, match="stream of live source 'mine' is None; expected a LiveStream"):
        open_live("mine")


def test_a_device_that_goes_away_ends_the_recording_in_a_line(tmp_path):
    def lost():
        yield from readings([0.0, 0.1, 0.2])
        raise BrokenPipeError(32, "Broken pipe")

    with pytest.raises(InputError, match="the source cannot be read: Broken pipe"):
        record(stream_of(lost()), tmp_path / "run.mcap")
    assert len(read_recording(tmp_path / "run.mcap").time) == 3


def test_lines_of_both_soles_with_missing_taxels(tmp_path, monkeypatch):
    row = ",".join(["1.5"] * (len(SOLE) - 1))
    text = "".join(f"{side},{0.1 * k},{row},{'' if k else 7.0}\n" for k in range(5) for side in ("left", "right"))
    found = record(lines(monkeypatch, text), tmp_path / "run.mcap")
    assert {side: foot["frames"] for side, foot in found["feet"].items()} == {"left": 5, "right": 5}
    force = read_recording(tmp_path / "run.mcap").feet["right"].force
    assert force[0, -1] == 7.0
    assert np.isnan(force[1:, -1]).all()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no reading came"),
        ("left,0.1,1\n", "line 1 holds 1 forces; allowed: 8"),
        ("middle,0.1,1\n", "line 1 begins with 'middle'; allowed: left, right"),
        ("left,now,1\n", "line 1 holds no time and forces"),
        ("left,1,2,3,4,5,6,7,8,9", "no reading came"),  # cut within a line: the last force may be 90
        ("left\n", "line 1 holds no time and forces"),
        ("left,,1,1,1,1,1,1,1,1\n", "'time' is NaN"),
        ("left,0.2,1,1,1,1,1,1,1,1\nleft,0.1,1,1,1,1,1,1,1,1\n", "0.1 s after 0.2 s; allowed: times that go on"),
        ("\0\xff" * 1000 + "\n", "line 1 holds no time"),
    ],
)
def test_lines_that_cannot_be_meant_end_a_strict_recording(text, words, tmp_path, monkeypatch):
    with pytest.raises(PlantarError, match=words):
        record(lines(monkeypatch, text, strict=True), tmp_path / "run.mcap")
    assert (tmp_path / "run.mcap").exists() == text.startswith("left,0.2")


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("hearsay:x", "allowed: file, lines"),
        ("replay", "replay:FILE"),
        ("lines", "--layout"),
        ("lines:x", "stdin"),
    ],
)
def test_a_source_that_cannot_be_opened_is_named(source, words):
    with pytest.raises(InputError, match=words):
        open_live(source)


def test_no_time_to_record_is_refused(tmp_path):
    for seconds in (0.0, -1.0, math.nan):
        with pytest.raises(InputError, match="allowed: above 0"):
            record(stream_of(readings([0.0])), tmp_path / "run.mcap", seconds)


def test_a_recording_is_replayed_at_its_pace(tmp_path):
    record(stream_of(readings([0.0, 0.1, 0.2, 0.3])), tmp_path / "run.mcap")
    began = time.monotonic()
    for k, (side, reading) in enumerate(open_live(f"replay:{tmp_path / 'run.mcap'}").readings):
        assert (side, reading.time) == ("left", pytest.approx(0.1 * k))
        assert time.monotonic() - began >= 0.1 * k


def test_what_measured_is_kept(tmp_path, monkeypatch):
    record(stream_of(readings([0.0, 0.01]), kind="platform"), tmp_path / "run.mcap")
    assert read_recording(tmp_path / "run.mcap").kind == open_live(f"replay:{tmp_path / 'run.mcap'}").kind == "platform"
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO()))
    assert open_live("lines:insole", SOLE).kind == "insole"
    assert open_live("lines", SOLE, kind="platform").kind == "platform"
    with pytest.raises(InputError, match="kind is 'shoe'; allowed: insole, platform"):
        open_live("lines", SOLE, kind="shoe")


def test_a_replayed_recording_and_a_layout_are_not_replaced(tmp_path):
    (tmp_path / "run.mcap").write_text("a walk")
    with pytest.raises(InputError, match="it is what this is made of"):
        live(f"replay:{tmp_path / 'run.mcap'}", output=tmp_path / "run.mcap")
    with pytest.raises(InputError, match="it is what this is made of"):
        live("lines", layout=tmp_path / "run.mcap", output=tmp_path / "run.mcap")
    assert (tmp_path / "run.mcap").read_text() == "a walk"


def test_raw_counts_are_not_replayed_as_newtons(tmp_path):
    np.savez(tmp_path / "raw.npz", left=np.ones((50, len(SOLE))), rate_hz=50.0)
    stream = open_live(f"replay:{tmp_path / 'raw.npz'}", SOLE)
    assert stream.unit == "counts"
    record(stream, tmp_path / "counts.mcap")
    again = read_recording(tmp_path / "counts.mcap")
    assert again.raw
    with pytest.raises(FormatError, match="holds counts; allowed: N for forces, raw for counts"):
        read_recording(tmp_path / "counts.mcap", options=ReadOptions(unit="N"))
    with pytest.raises(InputError, match="the layout holds no calibration"):
        open_live(f"replay:{tmp_path / 'counts.mcap'}", SOLE, counts=True)


def test_ctrl_c_ends_a_recording(tmp_path):
    def stopped():
        yield from readings([0.0, 0.25])
        raise KeyboardInterrupt

    found = record(stream_of(stopped()), tmp_path / "cut.mcap")
    assert found["feet"] == {"left": {"frames": 2, "rate_hz": 4.0, "gap_max_s": 0.25}}
    assert len(read_recording(tmp_path / "cut.mcap").time) == 2
