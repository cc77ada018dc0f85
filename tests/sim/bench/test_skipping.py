"""`plantar bench skip` on a walk of one step."""

import csv
from dataclasses import replace
from pathlib import Path

import pytest

from plantar.bench.kind import BenchOptions
from plantar.percepts.percept import Percept
from plantar.sim.bench import skipping
from plantar.sim.bench.runner import run_kind
from plantar.sim.bench.skipping import SKIPPING, WatchedSimulation, compare_skipping, replay_physics
from plantar.sim.run.scene import load_scene

SHORT = ("steps=1", "walk.start=0.2", "walk.end=0.2", "walk.settle=0")


@pytest.fixture(scope="module")
def row():
    return compare_skipping("flat", "h1", SHORT, rounds=1)


@pytest.mark.long
def test_what_is_skipped_does_not_change_the_motion(row):
    assert row.same_motion
    assert len(row.motion) == 64


@pytest.mark.long
def test_parts_add_up_to_what_there_could_have_been(row):
    ticks = row.skipped["recorded ticks"]
    members = sum(row.skipped[n] + row.computed[n] for n in ("polygons and other shapes", "other percept members"))
    assert members == 2 * ticks * len(Percept.members())
    shapes = "polygons and other shapes"  # of which a walk on level ground needs few
    assert row.skipped[shapes] > 0.9 * (row.skipped[shapes] + row.computed[shapes])
    readings = row.skipped["taxel forces"] + row.computed["taxel forces"]
    assert readings == pytest.approx(2 * 42 * 250 * row.sim_s, rel=0.01)
    assert 0 < row.skipped["taxel forces"] < row.computed["taxel forces"]  # one foot swings for a part of the time
    rays = row.computed["proximity rays"]
    assert rays + row.skipped["proximity rays"] == readings
    assert (
        0 < rays < row.skipped["taxel forces"] + 0.02 * readings
    )  # those of a foot in the air, and a few ticks about it


@pytest.mark.long
def test_physics_alone_is_less_than_the_run(row):
    assert 0.0 < row.physics_s < row.run_s < row.everything_s
    assert row.factor == pytest.approx((row.run_s - row.physics_s) / row.physics_s)
    assert sum(row.shares.values()) == pytest.approx(1.0)


@pytest.mark.long
def test_a_motion_that_differs_is_reported(row, tmp_path, monkeypatch):
    differs = replace(row, scene="beam", same_motion=False)
    monkeypatch.setattr(skipping, "SCENES", (("flat", "h1", ()), ("beam", "h1", ())))
    monkeypatch.setattr(skipping, "compare_skipping", lambda scene, *_: {"flat": row, "beam": differs}[scene])
    shares: list[float] = []
    done = run_kind(SKIPPING, BenchOptions(), tmp_path, lambda share, _: shares.append(share))
    assert not done.result["same_motion"]
    assert len(done.failures) == 1
    assert shares == [0.0, 0.5]
    assert "**no**" in done.text
    assert "**no**" in (tmp_path / "skipping.md").read_text()
    assert sorted(Path(name).name for name in done.result["files"]) == sorted(p.name for p in tmp_path.iterdir())
    with (tmp_path / "skipping.csv").open() as table:
        assert [r["same_motion"] for r in csv.DictReader(table)] == ["True", "False"]


WATCHED = ("walk.begin=1", "steps=0", "walk.start=0.2", "walk.end=0.2", "walk.settle=0")


def test_the_motion_is_the_same_with_and_without_what_is_not_asked_for():
    runs = [WatchedSimulation(load_scene("flat", (*WATCHED, f"skip={skip}"), "h1"), 1) for skip in ("auto", "none")]
    summaries = [run.run() for run in runs]
    assert runs[0].motion == runs[1].motion
    assert summaries[0]["skipped"]["percept_members"] > 0
    assert summaries[1]["skipped"]["percept_members"] == 0
    assert sum(runs[0].members.values()) < sum(runs[1].members.values())
    used, motion = replay_physics(runs[0])
    assert motion == runs[0].motion
    assert used > 0.0
