"""One value that stands apart from all others is a mark for what was not measured; what a sensor can read is none."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.formats.plausibility import without_marks
from plantar.recordings.pressure_recording import PressureRecording

from .test_plausibility import steps, with_force


def marked(mark: float, lost: np.ndarray, layout: bool) -> tuple[PressureRecording, np.ndarray]:
    """Steps with a mark (Pa, or N without a layout) where something was lost, and their true forces."""
    recording = steps()
    foot = recording.feet["left"]
    force = np.where(lost, mark * (foot.layout.areas if layout else 1.0), foot.force)
    recording = with_force(recording, force)
    if not layout:
        recording = replace(recording, feet={"left": replace(recording.feet["left"], layout=None)})
    return recording, foot.force


def lost_somewhere(kind: str, shape: tuple[int, ...]) -> np.ndarray:
    rng = np.random.default_rng(4)
    lost = np.zeros(shape, dtype=bool)
    if kind == "anywhere":
        return rng.random(shape) < 0.001
    if kind == "a cell":
        lost[:, 40] = True
    elif kind == "frames":
        lost[200:230] = True
    else:
        lost[[100, 101, 500], [3, 3, 60]] = True
    return lost


@pytest.mark.parametrize("kind", ["anywhere", "a cell", "frames", "three"])
@pytest.mark.parametrize(
    ("mark", "layout"), [(9999e3, True), (-999e3, True), (-1e4, True), (65535.0, False), (-999.0, False)]
)
def test_a_mark_counts_as_not_measured(mark, layout, kind):
    shape = steps().feet["left"].force.shape
    lost = lost_somewhere(kind, shape)
    recording, true = marked(mark, lost, layout)
    found = without_marks(recording)
    foot = found.feet["left"]
    assert np.array_equal(np.isnan(foot.force), lost)
    assert np.array_equal(foot.force[~lost], true[~lost])
    (warning,) = found.warnings
    assert warning.startswith(f"{lost.sum()} value(s) of the left foot are ")
    assert ("kPa" in warning) == layout


def test_a_mark_above_and_one_below():
    recording, _ = marked(9999e3, lost_somewhere("anywhere", steps().feet["left"].force.shape), True)
    foot = recording.feet["left"]
    force = foot.force.copy()
    force[::50, 7] = -500e3 * foot.layout.areas[7]
    assert len(without_marks(with_force(recording, force)).warnings) == 2


@pytest.mark.parametrize("what", ["peaks", "clipped", "two", "switch", "noise", "floor", "small", "quantum"])
def test_what_a_sensor_reads_is_no_mark(what):
    recording = steps()
    foot = recording.feet["left"]
    areas, value = foot.layout.areas, foot.force / foot.layout.areas
    rng = np.random.default_rng(1)
    top = value.max()
    if what == "peaks":  # one cell that really carries a lot, differently in each step
        value[:, 5] *= 20.0 * top / value[:, 5].max()
    elif what == "clipped":
        value = np.minimum(value, 0.2 * top)
    elif what == "two":
        value[[300, 301], 9] = 50.0 * top
    elif what == "switch":
        value = np.where(value > 0.2 * top, top, 0.0)
    elif what == "noise":
        value += rng.normal(0.0, 5e3, value.shape)
    elif what == "floor":
        value = np.maximum(value - 0.3 * top, -0.1 * top)
    elif what == "small":
        value[:, 3] = -1e3
    else:  # noise in steps of the digital converter
        value = np.round((value + rng.normal(0.0, 4e3, value.shape)) / 5e3) * 5e3
    recording = with_force(recording, value * areas)
    assert without_marks(recording) is recording


def test_an_empty_recording_has_none():
    recording = steps()
    assert without_marks(with_force(recording, recording.feet["left"].force[:0])).warnings == ()
