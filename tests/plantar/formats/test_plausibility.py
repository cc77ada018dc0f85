"""Doubts about recordings whose sensor was at its end, slower than its file, or of an odd rate."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats.nominal_insole import nominal_insole
from plantar.formats.plausibility import doubts, refuse_small
from plantar.recordings.pressure_recording import FootRecording, PressureRecording


def steps(rate: float = 100.0, resolution: float = 0.0) -> PressureRecording:
    """Ten seconds of steps of a left foot, its load rolling from heel to toes, in N."""
    layout = nominal_insole("x", "left")
    time = np.arange(0.0, 10.0, 1.0 / rate)
    share = np.clip((time % 1.1) / 0.66, 0.0, 1.0)
    near = np.exp(-0.5 * ((layout.positions[:, 0] - 0.25 * (0.1 + 0.8 * share[:, None])) / 0.05) ** 2)
    near *= np.random.default_rng(1).uniform(0.5, 1.5, len(layout))  # no two cells carry the same
    force = 800.0 * np.sin(np.pi * share)[:, None] ** 0.5 * near / near.sum(axis=1, keepdims=True)
    force = np.round(force / resolution) * resolution if resolution else force
    return PressureRecording(Path("x"), "x", rate, time, {"left": FootRecording("left", force, layout)})


def with_force(recording: PressureRecording, force: np.ndarray) -> PressureRecording:
    return replace(recording, feet={"left": replace(recording.feet["left"], force=force)})


@pytest.mark.parametrize("resolution", [0.0, 0.4])
@pytest.mark.parametrize("rate", [25.0, 100.0, 500.0])
def test_a_usual_recording_is_not_doubted(rate, resolution):
    assert doubts(steps(rate, resolution)) == []


def test_loads_that_are_nobodys_are_refused():
    recording = steps()
    refuse_small(with_force(recording, 0.02 * recording.feet["left"].force))
    light = with_force(recording, 0.01 * recording.feet["left"].force)
    refuse_small(replace(light, raw=True))
    with pytest.raises(FormatError, match="no more than 8 N, which is nobody's load; allowed: 10 N or more"):
        refuse_small(light)


def test_cells_at_the_end_of_their_range_are_told():
    recording = steps()
    foot = recording.feet["left"]
    clipped = np.minimum(foot.force, 50e3 * foot.layout.areas)
    (doubt,) = doubts(with_force(recording, clipped))
    assert "cells of the left foot stay at 50 kPa" in doubt


@pytest.mark.parametrize("levels", [0, 1023, 255, 1])
@pytest.mark.parametrize("cells", [99, 6])
def test_cells_at_their_end_are_told_without_a_layout(cells, levels):
    """Also where all cells reach it; forces, or raw counts of so many levels. A switch has two, which is its nature."""
    recording = steps()
    parts = np.array_split(np.arange(99), cells)
    force = np.column_stack([recording.feet["left"].force[:, part].sum(axis=1) for part in parts])
    for most, clipped in ((0.3 * force.max(), levels != 1), (1.001 * force.max(), False)):
        values = np.minimum(force, most)
        values = np.ceil(levels * values / most - 0.05) if levels else values
        foot = replace(recording.feet["left"], force=values, layout=None)
        doubt = " ".join(doubts(replace(recording, feet={"left": foot}, raw=levels > 0)))
        assert ("cells of the left foot stay at " in doubt) == clipped
        assert not clipped or f"stay at {levels or most:.6g}{'' if levels else ' N'}, the largest value" in doubt


def test_the_rest_of_a_sensor_that_counts_down_is_no_end():
    recording = steps()
    force = 1023.0 - np.round(1023.0 * recording.feet["left"].force / recording.feet["left"].force.max())
    foot = replace(recording.feet["left"], force=force, layout=None)
    assert "stay at" not in " ".join(doubts(replace(recording, feet={"left": foot}, raw=True)))


def test_values_that_stand_alone_are_told():
    recording = steps()
    force = recording.feet["left"].force.copy()
    force[[120, 460, 700], 30] += 100.0
    (doubt,) = doubts(with_force(recording, force))
    assert "3 value(s) of the left foot stand alone" in doubt


@pytest.mark.parametrize(("threshold", "told"), [(15e3, 0), (28e3, 1), (40e3, 1)])
def test_cells_that_read_nothing_at_low_load_are_told(threshold, told):
    """Usual thresholds of vendors, up to an eighth of the high readings, move events by less than 20 ms."""
    recording = steps()
    foot = recording.feet["left"]
    force = np.where(foot.force < threshold * foot.layout.areas, 0.0, foot.force)
    found = [doubt for doubt in doubts(with_force(recording, force)) if "reads between 0 and" in doubt]
    assert len(found) == told
    stated = [float(doubt.partition("between 0 and ")[2].split()[0]) * 1e3 for doubt in found]
    assert stated == pytest.approx([threshold] * told, rel=0.05)
    offset = with_force(recording, foot.force + 3.0 * threshold * foot.layout.areas)  # reads no zeros: no threshold
    assert not any("reads between 0 and" in doubt for doubt in doubts(offset))


def test_frames_that_repeat_are_told():
    recording = steps()
    slow = recording.feet["left"].force[np.arange(1000) // 5 * 5]
    (doubt,) = doubts(with_force(recording, slow))
    assert "81 % of the left foot's frames repeat the one before: the sensor gives about 19 new frames" in doubt


def test_a_slow_sensor_is_told():
    assert any("10 frames a second is an unusual rate" in doubt for doubt in doubts(steps(10.0)))


@pytest.mark.parametrize(("wide", "doubted"), [(1.0, 0), (0.8, 0), (0.5, 1), (2.0, 1)])
def test_an_insole_that_is_too_slender_or_too_wide(wide, doubted):
    recording = steps()
    layout = recording.feet["left"].layout
    scale = np.array([1.0, wide])
    other = replace(layout, outline=layout.outline * scale)
    odd = replace(recording, feet={"left": replace(recording.feet["left"], layout=other)})
    assert sum("no foot's shape" in line for line in doubts(odd)) == doubted
    assert not any("no foot's shape" in line for line in doubts(replace(odd, kind="robot")))


@pytest.mark.parametrize("raw", [False, True])
@pytest.mark.parametrize(
    ("lost", "most", "words"),
    [(3, 2e3, "drops to 0 and back within 0.1 s 4 time(s)"), (0, 400.0, "stays at 400{}, its largest value")],
)
def test_a_force_without_cells_that_is_lost_or_at_its_end(lost, most, words, raw):
    recording = steps()
    force = np.minimum(recording.feet["left"].vertical_force, most)
    for begin in (130, 250, 470, 690):
        force[begin : begin + lost] = 0.0
    foot = FootRecording("left", force[:, None], None, total=force)
    found = doubts(replace(recording, feet={"left": foot}, raw=raw, warnings=("raw counts",)))
    assert [words.format("" if raw else " N") in doubt for doubt in found] == [True]
