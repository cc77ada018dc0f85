"""Times that take both feet, and pauses: what was not measured is not known, and is no time in the air."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.step_times import stride_times
from plantar.recordings.pressure_recording import PressureRecording

from ..walks import made_walk

BOTH = ("double_support_percent", "single_support_percent", "step_time_s")


def without_times(recording: PressureRecording, begin: float, end: float) -> PressureRecording:
    """The recording with nothing of the right foot between two times in s."""
    right = recording.feet["right"]
    force = right.force.copy()
    force[(recording.time >= begin) & (recording.time < end)] = np.nan
    return replace(recording, feet={**recording.feet, "right": replace(right, force=force)})


def test_a_foot_that_was_not_measured_is_not_in_the_air():
    recording = made_walk(strides=9).recording
    truth = analyse_feet(recording)["left"].steps
    cut = analyse_feet(without_times(recording, 4.0, 7.0))["left"].steps
    assert len(cut) == len(truth)
    known = 0
    for step, true in zip(cut, truth, strict=True):
        for key in BOTH:
            assert math.isnan(step[key]) or step[key] == pytest.approx(true[key], nan_ok=True), key
        known += math.isfinite(step["double_support_percent"])
        in_gap = step.heel_strike_s < 7.0 and step.toe_off_s > 4.0
        assert math.isnan(step["double_support_percent"]) or not in_gap
    assert known >= 4


def test_a_foot_that_was_never_measured_is_told_so():
    recording = without_times(made_walk(strides=9).recording, -1.0, 100.0)
    feet = analyse_feet(recording)
    metrics = metrics_of(recording, feet)
    assert "no frame of the right foot was measured: no steps" in metrics["warnings"]
    assert all(math.isnan(step[key]) for step in feet["left"].steps for key in BOTH)


def test_no_step_time_holds_a_pause():
    """The same walk twice, with 20 s between: two feet whose contacts alternate would else have a step of 20 s."""
    recording = made_walk(strides=8).recording
    later = recording.time + recording.time[-1] + 20.0
    twice = {s: replace(foot, force=np.vstack([foot.force, foot.force])) for s, foot in recording.feet.items()}
    for standing in (False, True):
        time = np.concatenate([recording.time, later])
        feet = twice
        if standing:  # measured all the time, on the ground
            between = np.arange(recording.time[-1] + 0.01, later[0] - 0.005, 0.01)
            time = np.concatenate([recording.time, between, later])
            idle = np.zeros((len(between), recording.feet["left"].force.shape[1]))
            feet = {
                s: replace(foot, force=np.vstack([foot.force, idle, foot.force])) for s, foot in recording.feet.items()
            }
        for gait in analyse_feet(replace(recording, time=time, feet=feet)).values():
            times = [step["step_time_s"] for step in gait.steps]
            assert np.nanmax(times) < 0.6


def test_what_both_feet_carry_and_one_alone_make_up_the_stance():
    seen = 0
    for side in ("left", "right"):
        for step in analyse_feet(made_walk(strides=9).recording)[side].steps:
            both, alone = step["double_support_percent"], step["single_support_percent"]
            if math.isnan(both):
                continue
            seen += 1
            assert both > 0.0
            assert alone > 0.0
            assert both + alone == pytest.approx(step["stance_percent"])
            assert step["stance_percent"] == pytest.approx(100.0 * step["contact_time_s"] / step["stride_time_s"])
            assert step["swing_time_s"] == pytest.approx(step["stride_time_s"] - step["contact_time_s"])
    assert seen >= 8


def test_a_walk_that_becomes_a_longer_run_keeps_its_strides():
    """A pause is long beside the strides around it, not beside those of another activity."""
    strides = np.array([1.3] * 6 + [2.6] + [1.3] * 3 + [0.7] * 20 + [1.4] + [0.7] * 6)
    strikes = np.concatenate([[0.0], np.cumsum(strides)])
    contacts = [Contact(float(t), float(t) + 0.3, 10 * i, 10 * i + 5) for i, t in enumerate(strikes)]
    found = np.array(stride_times(contacts)[:-1])
    assert np.flatnonzero(np.isnan(found)).tolist() == [6, 30]
    assert found[np.isfinite(found)] == pytest.approx(strides[np.isfinite(found)])
