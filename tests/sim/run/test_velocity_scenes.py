"""Walks at commanded velocities, in simulation."""

import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene


@pytest.mark.sample(1)
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_robot_walks_turns_and_stops_as_commanded(robot):
    commands = 'commands=[[0.0, 0.1, 0.05, 0.15], [7.2, "stop"]]'
    summary = run_scene(load_scene("stop", [commands, "settle=1.5"], robot))
    assert {r["criterion"] for r in summary["reasons"]} <= {"speed_ratio", "turn_ratio"}  # of so few steps
    told = summary["velocity"]
    assert told["steps_after_stop"] <= 2
    assert 0.75 < told["speed_ratio"] < 1.25
    assert 0.75 < told["turn_ratio"] < 1.25


@pytest.mark.long
@pytest.mark.parametrize("scene", ["turn", "s-curve", "stop"])
def test_the_velocity_scenes_are_completed(scene):
    summary = run_scene(load_scene(scene))
    assert summary["reasons"] == []


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("velocity=[0.1, 0.0]", "a velocity command is"),
        ('velocity=["fast"]', "a velocity command is"),
        ("velocity=0.1", "'velocity' is 0.1; allowed: .forward, left, turn."),
        ('commands=[[0.0, 0.1, 0.0, 0.0], [0.0, "stop"]]', "increase"),
        ("commands=[[0.0, 0.1, 0.0, 0.0], [20.0, 0.0, 0.0, 0.0]]", "until is 10 s; allowed: after .* at 20 s"),
    ],
)
def test_what_is_no_velocity_is_refused(setting, words):
    with pytest.raises(SceneError, match=words):
        load_scene("flat", [setting])


def test_a_velocity_and_a_table_of_them_exclude_each_other():
    with pytest.raises(SceneError, match="velocity and commands are given"):
        load_scene("turn", ['commands=[[0.0, "stop"]]'])


def test_the_seed_draws_where_a_walk_wanders_to():
    walk = load_scene("wander").walk
    one, again, other = (walk.velocities(seed) for seed in (1, 1, 2))
    assert one == again != other
    assert len(one.times) == 11
    assert one.commands[-1] is None
    drawn = np.array([[c.forward, c.left, c.turn] for c in one.commands if c is not None])
    most = [0.0618 * walk.body.in_si("leg/beat"), 0.0289 * walk.body.in_si("leg/beat"), 0.0495 / walk.body.beat]
    assert (np.abs(drawn) <= most).all()
    assert (np.ptp(drawn, axis=0) > most).all()
    with pytest.raises(SceneError, match="a velocity command is"):
        load_scene("wander", ["wander=[0.1, 0.1]"])


def test_settings_of_pushes_keep_their_short_names():
    """A key of the walk with the name of a push's would make both ambiguous."""
    assert load_scene("push", ["duration=0.2"]).push.duration == 0.2
    assert load_scene("balance", ["interval=3.0"]).push.interval == 3.0
