"""Steps found as readings come, against those that the whole recording shows."""

from pathlib import Path

import numpy as np
import pytest

import plantar
from plantar.formats import read_recording
from plantar.gait.analysis.steps.events import find_contacts, force_levels
from plantar.live.step_detector import StepDetector

DEMO = Path(plantar.__file__).parent / "commands" / "small_demo"


def events_of(time, force, kind="robot"):
    detector = StepDetector(kind)
    return [event for at, load in zip(time.tolist(), force.tolist(), strict=True) for event in detector.take(at, load)]


@pytest.mark.parametrize("kind", ["robot", "insole"])
def test_events_of_a_walk_are_those_of_the_whole_recording_within_20_ms(kind):
    """Force of 30 steps with two humps, of varying time and weight, at 200 Hz with noise of 2 N."""
    rng = np.random.default_rng(1)
    time = np.arange(0.0, 36.0, 0.005)
    force = np.zeros(len(time))
    for k in range(30):
        begin, lasts = 1.0 + 1.1 * k + rng.normal(0.0, 0.03), 0.68 + rng.normal(0.0, 0.02)
        u = np.clip((time - begin) / lasts, 0.0, 1.0)
        humps = np.minimum(1.0, np.minimum(u, 1.0 - u) / 0.15) * (1.0 - 0.2 * np.sin(np.pi * u) ** 4)
        force += 700.0 * rng.normal(1.0, 0.03) * humps
    force = np.abs(force + rng.normal(0.0, 2.0, len(time)))
    contacts = [c for c in find_contacts(time, force, force_levels(force, kind)) if c.complete]
    events = events_of(time, force)
    assert len(contacts) == 30
    for name, wanted in (("strike", [c.heel_strike for c in contacts]), ("off", [c.toe_off for c in contacts])):
        found = np.array([event.time for event in events if event.kind == name])
        assert len(found) == len(wanted)
        assert np.abs(found[2:] - wanted[2:]).max() < 0.020  # the first shows how heavy the walker is
    assert max(event.delay for event in events if event.kind == "strike") < 0.05
    assert max(event.delay for event in events if event.kind == "off") < 0.11


def test_recorded_walks_have_the_same_steps():
    compared = 0
    for path in sorted(DEMO.iterdir()):
        if path.suffix not in (".mcap", ".csv", ".asc", ".npz"):
            continue
        recording = read_recording(path)
        for foot in recording.feet.values():
            force = foot.vertical_force
            contacts = [
                c for c in find_contacts(recording.time, force, force_levels(force, recording.kind)) if c.complete
            ]
            events = events_of(recording.time, force, recording.kind)
            off = []
            for name, wanted in (("strike", [c.heel_strike for c in contacts]), ("off", [c.toe_off for c in contacts])):
                found = np.array([event.time for event in events if event.kind == name])
                off += [np.abs(found - at).min() for at in wanted[1:]]
            compared += len(off)
            assert np.median(off) < 0.02 + 1.0 / recording.rate_hz
    assert compared > 10


def test_what_is_no_step_is_none():
    assert events_of(np.arange(1000) / 100, np.abs(np.random.default_rng(0).normal(0.0, 1.0, 1000))) == []
    assert StepDetector().take(0.0, float("nan")) == []
    standing = events_of(np.arange(1000) / 100, np.full(1000, 400.0))
    assert [event.kind for event in standing] == ["strike"]
