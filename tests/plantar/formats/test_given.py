"""Recordings from what a program holds: arrays, mappings and data frames."""

from dataclasses import replace
from datetime import datetime, timedelta, timezone
from typing import Any

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats import ReadOptions
from plantar.formats.given import recording_of
from plantar.recordings.pressure_recording import FootRecording


class Frame:
    """What a data frame of pandas and polars share."""

    def __init__(self, columns: dict[str, Any]) -> None:
        self._columns = columns
        self.columns = list(columns)

    def __getitem__(self, name: str) -> Any:
        return self._columns[name]


def test_a_data_frame_is_read_as_its_table_would_be():
    time = np.arange(300)
    cells = {f"left {i} [N]": np.abs(np.sin(time / 30.0 + i)) * 100.0 for i in (1, 2)}
    recording = recording_of(Frame({"time [ms]": 10 * time, **cells}))
    assert recording.rate_hz == pytest.approx(100.0)
    np.testing.assert_allclose(recording.feet["left"].force, np.column_stack(list(cells.values())))


def test_a_data_frame_of_a_row_a_foot_and_one_of_names_in_parts():
    time, left, right = np.arange(200) / 50.0, np.arange(200.0), np.arange(200.0)[::-1]
    rows = {"time": np.tile(time, 2), "side": np.repeat(["left", "right"], 200), "heel [N]": np.append(left, right)}
    parts = {("left", "heel [N]"): left, ("right", "heel [N]"): right}
    for columns, options in ((rows, ReadOptions()), (parts, ReadOptions(rate_hz=50.0))):
        found = recording_of(Frame(columns), options=options)
        assert found.rate_hz == pytest.approx(50.0)
        for side, force in (("left", left), ("right", right)):
            np.testing.assert_allclose(found.feet[side].vertical_force, force)


def test_arrays_keep_their_values_and_are_not_changed():
    values = np.full((200, 3), 2.0)
    recording = recording_of({"right": values, "unit": "kg"}, options=ReadOptions(rate_hz=50.0))
    assert list(recording.feet) == ["right"]
    np.testing.assert_allclose(recording.feet["right"].force, 2.0 * 9.80665)
    assert values.max() == 2.0


def test_arrays_that_hold_no_load_and_columns_of_times_are_no_cells():
    time, turns = np.arange(0.0, 10.0, 0.01), np.random.default_rng(0).normal(size=(1000, 6))
    left, right = (
        np.clip(np.sin(2.0 * np.pi * (time - late)), 0.0, None)[:, None] + np.zeros(4) for late in (0.0, 0.5)
    )
    beside = {"left_imu": turns, "right_imu": turns, "time": time, "unit": "N"}
    found = recording_of({**beside, "left": left, "right": right})
    np.testing.assert_allclose(found.feet["right"].force, right)
    found = recording_of(np.column_stack([time, left, right])[30:], options=ReadOptions(unit="N"))
    assert found.rate_hz == pytest.approx(100.0)
    np.testing.assert_allclose(found.feet["right"].force, right[30:])


@pytest.mark.parametrize("given", [3, object(), {"left": np.zeros(0)}, np.zeros((2, 0)), [["a"], ["b"]]])
def test_what_holds_no_frames_is_refused(given):
    with pytest.raises((InputError, FormatError)):
        recording_of(given)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"time": np.arange(190) / 50.0}, "'time' holds 190 times for 200 frames"),
        ({"rate_hz": np.array([50.0, 60.0])}, "'rate_hz' is no number"),
        ({"left": np.full((200, 3), 1.0 + 2.0j)}, "'left' holds what is no real number"),
        ({"skin/left/force": np.full((200, 3), 1.0), "metadata": "{cut"}, "'metadata' is no JSON"),
    ],
)
def test_arrays_that_are_there_and_cannot_be_used_are_refused(more, words):
    """Left out, they would make another rate, or one foot of two."""
    with pytest.raises(FormatError, match=words):
        recording_of({"right": np.full((200, 3), 2.0), "unit": "N", **more})


def test_feet_of_plates_are_for_plates(tmp_path):
    np.savez(tmp_path / "walk.npz", left=np.full((200, 3), 2.0), unit="N", rate_hz=50.0)
    with pytest.raises(InputError, match="--plates is for force plates"):
        recording_of(tmp_path / "walk.npz", options=ReadOptions(plates=("left",)))


