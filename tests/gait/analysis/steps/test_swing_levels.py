"""Offsets that change from stride to stride: the steps are found all the same, or a warning says what happens."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import grey_opening

from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.gait.analysis.steps.swing_levels import _opened, swing_levels
from plantar.recordings.pressure_recording import PressureRecording

from ..walks import MadeWalk, made_walk

WALKS = {name: made_walk(strides=9, stride=s, stance=p, noise=0.3) for name, s, p in (("walk", 1.1, 0.62),)}
WALKS["run"] = made_walk(strides=9, stride=0.7, stance=0.36, noise=0.3)
WALKS["slow"] = made_walk(strides=9, stride=1.8, stance=0.7, noise=0.3, rate=50.0)
SHAPES = {
    "rises": lambda t: t / t[-1],
    "falls": lambda t: 1.0 - t / t[-1],
    "warms": lambda t: 1.0 - np.exp(-t / 3.0),
    "cools": lambda t: np.exp(-t / 3.0),
    "late": lambda t: (t / t[-1]) ** 4,
    "wanders": lambda t: 0.5 - 0.5 * np.cos(0.8 * np.pi * t / t[-1]),
}


def on_offset(walk: MadeWalk, course: NDArray[np.float64], seed: int = 0) -> PressureRecording:
    """The walk with an offset of a force (n,) in N that is spread unevenly over the cells."""
    uneven = np.random.default_rng(seed).uniform(0.2, 1.8, 99)
    more = course[:, None] * uneven / uneven.sum()
    feet = {side: replace(foot, force=foot.force + more) for side, foot in walk.recording.feet.items()}
    return replace(walk.recording, feet=feet)


def check(walk: MadeWalk, recording: PressureRecording, strike: float = 0.020, lift: float = 0.035) -> None:
    """All steps are found where they are, with their forces, and the offset is told."""
    recording = without_baselines(recording)
    assert sum("in swing" in w for w in recording.warnings) == 2
    for side, gait in analyse_feet(recording).items():
        found = [c for c in gait.contacts if c.complete]
        assert len(found) == len(walk.strikes[side])
        assert np.abs([c.heel_strike for c in found] - walk.strikes[side]).max() < strike
        assert np.abs([c.toe_off for c in found] - walk.lifts[side]).max() < lift
        peaks = [step["peak_force_N"] for step in gait.steps]
        assert peaks == pytest.approx([walk.recording.feet[side].vertical_force.max()] * len(peaks), rel=0.04)


@pytest.mark.sample(12)
@pytest.mark.parametrize("force", [80.0, 300.0, -150.0])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", ["walk", "run"])
def test_steps_on_an_offset_that_changes_quickly(name, shape, force):
    walk = WALKS[name]
    check(walk, on_offset(walk, force * SHAPES[shape](walk.recording.time)))


@pytest.mark.parametrize("shape", ["rises", "cools"])
def test_slow_steps_on_an_offset_that_changes_quickly(shape):
    check(WALKS["slow"], on_offset(WALKS["slow"], 150.0 * SHAPES[shape](WALKS["slow"].recording.time)))


@pytest.mark.parametrize("at", [0.3, 0.42, 0.55])
@pytest.mark.parametrize("force", [100.0, 250.0, -100.0])
def test_an_offset_that_jumps(force, at):
    """In swing or in the middle of a step; one that falls just where a foot lands or lifts moves that event."""
    walk = WALKS["walk"]
    check(walk, on_offset(walk, force * (walk.recording.time > at * walk.recording.time[-1])), 0.03, 0.045)


def test_each_cell_has_an_offset_of_its_own_that_warms():
    walk = WALKS["walk"]
    constants = np.random.default_rng(1).uniform(1.0, 8.0, 99)
    more = 2.0 * (1.0 - np.exp(-walk.recording.time[:, None] / constants))
    feet = {side: replace(foot, force=foot.force + more) for side, foot in walk.recording.feet.items()}
    recording = replace(walk.recording, feet=feet)
    check(walk, recording)
    quiet = without_baselines(recording).feet["left"].force[-100:]
    assert np.abs(quiet).max() < 1.5


def test_a_walk_without_offset_stays_as_it_is():
    for walk in WALKS.values():
        assert without_baselines(walk.recording).feet["left"].force is walk.recording.feet["left"].force


@pytest.mark.parametrize("name", WALKS)
def test_a_contact_that_the_recording_cuts_is_no_swing(name):
    """Wherever a recording begins and ends: the falling half of a step at its start is no offset that drifts."""
    recording = WALKS[name].recording
    stride = {"walk": 1.1, "run": 0.7, "slow": 1.8}[name]
    for cut in np.round(np.linspace(0.6, 0.6 + stride, 12) * recording.rate_hz).astype(int):
        part = slice(cut, len(recording.time) - cut)
        feet = {side: replace(foot, force=foot.force[part]) for side, foot in recording.feet.items()}
        kept = replace(recording, time=recording.time[part] - recording.time[cut], feet=feet)
        assert without_baselines(kept).warnings == ()


@pytest.mark.parametrize("seed", range(3))
def test_standing_has_no_swings(seed):
    random, time = np.random.default_rng(seed), np.arange(3000) * 0.01
    sway = np.convolve(random.normal(0.0, 1.0, 3000), np.exp(-np.arange(200) / 40.0), mode="same")
    assert swing_levels(400.0 + 6.0 * sway, 100.0) is None
    assert swing_levels(400.0 + 200.0 * np.sin(2.0 * np.pi * (0.3 + 0.1 * seed) * time), 100.0) is None
    assert swing_levels(random.normal(5.0, 1.0, 3000), 100.0) is None


def test_a_pause_between_steps_is_no_swing():
    """Standing on both feet for a moment is half a body weight above the swings beside it."""
    walk = WALKS["walk"]
    force = walk.recording.feet["left"].vertical_force
    cut = round((walk.strikes["left"][4] + 0.35) * 100)
    paused = np.concatenate([force[:cut], np.full(100, 350.0), force[cut:]])
    found = swing_levels(paused, 100.0)
    assert np.abs(found.level).max() < 5.0


def test_steps_that_an_offset_joins_are_told_where_it_is_kept():
    walk = WALKS["walk"]
    recording = on_offset(walk, 300.0 * SHAPES["rises"](walk.recording.time))
    for gait in analyse_feet(recording).values():
        assert any("joins these steps" in w for w in gait.warnings)
    for gait in analyse_feet(walk.recording).values():
        assert not any("joins these steps" in w for w in gait.warnings)


@pytest.mark.parametrize("width", [3, 4, 17, 160])
@pytest.mark.parametrize("count", [1, 2, 16, 17, 18, 500])
def test_the_level_under_contacts_is_scipys_opening(count, width):
    rng = np.random.default_rng(count * width)
    for course in (rng.normal(size=count).cumsum(), rng.integers(0, 4, count).astype(float)):
        padded = np.pad(course, width, mode="edge")
        opened = grey_opening(padded, size=width, mode="nearest")[width : width + count]
        np.testing.assert_array_equal(_opened(course, width / 100.0, 100.0), opened)
