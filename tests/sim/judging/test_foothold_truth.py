"""Scenes on partial footholds, and what was found of them against the ground's true geometry."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.geometry.polygon import area
from plantar.sim.judging.foothold_truth import FootholdTruth
from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene

KEPT = ["step_adjustment=false"]  # steps keep their places and do not move for balance


@pytest.fixture(scope="module")
def inner():
    return run_scene(load_scene("partial-inner", ["settle=0.5"]), 1)


def test_half_a_foothold_is_found_and_walked_over(inner):
    assert inner["completed"]
    assert inner["replans"] >= 1
    found, true = inner["footholds"]["area_ratio_found"], inner["footholds"]["area_ratio_true"]
    assert true[2] == pytest.approx(0.5, abs=0.02)
    assert found[2] == pytest.approx(true[2], abs=0.1)
    assert [round(v, 2) for v in found[:2] + found[3:]] == [1.0] * 5
    assert inner["footholds"]["centroid_error_m"]["p95"] < 0.01


def test_without_looking_at_footholds_nothing_is_replanned():
    """Nor by preemptive compliance, which looks too, or for balance."""
    off = ["footholds=off", "pfc=false", "control.step_timing=false", *KEPT]
    blind = run_scene(load_scene("partial-third", off), 1)
    assert blind["replans"] == 0
    assert "footholds" not in blind
    assert blind["fell"]


SHORT_BEAM = ["steps=14", "terrain.length=0.2", "terrain.width=0.08"]


@pytest.mark.long
def test_a_short_beam_is_crossed():
    """From platform to platform over a third of the sole, which the seed puts 41 mm off its middle."""
    run = run_scene(load_scene("beam", SHORT_BEAM), 0)
    assert run["reasons"] == []
    assert run["completed"]
    assert run["steps_taken"] == 14
    assert min(run["contact_area_ratio"]) < 0.4


@pytest.mark.sample(1)
@pytest.mark.parametrize("offset", [0.06, -0.06])
def test_the_same_beam_throws_a_robot_that_does_not_feel_it(offset):
    """Steps that move for balance keep the blind robot upright, though off its way: here neither robot's do."""
    far = [*SHORT_BEAM, *KEPT, "offset_range=0", f"terrain.offset={offset}"]
    sensing, blind = (run_scene(load_scene("beam", [*far, f"footholds={f}"]), 0) for f in ("skin", "off"))
    assert sensing["completed"]
    assert blind["fell"]
    assert not blind["completed"]


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("seed", [0, 3])
def test_the_beam_is_crossed(robot, seed):
    run = run_scene(load_scene("beam", [], robot), seed)
    assert run["completed"]
    assert run["steps_taken"] == 50
    assert min(run["contact_area_ratio"]) < 0.6


@pytest.mark.long
@pytest.mark.parametrize("settings", [["yaw=5"], ["yaw=-5"], ["offset_range=0.0", "terrain.width=0.06"]])
def test_turned_and_narrow_beams_are_crossed(settings):
    assert run_scene(load_scene("beam-yaw", settings), 0)["completed"]


def test_a_leaning_trunk_takes_load_off_the_hips():
    """Where steps may move for balance, a trunk leans whether asked or not."""
    loads = []
    for lean in ("false", "true"):
        simulation = Simulation(load_scene("flat", ["steps=2", "settle=0.2", f"lean={lean}", *KEPT]), 0)
        world, torques = simulation.world, []
        rolls = [i for i, name in enumerate(world.robot.legs["left"].joints) if name.endswith("hip_roll")]
        look = simulation.judge.update

        def watch(*arguments, seen=torques, at=rolls, now=world, look=look):
            seen.append(np.abs(now.data.actuator_force[now.servos])[at + [i + 6 for i in at]].max())
            return look(*arguments)

        simulation.judge.update = watch
        assert simulation.run()["completed"]
        loads.append(float(np.percentile(torques, 90)))
    assert loads[1] < loads[0] - 4.0


def test_triangles_are_compared_and_lines_are_not(h1):
    """A sole that a corner of the ground carries stands on three corners."""
    truth = object.__new__(FootholdTruth)
    triangle = np.array([[0.0, 0.0], [0.06, 0.0], [0.0, 0.06]])
    truth._world = SimpleNamespace(robot=h1)
    truth._only_level, truth._found = True, {}
    for step, (true, found) in enumerate([(triangle, triangle + np.array([0.03, 0.04])), (triangle[:2], triangle)]):
        truth._under = lambda side, true=true: true
        truth.update((SimpleNamespace(side="left", step=step, polygon=found),))
    told = truth.summary()
    assert told["centroid_error_m"] == {"median": 0.05, "p95": 0.05}
    whole = area(h1.layouts["left"].outline)
    assert told["area_ratio_found"] == told["area_ratio_true"] == [round(0.0018 / whole, 3)]