def test_times_in_milliseconds():
    recording = recording_of({"right": np.full((200, 3), 2.0), "unit": "N", "time": 10.0 * np.arange(200)})
    assert recording.rate_hz == pytest.approx(100.0)
    assert "the times state no unit: ms is assumed" in recording.warnings


STEPS = np.arange(200) * np.timedelta64(20, "ms")
DATES = np.datetime64("2024-10-27T00:59:58", "ms") + STEPS
ZONES = [timezone(timedelta(hours=2 if k < 100 else 1)) for k in range(200)]
ZONED = [datetime.fromisoformat(f"{d}+00:00").astimezone(zone) for d, zone in zip(DATES, ZONES, strict=True)]


@pytest.mark.parametrize(
    "times",
    [
        {"time": 20.0 * np.arange(200), "rate_hz": 50.0},
        {"time": 20_000 * np.arange(200)},
        {"time": 20_000_000 * np.arange(200) + 1_700_000_000_000_000_000},
        {"time_ms": 20 * np.arange(200)},
        {"Timestamp": 0.02 * np.arange(200)},
        {"time": STEPS},
        {"time": DATES},
        {"time": [str(date) for date in DATES]},
        {"time": ZONED},
    ],
)
def test_times_in_any_unit_and_dates_give_the_rate(times, tmp_path):
    """Left out, they would make a recording of 100 Hz, or of 0.05."""
    force = np.full((200, 3), 2.0)
    assert recording_of({"right": force, "unit": "N", **times}).rate_hz == pytest.approx(50.0)
    if not isinstance(next(iter(times.values())), list):
        np.savez(tmp_path / "walk.npz", right=force, unit="N", **times)
        assert recording_of(tmp_path / "walk.npz").rate_hz == pytest.approx(50.0)


@pytest.mark.parametrize("times", [STEPS, DATES, [str(date) for date in DATES], np.array(ZONED)])
def test_a_data_frame_has_dates_as_a_column_or_as_its_index(times):
    cells = {f"left {i} [N]": np.full(200, 2.0) for i in (1, 2)}
    assert recording_of(Frame({"time": np.array(times), **cells})).rate_hz == pytest.approx(50.0)
    frame = Frame(cells)
    frame.index = np.array(times)
    assert recording_of(frame).rate_hz == pytest.approx(50.0)


def test_masked_values_were_not_measured():
    force = np.ma.array(np.random.default_rng(0).uniform(0.0, 20.0, (200, 3)))
    force[::2, 1] = np.ma.masked
    recording = recording_of({"right": force, "unit": "N"}, options=ReadOptions(rate_hz=50.0))
    assert np.isnan(recording.feet["right"].force[::2, 1]).all()
    with pytest.raises(InputError, match="no number"):
        recording_of({"right": [[1.0, 2.0], [3.0]]})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"feet": {}}, "without feet"),
        ({"rate_hz": 25.0}, "do not increase by 1 / 25 s"),
        ({"time": np.arange(200)[::-1] / 50.0}, "do not increase by 1 / 50 s"),
        ({"time": np.arange(190) / 50.0}, "a force for each of 190 times"),
        ({"kind": "sofa"}, "kind is 'sofa'; allowed: insole, platform"),
        ({"feet": {"left": FootRecording("right", np.ones((200, 3)), None)}}, "the left foot is not 'right'"),
        ({"feet": {"left": FootRecording("left", np.full((200, 3), np.inf), None)}}, "infinite forces"),
    ],
)
def test_a_recording_whose_parts_disagree_is_refused(change, words):
    whole = recording_of({"right": np.full((200, 3), 2.0), "unit": "N", "rate_hz": 50.0})
    assert recording_of(whole) is whole
    with pytest.raises(InputError, match=words):
        recording_of(replace(whole, **change))


@pytest.mark.parametrize(
    "stated", [{"rate_hz": 0.0}, {"rate_hz": np.nan}, {"rate_hz": 1e9}, {"mass_kg": -1.0}, {"side": "middle"}]
)
def test_facts_that_cannot_be_are_refused(stated):
    with pytest.raises(InputError, match="allowed"):
        ReadOptions(**stated)
