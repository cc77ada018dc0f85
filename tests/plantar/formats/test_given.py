"""Recordings from what a program holds: arrays, mappings and data frames."""

from typing import Any

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats import ReadOptions
from plantar.formats.given import recording_of


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


def test_arrays_keep_their_values_and_are_not_changed():
    values = np.full((200, 3), 2.0)
    recording = recording_of({"right": values, "unit": "kg"}, options=ReadOptions(rate_hz=50.0))
    assert list(recording.feet) == ["right"]
    np.testing.assert_allclose(recording.feet["right"].force, 2.0 * 9.80665)
    assert values.max() == 2.0


@pytest.mark.parametrize("given", [3, object(), {"left": np.zeros(0)}, np.zeros((2, 0)), [["a"], ["b"]]])
def test_what_holds_no_frames_is_refused(given):
    with pytest.raises((InputError, FormatError)):
        recording_of(given)


@pytest.mark.parametrize(
    "stated", [{"rate_hz": 0.0}, {"rate_hz": np.nan}, {"rate_hz": 1e9}, {"mass_kg": -1.0}, {"side": "middle"}]
)
def test_facts_that_cannot_be_are_refused(stated):
    with pytest.raises(InputError, match="allowed"):
        ReadOptions(**stated)
