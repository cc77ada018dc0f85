"""A robot that is led by its arm: what the scene adds to a simulation, what it refuses, and a whole run."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.errors import SceneError
from sim.run.runner import Simulation, run_scene
from sim.run.scene import load_scene


def test_the_controller_knows_where_the_arm_is_that_feels() -> None:
    simulation = Simulation(load_scene("guide"), seed=2)
    skin, arm = simulation.settings.skin, simulation.arm
    assert skin is not None
    assert arm is not None
    assert all(link.startswith("arm/left_") for link in skin.links)
    assert simulation.world.model.nv == simulation.legs.model.nv + 3  # the hand
    assert np.abs(arm.true_angles - arm.posture).max() < np.radians(1.0)  # after half a second on its feet
    reading = simulation.sensors._read_now()
    assert set(reading.links) == set(skin.links)
    base = simulation.world.data.body("base")
    for link, (place, _) in reading.links.items():
        true = base.xmat.reshape(3, 3).T @ (simulation.world.data.body(link).xpos - base.xpos)
        assert place == pytest.approx(true, abs=1e-3)
    assert reading.skin is not None
    assert not (reading.skin.force > skin.thresholds).any()


def test_nobody_guides_a_robot_whose_arms_do_not_move() -> None:
    with pytest.raises(SceneError, match=r"way is above 0 and arm.side 'none'; allowed: with an arm that moves"):
        Simulation(load_scene("guide", ["arm.side=none"]))


def test_an_arm_that_moves_may_be_left_alone() -> None:
    simulation = Simulation(load_scene("flat", ["arm.side=right"]))
    assert simulation.arm is not None
    assert simulation.touch is None
    assert simulation.sensors._read_now().links == {}


@pytest.mark.long
def test_the_arm_gives_way_and_the_feet_follow() -> None:
    summary = run_scene(load_scene("guide", ["guide.toward=forward"]), seed=1)
    assert summary["completed"], summary["reasons"]
    told = summary["guide"]
    assert told["feet_followed_m"] > 0.2
    assert told["arm_yielded_m"] > 0.045
    assert told["largest_force_N"] < 42.2
