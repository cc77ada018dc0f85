"""Recordings with a trouble drawn by a seed: each is right, or warned of with the size of the error."""

import re
from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

from ..gait.analysis.walks import MadeWalk, made_walk

SEEDS = [*range(2), *(pytest.param(seed, marks=pytest.mark.long) for seed in range(2, 12))]


def walk_of(random: np.random.Generator, **more: object) -> MadeWalk:
    given = {
        "strides": int(random.integers(12, 16)),
        "stride": random.uniform(0.95, 1.3),
        "stance": random.uniform(0.6, 0.66),
        "weight": random.uniform(450.0, 1000.0),
        "rate": float(random.choice([50.0, 100.0])),
        "seed": int(random.integers(1000)),
    }
    return made_walk(**given | more)


def with_foot(recording: PressureRecording, side: str, force: np.ndarray) -> PressureRecording:
    return replace(recording, feet={**recording.feet, side: replace(recording.feet[side], force=force)})


def joined(*parts: PressureRecording) -> PressureRecording:
    """Recordings one after the other."""
    feet = {
        side: FootRecording(side, np.concatenate([p.feet[side].force for p in parts]), parts[0].feet[side].layout)
        for side in parts[0].feet
    }
    time = np.arange(sum(len(p.time) for p in parts)) / parts[0].rate_hz
    return replace(parts[0], time=time, feet=feet)


def standing(random: np.random.Generator, like: MadeWalk, seconds: float) -> PressureRecording:
    frames = round(seconds * like.recording.rate_hz)
    feet = {}
    for side, foot in like.recording.feet.items():
        share = foot.force.sum(axis=0)
        load = 0.5 * foot.vertical_force.max() * (1.0 + 0.02 * random.standard_normal((frames, 1)))
        feet[side] = replace(foot, force=load * share / share.sum())
    return replace(like.recording, time=np.arange(frames) / like.recording.rate_hz, feet=feet)


def error_of(found: Analysis, pattern: str) -> float:
    """The number of a warning, which has to be there."""
    lines = [m for line in found.warnings if (m := re.search(pattern, line))]
    assert len(lines) == 1, found.warnings
    return float(lines[0][1])


def check_times(found: Analysis, made: MadeWalk, stride: float | None = None) -> None:
    """Cadence, contact times and double support of the walk."""
    contact = np.median(np.concatenate([made.lifts[s] - made.strikes[s] for s in made.strikes]))
    stride = float(np.median(np.diff(made.strikes["left"]))) if stride is None else stride
    gait = found.metrics["gait"]
    assert gait["cadence_steps_per_min"] == pytest.approx(120.0 / stride, rel=0.003)
    assert gait["double_support_percent"] == pytest.approx(100.0 * (2.0 * contact / stride - 1.0), abs=3.0)
    for foot in found.metrics["feet"].values():
        assert foot["measures"]["contact_time_s"]["mean"] == pytest.approx(contact, rel=0.03)


@pytest.mark.parametrize("seed", SEEDS)
def test_cells_that_read_0(seed):
    random = np.random.default_rng(seed)
    made = walk_of(random)
    side = str(random.choice(["left", "right"]))
    foot = made.recording.feet[side]
    force = foot.force.copy()
    force[:, random.choice(99, int(random.integers(6, 32)), replace=False)] = 0.0
    found = analyse(with_foot(made.recording, side, force))
    lost = 100.0 * (1.0 - force.sum() / foot.force.sum())
    # A few silent cells at the sole's edge may be cells that the foot does not reach.
    assert error_of(found, r"forces are about ([\d.]+) % too low") == pytest.approx(lost, rel=0.35, abs=3.0)
    check_times(found, made)


@pytest.mark.parametrize("seed", SEEDS)
def test_gain_that_creeps(seed):
    random = np.random.default_rng(seed)
    creep = random.uniform(0.12, 0.5) * random.choice([-0.6, 1.0])
    strides = int(random.integers(14, 25))
    made = walk_of(random, strides=strides, gains=np.linspace(1.0, 1.0 + creep, strides))
    found = analyse(made.recording)
    lines = [m for line in found.warnings if (m := re.search(r"by (\d+) % from first to last", line))]
    assert len(lines) == 2
    mean = 1.0 + 0.5 * creep
    assert all(float(m[1]) == pytest.approx(100.0 * abs(creep) / mean, rel=0.25) for m in lines)
    check_times(found, made)


