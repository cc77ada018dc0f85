"""First steps of a new robot in simulation, and the threshold of pushes by them."""

import tomllib
from dataclasses import replace

import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.errors import InputError
from plantar.gait.estimate.push_estimate import PushRules
from plantar.sim.run.scene import load_scene
from plantar.sim.survey.trial_walk import TRIALS, Trial, _Level, level_trial, other_trials, push_text, trial_names


def test_h1_walks_without_what_would_be_a_push():
    level, trial = level_trial("h1")
    assert trial == Trial("flat", "", 8)
    assert 0.0 < level < PushRules().begins
    assert push_text(level / 1.5) == ""  # it keeps the thresholds that were set by it


@pytest.mark.parametrize("level", [1.0, 2.53, 8.6])
def test_a_push_stands_out_of_what_walking_leaves(level):
    found = tomllib.loads(push_text(level))["push_estimate"]
    assert 1.5 * level <= found["begins"] < 1.5 * level + 0.11
    rules = PushRules()
    assert found["ends"] == pytest.approx(found["begins"] * rules.ends / rules.begins, rel=0.05)


def test_a_fall_leaves_no_threshold(monkeypatch):
    fallen = {"fell": True, "steps_taken": 2, "reasons": [{"criterion": "fall"}, {"criterion": "fall"}]}
    monkeypatch.setattr(_Level, "run", lambda self: fallen)
    monkeypatch.setattr(_Level, "level", 7.2)
    level, trial = level_trial("h1")
    assert level == 0.0
    assert trial.text() == "flat (plantar sim flat): missed fall"
    assert push_text(level) == ""
    rest = other_trials("h1", tuple(TRIALS), trial)
    assert [other.completed for other in rest] == [False] * 3


def test_a_trial_that_cannot_begin_is_missed():
    level, trial = level_trial("no such robot")
    assert level == 0.0
    assert trial.missed.startswith("its begin: ")
    (push,) = other_trials("no such robot", ("flat", "push"), Trial("flat", ""))
    assert push.missed.startswith("its begin: ")


def test_trials_are_walked_in_their_order_and_a_missed_one_is_named(monkeypatch):
    walked = []

    def run(scene, seed):
        walked.append(scene.name)
        return {"steps_taken": 8, "reasons": [{"criterion": "fall"}] if scene.name == "obstacle" else []}

    monkeypatch.setattr("plantar.sim.survey.trial_walk.run_scene", run)
    stone, slab, push = other_trials("h1", trial_names("push,slab,stone"), Trial("flat", ""))
    assert walked == ["partial-third", "obstacle", "push"]
    assert (stone.completed, slab.missed, push.text()) == (
        True,
        "fall",
        "push (plantar sim push): completed, 8 steps",
    )
    assert slab.as_dict() == {"name": "slab", "scene": "obstacle", "completed": False, "missed": "fall"}


def test_another_bodys_slab_and_push_are_as_high_and_hard_as_its_own(monkeypatch):
    scenes = []

    def run(scene, seed):
        scenes.append(scene)
        return {"steps_taken": 8, "reasons": []}

    monkeypatch.setattr("plantar.sim.survey.trial_walk.run_scene", run)
    body = REFERENCE_BODY
    longer = replace(body, leg=2.0 * body.leg)
    other_trials("h1", tuple(TRIALS), Trial("flat", ""), longer)
    _, slab, push = scenes
    own = load_scene("obstacle").for_body(body).terrain.top
    assert slab.for_body(body).terrain.top == pytest.approx(2.0 * own)
    assert push.for_body(body).push.dv == load_scene("push").for_body(longer).push.dv


def test_an_unknown_trial_is_refused():
    with pytest.raises(InputError, match="--trials names 'stairs'; allowed: flat, stone, slab, push"):
        trial_names("flat,stairs")
