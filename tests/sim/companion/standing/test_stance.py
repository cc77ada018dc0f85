"""A standing machine finds its base from its feet, and its first posture has what it was asked for."""

import numpy as np
import pytest

from plantar.errors import RobotError
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiments.multi_contact import MultiContact
from plantar.sim.companion.machine import load_machine
from plantar.sim.companion.standing.stance import Stance


@pytest.fixture(scope="module")
def one_leg():
    machine = load_machine("h1-body")
    return MultiContact(machine, MultiContact.settings_type(), MultiContact.control_type(), 0)


def test_first_posture_on_one_leg_has_the_centre_of_mass_over_the_sole(one_leg):
    place = one_leg.stance.places["left_foot"]
    assert one_leg.com == pytest.approx([place[0], place[1], 0.8], abs=1e-4)
    one_leg.robot.update(one_leg.first, np.zeros(36), 0.0)
    origin, rotation = one_leg.robot.pose("left_foot")
    assert rotation == pytest.approx(np.eye(3), abs=1e-4)
    assert origin + rotation @ one_leg.stance.feet["left_foot"] == pytest.approx(place, abs=1e-5)
    assert one_leg.robot.pose("right_foot")[0][2] > origin[2] + 0.04


def test_base_comes_from_feet_and_not_from_what_was_measured_of_it(one_leg):
    robot, rng = one_leg.robot, np.random.default_rng(2)
    qpos, qvel = one_leg.first.copy(), rng.normal(0.0, 0.3, 36)
    robot.update(qpos, qvel, 0.0)
    foot = robot.jacobian("left_foot", one_leg.stance.feet["left_foot"])[:3]
    qvel[:3] -= foot @ qvel  # the foot rests
    wrong, rushed = qpos.copy(), qvel.copy()
    wrong[:3] += [0.3, -0.2, 0.1]
    rushed[:3] += [1.0, 2.0, 3.0]
    robot.update(wrong, rushed, 0.0)
    one_leg.stance.locate(robot)
    assert robot.data.qpos == pytest.approx(qpos, abs=1e-5)
    assert robot.velocity == pytest.approx(qvel, abs=1e-9)


def test_a_machine_without_soles_is_refused():
    alone = load_machine("planar-arm").spec().compile()
    with pytest.raises(RobotError, match="no left sole"):
        Stance(MujocoDynamics(alone).model, ("left",))
