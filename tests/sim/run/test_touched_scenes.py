"""What a scene with somebody who touches the robot adds to a simulation, and that any other scene adds nothing."""

import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


def test_a_scene_without_touch_has_neither_skin_nor_bodies_for_it():
    pushed, alone = Simulation(load_scene("push")), Simulation(load_scene("push-step", ["push.dv=0"]))
    for simulation in (pushed, alone):
        assert simulation.touch is None
        assert simulation.settings.skin is None
        assert simulation.sensors.body_skin is None
        assert simulation.world.model.nv == simulation.legs.model.nv


def test_hands_come_with_a_skin_that_the_controller_knows_and_reads():
    simulation = Simulation(load_scene("push-step"), seed=2)
    skin, world = simulation.settings.skin, simulation.world
    base = world.model.body(world.model.body_rootid[world.torso]).name
    assert skin.links == (base,)
    assert world.model.nv == simulation.legs.model.nv + 4  # one hand, for the left and the right of one seed
    reading = simulation.sensors._read_now().skin
    assert reading.force.shape == (len(skin),)
    assert not (reading.force > skin.thresholds).any()
    assert np.isinf(reading.distance).all()


def test_the_skin_may_be_mute():
    simulation = Simulation(load_scene("push-step", ["sensing.body_skin=false"]))
    assert simulation.touch is not None
    assert simulation.settings.skin is None
    assert simulation.sensors._read_now().skin is None


def test_a_box_of_half_a_round_is_refused():
    with pytest.raises(SceneError, match=r"scene 'box-step': \[walk\] steps is 20; allowed: whole rounds of 6 steps"):
        Simulation(load_scene("box-step", ["walk.steps=20"]))
