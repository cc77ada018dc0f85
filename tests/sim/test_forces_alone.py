"""Partial footholds walked by forces alone, under a model of the taxels that the controller does not know."""

import numpy as np
import pytest

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene


@pytest.mark.parametrize("robot", ["h1", pytest.param("hrp2kai", marks=pytest.mark.long)])
def test_a_level_foot_finds_the_rear_half_that_carries(robot):
    """In two walks of the first three: one in ten falls, and which one depends on the processor's last bits."""
    scene = load_scene("partial-rear", ["footholds=force", "sensing.taxels=elastic"], robot)
    completed = 0
    for seed in range(3):
        summary = run_scene(scene, seed)
        found, true = (summary["footholds"][f"area_ratio_{which}"][2] for which in ("found", "true"))
        assert found == pytest.approx(true, abs=0.15)
        completed += summary["completed"]
        if completed == 2:
            return
    raise AssertionError(f"{completed} of 3 walks completed")


def test_a_foot_that_comes_as_it_does_finds_less_than_carries_it():
    """Neither levelled nor given the slope of the other sole, it finds the part next to the edge that it met.

    Nor does it come slowly, from as high as over rough ground, or does the robot crouch, move its steps or count on its
    legs, by which it comes as level as it left.
    """
    off = ("landing.levelling=0", "contact.level=0.5", "approach_height=0", "swing_height=1/12 leg", "crouch=0")
    off += ("pfc=false", "step_adjustment=false", "leg_momentum=false")
    runs = [run_scene(load_scene("partial-rear", ["footholds=force", *off]), seed)["footholds"] for seed in range(4)]
    found, true = (np.mean([run[f"area_ratio_{which}"][2] for run in runs]) for which in ("found", "true"))
    assert found < 0.75 * true


BEAM = ("footholds=force", "sensing.taxels=elastic", "terrain.width=0.34 sole", "offset_range=0.174 sole")


@pytest.mark.long
@pytest.mark.xfail(strict=True, reason="step 4 is on the platform's edge, and probing is for feet without pfc alone")
def test_a_foot_looks_for_the_rest_of_a_beam_that_it_met_the_edge_of():
    """Before the weight comes; a foot that does not takes a part of what carries it for all of it."""
    missed = []
    for probing in ("true", "false"):
        scene = load_scene("beam", [*BEAM, "walk.steps=5", f"landing.probing={probing}"], "hrp2kai")
        found = [run_scene(scene, seed)["footholds"] for seed in (0, 1)]
        missed.append(sum(max(0.0, f["area_ratio_true"][4] - f["area_ratio_found"][4]) for f in found))
    assert missed[0] < 0.03
    assert missed[1] > 0.1
