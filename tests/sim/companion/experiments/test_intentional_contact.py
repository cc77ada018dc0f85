"""Reaching among obstacles: what is in the way is pushed, with no more than the tolerable force."""

import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.sim.companion.machine import load_machine
from plantar.sim.companion.reaching.free_way import free_way
from plantar.sim.companion.runner import Companion
from plantar.sim.run.scene_kind import open_scene


def run(seed, *settings):
    companion = Companion(open_scene("intentional-contact", settings), seed)
    return companion, companion.run()


@pytest.mark.long
def test_the_arm_pushes_retreats_when_shoved_and_stays_under_the_force(tmp_path):
    companion, summary = run(1)
    assert summary["completed"], summary["reasons"]
    assert summary["layout"] == "goal"
    assert summary["contacts"] >= 1
    assert summary["retreats"] >= 1
    assert 1.0 < summary["force_max_N"] < 16.5
    assert [p.name for p in companion.experiment.plot(tmp_path)] == ["reach.png"]


@pytest.mark.long
def test_without_a_shove_it_need_not_retreat():
    assert run(1, "shove=0")[1]["retreats"] == 0


@pytest.mark.parametrize("scene", ["intentional-contact", "table-contact"])
def test_no_layout_can_be_solved_without_contact(scene):
    for seed in range(4):
        opened = open_scene(scene)
        machine = load_machine(opened.robot)
        one = opened.experiment_type(machine, opened.experiment, opened.control, seed)
        s, goal = one.settings, np.array([*one.layout.goal, one.start_tip.place[2]])
        assert not free_way(one.start_tip, goal, s.tolerance, one.layout.posts, s.half_height)
        kept = [post for post in one.layout.posts if not post.friction]
        assert not kept or free_way(one.start_tip, goal, s.tolerance, kept, s.half_height)  # by pushing it can


def test_a_ring_about_a_tip_that_lifts_is_refused(monkeypatch):
    monkeypatch.setattr("plantar.sim.companion.experiments.intentional_contact._DRAWS", 5)
    with pytest.raises(SceneError, match="5 layouts 'ring' can be solved without contact"):
        Companion(open_scene("table-contact", ["layout=ring", "half_height=0.01"]), 0)


@pytest.mark.long
@pytest.mark.parametrize("policy", ["fields", "avoid"])
def test_without_touching_it_stays_in_the_local_minimum(policy):
    _, summary = run(1, f"control.policy={policy}", "experiment.duration=8")
    assert not summary["completed"]
    assert [r["criterion"] for r in summary["reasons"]] == ["goal"]
    assert summary["error_mm"] > 50.0


@pytest.mark.long
def test_a_finger_over_a_table_pushes_what_stands_at_its_goal():
    companion = Companion(open_scene("table-contact"), 1)
    summary = companion.run()
    assert summary["completed"], summary["reasons"]
    assert 1.0 < summary["force_max_N"] < 16.5


@pytest.mark.long
def test_what_parts_without_skin_press_counts_too():
    """The wrist of the table's arm has no skin: pushed against a post it is judged all the same."""
    companion = Companion(open_scene("table-contact", ["half_height=0.12", "duration=4.2"]), 1)
    summary = companion.run()
    assert summary["force_max_N"] > 1.0
    assert max(abs(w[:3]).max() for w in companion.skin.on_obstacles.values()) == 0.0
