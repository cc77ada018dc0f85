"""Partial footholds walked by forces alone, under a model of the taxels that the controller does not know."""

import numpy as np
import pytest

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

from .rates import check_rate, drawn_seeds


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_level_foot_finds_the_rear_half_that_carries(robot):
    """On every seed; nine of ten such walks complete."""
    scene = load_scene("partial-rear", ["footholds=force", "sensing.taxels=elastic"], robot)
    runs = [
        run_scene(scene, seed) for seed in drawn_seeds(test_a_level_foot_finds_the_rear_half_that_carries, 4, robot)
    ]
    for summary in runs:
        found, true = (summary["footholds"][f"area_ratio_{which}"][2] for which in ("found", "true"))
        assert found == pytest.approx(true, abs=0.15)
    check_rate((summary["completed"] for summary in runs), least=0.8)


@pytest.mark.long
def test_a_foot_that_comes_as_it_does_mostly_finds_what_carries_it() -> None:
    """Neither levelled nor given the slope of the other sole, it may meet the edge alone, in few walks.

    Nor does it come slowly, from as high as over rough ground, or does the robot crouch, move its steps or count on its
    legs, by which it comes as level as it left.
    """
    off = ("landing.levelling=0", "contact.level=0.5", "approach_height=0", "swing_height=1/12 leg", "crouch=0")
    off += ("pfc=false", "step_adjustment=false", "leg_momentum=false")
    close = []
    for seed in drawn_seeds(test_a_foot_that_comes_as_it_does_mostly_finds_what_carries_it, 6):
        footholds = run_scene(load_scene("partial-rear", ["footholds=force", *off]), seed)["footholds"]
        found, true = (footholds[f"area_ratio_{which}"] for which in ("found", "true"))
        close.append(len(found) > 2 and found[2] == pytest.approx(true[2], abs=0.1))
        assert np.all(np.array(found) <= 1.0 + 1e-9)
    check_rate(close, least=0.8)
