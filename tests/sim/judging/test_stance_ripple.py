"""How steady the ground carries: the figure of a known force, and the limit that a flickering contact breaks."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.sim.judging.stance_ripple import RIPPLE, StanceRipple
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.terrain import CORNERS

from ..rates import check_rate, drawn_seeds

PERIOD, MASS, GRAVITY = 1e-3, 50.0, 9.81
STEPS = (10, 100)
PYTHON: Any = python_form("judging.stance_force").StanceForce


def followed(force: np.ndarray, right: np.ndarray, margin: float = 0.03, since: int = 1000) -> Any:
    """A watch after a body with the given force under its left foot, which moves as Newton's law has it."""
    reaction = SimpleNamespace(loads=np.zeros(2), margin=margin)
    center = np.zeros(3)
    watch = PYTHON(reaction, center, MASS, GRAVITY, PERIOD, STEPS, 20.0, 2e-3)
    speed = 0.0
    for step, (a, b) in enumerate(zip(force, right, strict=True)):
        reaction.loads[:] = a, b
        watch.step(since + step)
        speed += PERIOD * ((a + b) / MASS - GRAVITY)
        center[2] += PERIOD * speed
    return watch


def test_a_force_that_changes_slowly_is_followed_and_one_that_flickers_is_not():
    time = PERIOD * np.arange(2000)
    weight = MASS * GRAVITY
    slow = weight * (1.0 + 0.2 * np.sin(2.0 * math.pi * 1.5 * time))
    assert followed(slow, np.zeros(2000)).rms() < 5e-4 * weight
    flicker = np.where(np.arange(2000) % 50 == 0, 0.5, 1.0) * weight  # single steps at half the weight
    # A step's force less its mean over the window, which sees a tenth of it at most, is nearly all of the drop.
    assert followed(flicker, np.zeros(2000)).rms() == pytest.approx(0.5 * weight / math.sqrt(50.0), rel=0.15)


def test_only_single_support_some_time_after_a_landing_counts():
    steady = np.full(300, MASS * GRAVITY)
    assert followed(steady, np.full(300, 30.0)).single == 0
    watch = followed(steady, np.zeros(300), since=0)
    assert (watch.single, watch.compared) == (300, 300 - STEPS[1] - 2 * STEPS[0])
    assert math.isnan(followed(steady[:10], np.zeros(10)).rms())


def test_a_zmp_near_the_edge_is_counted():
    steady = np.full(50, MASS * GRAVITY)
    assert followed(steady, np.zeros(50), margin=1.9e-3).at_edge == 50
    assert followed(steady, np.zeros(50), margin=2.1e-3).at_edge == 0


def walked_on_the_beam(seed: int, on_boxes: bool) -> dict[str, Any]:
    """Summary of 8 steps, on meshes of corners or on the boxes that are seen, with MuJoCo's contacts of two boxes."""
    simulation = Simulation(load_scene("beam", ["steps=8", "conform=false", "settle=0.3"]), seed)
    model = simulation.world.model
    for i in range(len(simulation.ground.solids)) if on_boxes else ():
        seen, touched = model.geom(f"ground_{i}"), model.geom(f"ground_{i}{CORNERS}")
        for name in ("contype", "conaffinity", "condim", "friction", "solref", "solimp", "gap"):
            getattr(seen, name)[:] = getattr(touched, name)
        touched.contype[:] = touched.conaffinity[:] = 0
    return simulation.run()


@pytest.mark.long
def test_contacts_that_flicker_break_the_limit_of_a_walk():
    """On every seed; what flickers may make the robot fall, which then counts as a fall alone."""
    seeds = drawn_seeds(test_contacts_that_flicker_break_the_limit_of_a_walk, 4)
    flickering = [walked_on_the_beam(seed, True) for seed in seeds]
    steady = [walked_on_the_beam(seed, False) for seed in seeds]
    check_rate((run["stance_force_rms"] > RIPPLE and not run["completed"] for run in flickering), least=0.9)
    check_rate((run["completed"] for run in steady), least=0.9)
    for run in steady:
        assert run["fell"] or run["stance_force_rms"] < 0.5 * RIPPLE


def test_a_walk_whose_force_ripples_more_than_the_limit_does_not_count():
    ripple = StanceRipple.__new__(StanceRipple)
    for rms, fails in ((0.9 * RIPPLE, False), (1.1 * RIPPLE, True)):
        ripple.watch = SimpleNamespace(compared=1, rms=lambda rms=rms: rms)
        ripple._weight = 1.0
        assert bool(ripple.reasons()) == fails
