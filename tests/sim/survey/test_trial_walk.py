"""First steps of a new robot in simulation, and the threshold of pushes by them."""

import tomllib

import pytest

from plantar.gait.estimate.push_estimate import PushRules
from plantar.sim.survey.trial_walk import _Trial, push_text, trial_walk


def test_h1_walks_without_what_would_be_a_push():
    level, notes = trial_walk("h1")
    assert notes == []
    assert 0.0 < level < PushRules().begins
    assert push_text(level / 1.5) == ""  # it keeps the thresholds that were set by it


@pytest.mark.parametrize("level", [1.0, 2.53, 8.6])
def test_a_push_stands_out_of_what_walking_leaves(level):
    found = tomllib.loads(push_text(level))["push_estimate"]
    assert 1.5 * level <= found["begins"] < 1.5 * level + 0.11
    rules = PushRules()
    assert found["ends"] == pytest.approx(found["begins"] * rules.ends / rules.begins, rel=0.05)


def test_a_fall_leaves_no_threshold(monkeypatch):
    monkeypatch.setattr(_Trial, "run", lambda self: {"fell": True, "reasons": [{"criterion": "fall"}]})
    monkeypatch.setattr(_Trial, "level", 7.2)
    level, notes = trial_walk("h1")
    assert level == 0.0
    assert "missed fall" in notes[0]
    assert push_text(level) == ""
