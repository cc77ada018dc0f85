"""Reaching among obstacles: what is in the way is pushed, with no more than the tolerable force."""

from __future__ import annotations

import pytest

from sim.companion.runner import Companion
from sim.run.scene_kind import open_scene


def run(seed, *settings):
    companion = Companion(open_scene("intentional-contact", settings), seed)
    return companion, companion.run()


@pytest.mark.long
def test_the_arm_pushes_what_stands_at_its_goal_and_stays_under_the_force(tmp_path):
    companion, summary = run(1)
    assert summary["completed"], summary["reasons"]
    assert summary["layout"] == "goal"
    assert summary["contacts"] >= 1
    assert 1.0 < summary["force_max_N"] < 16.5
    assert [p.name for p in companion.experiment.plot(tmp_path)] == ["reach.png"]


@pytest.mark.long
@pytest.mark.parametrize("policy", ["fields", "avoid"])
def test_without_touching_it_stays_in_the_local_minimum(policy):
    _, summary = run(1, f"control.policy={policy}", "experiment.duration=8")
    assert not summary["completed"]
    assert [r["criterion"] for r in summary["reasons"]] == ["goal"]
    assert summary["error_mm"] > 50.0
