"""Files as they come from elsewhere: whatever locale, clock or transfer made of them, the walk in them is the same."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.formats.nominal_insole import moticon_insole
from plantar.gait.analysis.analyse import Analysis, analyse

from .vendor_texts import Writing, moticon, pedar
from .walks import MadeWalk, made_walk

WALK = made_walk(strides=3)
PLAIN = Writing()


def analysed(path: Path, content: bytes) -> Analysis:
    path.write_bytes(content)
    return analyse(path)


def check(found: Analysis, walk: MadeWalk, sides: tuple = SIDES) -> None:
    """Heel strikes within 20 ms, toe offs within 35 ms, cadence within 0.3 %, forces exact."""
    assert set(found.feet) == set(sides)
    for side in sides:
        contacts = [c for c in found.feet[side].contacts if c.complete]
        assert len(contacts) == len(walk.strikes[side])
        assert np.abs([c.heel_strike for c in contacts] - walk.strikes[side]).max() < 0.020
        assert np.abs([c.toe_off for c in contacts] - walk.lifts[side]).max() < 0.035
        peak = max(step["peak_force_N"] for step in found.feet[side].steps)
        assert peak == pytest.approx(walk.recording.feet[side].vertical_force.max(), rel=2e-3)
    cadence = 120.0 / np.mean([np.diff(walk.strikes[side]) for side in sides])
    assert found.metrics["gait"]["cadence_steps_per_min"] == pytest.approx(cadence, rel=3e-3)


def check_with_stance(found: Analysis, walk: MadeWalk, sides: tuple = SIDES) -> None:
    """The same, and stance within 1 % of the stride: of files whose clock is sound."""
    check(found, walk, sides)
    for side in sides:
        contacts = [c for c in found.feet[side].contacts if c.complete]
        times = np.array([(c.heel_strike, c.toe_off) for c in contacts])
        true = np.column_stack([walk.strikes[side], walk.lifts[side]])
        stance = [np.mean((t[:-1, 1] - t[:-1, 0]) / np.diff(t[:, 0])) for t in (times, true)]
        assert abs(stance[0] - stance[1]) < 0.01


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"comma": True, "sep": ";", "end": "\r\n", "encoding": "latin-1"},
        {"comma": True, "encoding": "utf-16", "unit": "n/cm2"},
        {"sep": ",", "encoding": "utf-8-sig", "unit": "psi"},
        {"sep": "   ", "end": "\r", "short": True},
        {"sides": ("right",)},
        {"encoding": "utf-16-le"},
        {"encoding": "utf-16-be"},
    ],
    ids=str,
)
def test_pedar(tmp_path, changes):
    how = replace(PLAIN, **changes)
    check_with_stance(analysed(tmp_path / "walk.asc", pedar(WALK, how)), WALK, how.sides)


@pytest.mark.parametrize("rate", [50.0, 128.0, 500.0])
@pytest.mark.parametrize(("kilograms", "stride"), [(12.0, 0.7), (70.0, 1.1), (160.0, 2.2)])
def test_people_of_all_weights_at_all_cadences(tmp_path, rate, kilograms, stride):
    insoles = {side: moticon_insole(3 if kilograms < 20.0 else 7, side) for side in SIDES}
    made = {"rate": rate, "weight": 9.81 * kilograms, "stride": stride, "strides": 3}
    walk = made_walk(**made, layouts=insoles)
    found = analysed(tmp_path / "walk.txt", moticon(walk, replace(PLAIN, unit="n/cm2")))
    if stride < 2.0:
        check_with_stance(found, walk)
    else:  # whose load below the level of makers' events lasts 15 ms at each end of a stance
        check(found, walk)


def test_names_that_stand_on_each_page(tmp_path):
    lines = pedar(WALK, PLAIN).decode().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("time"))
    head, names, rows = lines[:first], lines[first], lines[first + 1 :]
    pages = [line for i, row in enumerate(rows) for line in ([names, row] if i % 50 == 0 else [row])]
    check(analysed(tmp_path / "walk.asc", "\n".join([*head, *pages]).encode()), WALK)


def test_numbers_of_frames_for_times(tmp_path):
    found = analysed(tmp_path / "walk.asc", pedar(WALK, PLAIN, times=1.0 + np.arange(len(WALK.recording.time))))
    assert any("the frames' times count them" in warning for warning in found.metrics["warnings"])
    cadence = 120.0 / np.mean([np.diff(WALK.strikes[side]) for side in SIDES])
    assert found.metrics["gait"]["cadence_steps_per_min"] == pytest.approx(cadence, rel=3e-3)


@pytest.mark.parametrize("rate", [30.0, 200.0])
def test_a_clock_of_hundredths(tmp_path, rate):
    walk = made_walk(strides=3, rate=rate)
    check(analysed(tmp_path / "walk.asc", pedar(walk, replace(PLAIN, decimals=2, short=True))), walk)


@pytest.mark.sample(3)
@pytest.mark.parametrize("short", [False, True])
@pytest.mark.parametrize("every", [3, 10, 150, 0])
def test_a_clock_that_stands_still_now_and_then(tmp_path, every, short):
    times = WALK.recording.time.copy()
    held = np.arange(5, len(times), every) if every else np.random.default_rng(0).integers(1, len(times), 60)
    times[held] = times[held - 1]
    found = analysed(tmp_path / "walk.asc", pedar(WALK, replace(PLAIN, short=short), times=np.sort(times)))
    check(found, WALK)
    assert any("time" in warning for warning in found.metrics["warnings"])


@pytest.mark.parametrize("every", [1, 10, 150, 0])
def test_frames_that_were_written_twice(tmp_path, every):
    n = len(WALK.recording.time)
    again = np.arange(0, n, every) if every else np.random.default_rng(0).choice(n, n // 10, replace=False)
    frames = np.sort(np.concatenate([np.arange(n), again])).tolist()
    found = analysed(tmp_path / "walk.asc", pedar(WALK, PLAIN, frames=frames))
    check(found, WALK)
    assert any("time" in warning for warning in found.metrics["warnings"])


def test_frames_that_were_lost(tmp_path):
    kept = np.flatnonzero(np.random.default_rng(0).random(len(WALK.recording.time)) > 0.2).tolist()
    found = analysed(tmp_path / "walk.asc", pedar(WALK, PLAIN, frames=kept))
    check(found, WALK)
    assert any("not evenly spaced" in warning for warning in found.metrics["warnings"])


@pytest.mark.parametrize(
    "changes",
    [{"sep": ";", "comma": True, "encoding": "utf-16"}, {"seconds": 1e-3, "decimals": 0, "end": "\r"}],
    ids=str,
)
def test_moticon(tmp_path, changes):
    walk = made_walk(strides=3, layouts={side: moticon_insole(7, side) for side in SIDES})
    check_with_stance(analysed(tmp_path / "walk.txt", moticon(walk, replace(PLAIN, unit="n/cm2", **changes))), walk)