@pytest.mark.parametrize("seed", SEEDS)
def test_two_people_or_two_clocks(seed):
    random = np.random.default_rng(seed)
    one = walk_of(random, rate=100.0)
    apart = random.uniform(1.08, 1.25)
    other = made_walk(strides=12, stride=apart * float(np.diff(one.strikes["left"])[0]), rate=100.0, weight=700.0)
    n = min(len(one.recording.time), len(other.recording.time))
    feet = {"left": one.recording.feet["left"], "right": other.recording.feet["right"]}
    feet = {side: replace(foot, force=foot.force[:n]) for side, foot in feet.items()}
    found = analyse(replace(one.recording, time=one.recording.time[:n], feet=feet))
    shorter = error_of(found, r"strides are ([\d.]+) % (?:shorter|longer)")
    assert shorter == pytest.approx(200.0 * (apart - 1.0) / (apart + 1.0), abs=1.5)
    assert found.metrics["gait"]["double_support_percent"] is None


@pytest.mark.parametrize("seed", SEEDS)
def test_a_walk_a_stop_and_a_walk(seed):
    random = np.random.default_rng(seed)
    made = walk_of(random, rate=100.0)
    stop = standing(random, made, random.uniform(4.0, 12.0))
    found = analyse(joined(made.recording, stop, made.recording))
    assert "standing" in [s["activity"] for s in found.metrics["segments"]]
    check_times(found, made)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_walk_and_then_a_run(seed):
    random = np.random.default_rng(seed)
    made = walk_of(random, rate=100.0)
    run = walk_of(random, rate=100.0, strides=14, stride=0.72, stance=0.36, humps=(2.0, 2.2, 2.0))
    found = analyse(joined(made.recording, run.recording))
    assert {s["activity"] for s in found.metrics["segments"]} >= {"walking", "running"}
    one = {s.activity for gait in found.feet.values() for s in gait.used}
    assert len(one) == 1
    true = made if one == {"walking"} else run
    cadence = 120.0 / float(np.median(np.diff(true.strikes["left"])))
    assert found.metrics["gait"]["cadence_steps_per_min"] == pytest.approx(cadence, rel=0.003)


@pytest.mark.parametrize("seed", SEEDS)
def test_hops_of_both_feet(seed):
    random = np.random.default_rng(seed)
    hops = walk_of(random, stride=random.uniform(0.45, 0.7), stance=0.5, humps=(2.0, 2.2, 2.0), rate=100.0)
    left = hops.recording.feet["left"]
    found = analyse(with_foot(hops.recording, "right", left.force))
    assert found.metrics["activity"]["name"] == "hopping"
    assert found.metrics["gait"]["double_support_percent"] is None


@pytest.mark.parametrize("seed", SEEDS)
def test_an_offset_that_drifts(seed):
    offset, drift = np.random.default_rng(100 + seed).uniform((10.0, 0.0), 60.0)
    made = walk_of(np.random.default_rng(seed), offset=offset, drift=drift, noise=0.05)
    clean = walk_of(np.random.default_rng(seed))
    found = analyse(made.recording)
    check_times(found, made)
    for side, foot in found.metrics["feet"].items():
        pattern = rf"the {side} foot's sensor reads ([\d.]+) N in swing.* stays in the forces"
        kept = [float(m[1]) for line in found.warnings if (m := re.search(pattern, line))]
        error = foot["measures"]["peak_force_N"]["mean"] - clean.recording.feet[side].vertical_force.max()
        assert abs(error) < (1.1 * kept[0] if kept else 0.02 * clean.recording.feet[side].vertical_force.max())


@pytest.mark.parametrize("seed", SEEDS)
def test_frames_that_were_lost(seed):
    random = np.random.default_rng(seed)
    made = walk_of(random, strides=16)
    recording = made.recording
    for side, foot in recording.feet.items():
        force = foot.force.copy()
        for begin in random.integers(0, len(force) - 40, 3):
            force[begin : begin + int(random.integers(2, 40))] = np.nan
        recording = with_foot(recording, side, force)
    found = analyse(recording)
    check_times(found, made)
    assert any("not measured" in w or "missing" in w or "cut" in w for w in found.warnings)
