"""An arm that is pressed: how far it gives way by springs, gain and skin, against the statics of its springs."""

import mujoco
import numpy as np
import pytest

from plantar.sensing.reading import Reading
from plantar.sim.arms.compliant_arm import CompliantArm
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.model.world import World

from .fixed_arm import PERIOD, compliant, fixed_world, jacobian, left_arm

FORCE = 3.0  # N along the normal of one taxel: some degrees of the arm's springs


@pytest.fixture(scope="module")
def worn():
    return left_arm()


def settled(world: World, arm: CompliantArm, reading: Reading | None, wrench: np.ndarray, link: str) -> np.ndarray:
    """How far (k,) in rad the joints are out of the posture after 2.5 s with a wrench (6,) on a link."""
    world.data.xfrc_applied[world.model.body(link).id] = wrench
    for k in range(2500):
        if k % 5 == 0:
            arm.read()
            arm.step(reading)
        mujoco.mj_step(world.model, world.data)
    return arm.true_angles - arm.posture


def pressed(worn: WornArm, skin: bool = True, **settings: float) -> tuple[np.ndarray, np.ndarray]:
    """How far the joints turn (k,) in rad where a taxel of the forearm is pressed, and the torque (k,) of that."""
    world = fixed_world(worn)
    arm = compliant(worn, world, skin, **settings)
    taxel = worn.skin.slices["left_lower_arm"].start + 7
    link = worn.skin.patch("left_lower_arm").link
    body = world.data.body(link)
    force = FORCE * body.xmat.reshape(3, 3) @ worn.skin.normals[taxel]
    place = body.xpos + body.xmat.reshape(3, 3) @ worn.skin.positions[taxel]
    torque = force @ jacobian(world, link, worn.skin.positions[taxel])
    forces = np.zeros(len(worn.skin))
    forces[taxel] = FORCE
    reading = Reading(0.0, forces, np.full(len(worn.skin), np.inf)) if skin else None
    moment = np.cross(place - body.xipos, force)
    return settled(world, arm, reading, np.concatenate([force, moment]), link), torque


def test_it_holds_its_posture_and_returns_its_links(worn):
    world = fixed_world(worn)
    arm = compliant(worn, world)
    turned = settled(world, arm, None, np.zeros(6), worn.links[0])
    assert np.abs(turned).max() < np.radians(0.1)
    poses = arm.read()
    assert set(poses) == set(worn.skin.links)
    mujoco.mj_kinematics(world.model, world.data)
    for link, (place, rotation) in poses.items():
        body = world.data.body(link)
        assert place == pytest.approx(body.xpos - world.data.body("base").xpos, abs=1e-9)
        assert rotation == pytest.approx(body.xmat.reshape(3, 3), abs=1e-9)


@pytest.mark.parametrize("gain", [0.0, 1.0, 2.0])
def test_it_gives_way_by_gain_times_the_force_over_its_springs(worn, gain):
    spring = 1.0
    turned, torque = pressed(worn, gain=gain, spring=spring, filter=PERIOD)
    expected = gain * torque / (spring * worn.efforts)
    assert np.abs(gain * torque).max() == pytest.approx(gain * np.abs(torque).max())
    assert turned == pytest.approx(expected, abs=0.1 * gain * np.abs(torque / worn.efforts).max() + 1e-3)


def test_without_skin_it_gives_way_by_its_springs_alone(worn):
    felt, torque = pressed(worn, gain=1.0, spring=1.0)
    mute, _ = pressed(worn, skin=False, gain=5.0, spring=1.0)
    assert mute == pytest.approx(torque / worn.efforts, abs=0.1 * np.abs(torque / worn.efforts).max())
    assert mute == pytest.approx(felt, abs=2e-3)


def test_no_motor_gives_more_than_it_can(worn):
    world = fixed_world(worn)
    arm = compliant(worn, world, spring=1000.0)
    world.data.qpos[arm._places] = arm.posture + 0.3
    arm.read()
    arm.step(None)
    assert arm.torque == pytest.approx(-worn.efforts)
