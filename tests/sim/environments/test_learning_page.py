"""The numbers of docs/learning.md are those of the code."""

import math
import re
from itertools import pairwise

import pytest

pytest.importorskip("gymnasium")
pytest.importorskip("mujoco")

import gymnasium

from plantar.common.gravity import GRAVITY
from plantar.sim.bench.footholds.foothold_run import _PATIENCE, TRIALS, TrialRun, scene_of_trial
from plantar.sim.bench.footholds.observed import PERIOD, SCALE
from plantar.sim.bench.footholds.policy import BASELINES
from plantar.sim.environments import ENVIRONMENTS, FOOTHOLDS
from plantar.sim.environments.walker import PlantarEnv


@pytest.fixture(scope="module")
def page(repository):
    return " ".join((repository / "docs" / "learning.md").read_text().split())


def test_of_the_environments(page):
    env = PlantarEnv("stand")
    for name in (*ENVIRONMENTS, FOOTHOLDS):
        assert f"`{name}`" in page
    assert {gymnasium.spec(name).max_episode_steps for name in ENVIRONMENTS} == {500}
    assert f"An episode lasts 500 steps, {500 * env.period:g} s at the `period` of {env.period:g} s" in page
    assert f"by up to {env.scale:g} rad from the standing posture, {1.0 / env.period:.0f} times a second" in page
    assert (env.period, env.scale) == (PERIOD, SCALE)
    leg = env.body.leg
    assert f"A beat is sqrt(leg / g), {math.sqrt(leg / GRAVITY):.2f} s on `h1`" in page


def test_of_the_benchmark(page):
    of_kind = {kind: [t.value for t in TRIALS if t.kind == kind] for kind in dict.fromkeys(t.kind for t in TRIALS)}
    for kind, values in of_kind.items():
        ratios = {round(max(a, b) / min(a, b), 9) for a, b in pairwise(values)}
        assert ratios <= {2.0}, kind
    beam, stones = of_kind["beam"], of_kind["stones"]
    assert f"beams of {beam[0]:g} to {beam[-1]:g} of the foot's extent" in page
    assert f"stones that carry {100 * stones[-1]:.0f} to {100 * min(1.0, stones[0] + 0.2):.0f} % of a sole" in page
    assert all(f"`{name}`" in page for name in BASELINES)
    task = TrialRun(TRIALS[0]).task
    assert f"called each `task.period` ({1e3 * task.period:g} ms)" in page
    assert f"a run of footsteps has {_PATIENCE} times that" in page
    named = set(re.findall(r"`([a-z_.\[\]\"]+)`", page))
    for name in ("joints", "steps", "swings", "velocities", "period", "end", "robot", "walk", "weight", "leg"):
        assert name in named
        assert hasattr(task, name)


def test_soles_are_late_by_what_it_says(page):
    scene = scene_of_trial(TRIALS[0], "h1")
    period = 1.0 / scene.sensing.skin_rate
    assert scene.sensing.delay_periods == 1
    assert f"force (n,) on each taxel in N, {1e3 * period:g} ms late" in page
