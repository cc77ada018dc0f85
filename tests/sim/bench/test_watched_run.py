"""A run that is watched: what it computes changes nothing of its motion, and the physics alone makes it again."""

from __future__ import annotations

from plantar.sim.bench.watched_run import WatchedSimulation, replay_physics
from plantar.sim.run.scene import load_scene

SHORT = ("walk.begin=1", "steps=0", "walk.start=0.2", "walk.end=0.2", "walk.settle=0")


def test_the_motion_is_the_same_with_and_without_what_nobody_asked_for():
    runs = [WatchedSimulation(load_scene("flat", (*SHORT, f"skip={skip}"), "h1"), 1) for skip in ("auto", "none")]
    summaries = [run.run() for run in runs]
    assert runs[0].motion == runs[1].motion
    assert summaries[0]["skipped"]["percept_members"] > 0
    assert summaries[1]["skipped"]["percept_members"] == 0
    assert sum(runs[0].members.values()) < sum(runs[1].members.values())
    assert runs[0].replays
    used, motion = replay_physics(runs[0])
    assert motion == runs[0].motion
    assert used > 0.0


def test_a_pushed_run_is_not_made_by_its_controls_alone():
    assert not WatchedSimulation(load_scene("push", robot="h1"), 1).replays
