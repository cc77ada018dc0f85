"""A load that the controller does not know, a long walk and a quick one, cut to a few steps."""

import pytest

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


def test_a_load_of_a_twentieth_in_front_of_the_chest_is_carried():
    run = Simulation(load_scene("load", ["steps=2", "settle=0.5"]), seed=1)
    torso = run.world.model.body(run.robot.torso_body)
    true, modelled = (float(mass) for mass in (run.world.model.body_subtreemass[torso.rootid[0]], run.legs.mass))
    assert true == pytest.approx(1.05 * modelled, rel=1e-3)
    summary = run.run()
    assert summary["completed"], summary["reasons"]
    # 5 % of the mass 0.2 m ahead of the trunk moves the CoM by a centimetre.
    assert 0.006 < run.controller.identified()["com_offset_m"][0] < 0.014


def test_a_long_walk_keeps_its_height():
    scene = load_scene("long-walk", ["steps=5", "settle=0.5"])
    assert load_scene("long-walk").walk.steps * scene.walk.length >= 100.0
    summary = Simulation(scene, seed=1).run()
    assert summary["completed"], summary["reasons"]
    assert summary["steps_taken"] == 5
    assert summary["estimate"]["com_error_max_m"][2] < 2e-3


def test_a_quick_walk_is_within_its_torques_and_lands_softly():
    pace = ["length=0.4 leg", "single_support=2.42 beat", "double_support=0.5 beat"]
    run = Simulation(load_scene("flat", ["steps=8", "settle=0.5", *pace]), seed=1)
    summary = run.run()
    assert summary["completed"], summary["reasons"]
    assert summary["torque_limit"]["share_of_time"] < 0.05  # a third of the time if its feet hurry
    assert max(summary["impacts_N"]) < run.body.weight
