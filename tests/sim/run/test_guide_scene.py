"""A robot that is led by its arm: what the scene adds to a simulation, what it refuses, and a whole run."""

import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.mechanics.external_wrench import external_acceleration
from plantar.recordings.recording import read_mcap
from plantar.sensing.reading import Reading
from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene


def test_the_controller_knows_where_the_arm_is_that_feels():
    simulation = Simulation(load_scene("guide"), seed=2)
    skin, arm = simulation.settings.skin, simulation.arm
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
    assert not (reading.skin.force > skin.thresholds).any()


def test_a_force_on_the_arm_counts_where_the_arm_is():
    """The controller's acceleration by a press on the forearm, against K 9-12 at the place and in the direction of the
    taxel as MuJoCo has them."""
    simulation = Simulation(load_scene("guide"), seed=2)
    controller, sensors, skin = simulation.controller, simulation.sensors, simulation.settings.skin
    sensors.read_skins()
    reading = sensors.read_body()
    state = controller.step(reading).state
    taxel = skin.slices["left_lower_arm"].start + 11
    force = np.zeros(len(skin))
    force[taxel] = 12.0
    felt = controller.estimation.push_on_skin(reading.changed(skin=Reading(0.0, force, np.full(len(skin), np.inf))))
    body = simulation.world.data.body(skin.links[skin.link_of[taxel]])
    turn = body.xmat.reshape(3, 3)
    push, place = 12.0 * turn @ skin.normals[taxel], body.xpos + turn @ skin.positions[taxel]
    wrench = np.concatenate([push, np.cross(place - state.com, push)])
    expected = external_acceleration(wrench, simulation.legs.mass, controller.omega)
    assert np.hypot(*push[:2]) > 5.0
    assert felt == pytest.approx(expected, abs=0.01 * float(np.abs(expected).max()))


def test_an_arm_that_moves_has_its_skin_beside_that_of_the_trunk():
    simulation = Simulation(load_scene("push-step", ["arm.side=left"]), seed=2)
    skin = simulation.settings.skin
    assert {"base", "arm/left_lower_arm"} < set(skin.links)
    assert simulation.arm is not None
    assert simulation.touched is not None
    assert simulation.touched.guide is None


def test_a_robot_whose_arms_do_not_move_is_not_guided():
    with pytest.raises(SceneError, match=r"way is above 0 and arm.side 'none'; allowed: with an arm that moves"):
        Simulation(load_scene("guide", ["arm.side=none"]))


def test_an_arm_that_moves_may_be_left_alone():
    simulation = Simulation(load_scene("flat", ["arm.side=right"]))
    assert simulation.arm is not None
    assert simulation.touch is None
    assert simulation.sensors._read_now().links == {}


@pytest.mark.long
def test_the_arm_gives_way_and_the_feet_follow(tmp_path):
    recording = tmp_path / "run.mcap"
    summary = run_scene(load_scene("guide", ["guide.toward=forward"]), seed=1, record=recording)
    assert summary["completed"], summary["reasons"]
    told = summary["guide"]
    assert told["feet_followed_m"] > 0.2
    assert told["arm_yielded_m"] > 0.045
    assert told["largest_force_N"] < 42.2
    topics = read_mcap(recording).topics
    touch = topics["/touch"].fields
    pressed = touch["force"][:, 0] > 10.0
    assert touch["felt"][pressed] == pytest.approx(touch["force"][pressed], abs=3.0)
    guide = topics["/guide"].fields
    assert guide["moved"][-1, 0] == pytest.approx(told["moved_m"], abs=1e-3)
    assert np.abs(guide["place"] - guide["held"]).max() < 0.05
    turned = np.degrees(np.abs(topics["/arm"].fields["position"] - topics["/arm"].fields["posture"])).max()
    assert turned == pytest.approx(told["arm_turned_deg"], abs=0.1)
