"""A hand is led by touches on the arm, keeps its place without them, and is not led to where the arm is straight."""

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.wholebody.tasks.tactile_guidance import GuidanceGains, TactileGuidance

ARM = """
<mujoco>
  <worldbody>
    <body name="upper"><joint name="shoulder" axis="0 0 1"/><geom size="0.05" mass="2"/>
      <body name="fore" pos="0.4 0 0"><joint name="elbow" axis="0 0 1"/><geom size="0.05" mass="2"/>
        <body name="hand" pos="0.4 0 0"><joint name="wrist" axis="0 0 1"/><geom size="0.05" mass="1"/></body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
LINKS = ("upper", "fore", "hand")
NOBODY = np.zeros(4)


@pytest.fixture
def robot():
    return MujocoDynamics(mujoco.MjModel.from_xml_string(ARM))


@pytest.fixture
def skin():
    """Taxels of the forearm that take forces along its x and y axes, either way."""
    axes = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    rotations = np.array([np.column_stack([np.cross(z, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0], z]) for z in axes])
    return BodySkin([SkinPatch("forearm", "fore", -0.04 * axes, rotations, np.full(4, 1e-4), force_threshold=1e-6)])


def asked(task, robot, forces, bend=1.5, moved=0.0, speed=0.0):
    """What a touch with such forces asks of the hand while the elbow is bent so far and the shoulder has moved."""
    robot.update(np.array([moved, bend, 0.0]), np.array([speed, 0.0, 0.0]), 0.0)
    return task.demand(robot, Reading(0.0, np.asarray(forces, dtype=float), np.full(4, np.inf))).acceleration


def pressed(robot, force, bend):
    """Forces of the four taxels (4,) that add up to a force (3,) in the world."""
    robot.update(np.array([0.0, bend, 0.0]), np.zeros(3), 0.0)
    x, y, _ = robot.pose("fore")[1].T @ force
    return np.maximum([x, -x, y, -y], 0.0)


def outward(robot, bend):
    robot.update(np.array([0.0, bend, 0.0]), np.zeros(3), 0.0)
    return robot.pose("hand")[0] / np.linalg.norm(robot.pose("hand")[0])


def guidance(skin, arm=None, **gains):
    return TactileGuidance(skin, ["forearm"], "hand", np.zeros(3), GuidanceGains(2.0, 10.0, **gains), arm)


def test_a_touch_leads_and_damping_resists(robot, skin):
    force = np.array([0.0, 6.0, 0.0])
    task = guidance(skin, gain=2.0)
    np.testing.assert_allclose(asked(task, robot, pressed(robot, force, 1.5)), 2.0 * force / 2.0, atol=1e-9)
    hand = outward(robot, 1.5) * np.linalg.norm(robot.pose("hand")[0])
    np.testing.assert_allclose(
        asked(task, robot, NOBODY, speed=0.3), -10.0 * np.cross([0.0, 0.0, 0.3], hand) / 2.0, atol=1e-9
    )


@pytest.mark.parametrize(("bend", "share"), [(1.5, 1.0), (0.9, 0.5), (0.6, 0.0), (0.0, 0.0)])
def test_nobody_leads_a_hand_on_to_where_its_arm_is_straight(robot, skin, bend, share):
    """Two equal links reach cos(bend / 2) of their length; it fades from 0.85 (bend 1.11) to 0.95 (0.64)."""
    bend = 2.0 * np.arccos(0.9) if share == 0.5 else bend
    away = outward(robot, bend)
    aside = np.cross([0.0, 0.0, 1.0], away)
    task = guidance(skin, LINKS)
    on = asked(task, robot, pressed(robot, 8.0 * away, bend), bend)
    np.testing.assert_allclose(on, share * 8.0 * away / 2.0, atol=1e-9)
    for free in (-away, aside):
        np.testing.assert_allclose(
            asked(task, robot, pressed(robot, 8.0 * free, bend), bend), 8.0 * free / 2.0, atol=1e-9
        )


def test_the_end_of_guidance_is_no_jump(robot, skin):
    """From bent to straight the pull changes no faster than a slope of 2 / 0.1 allows, that of the fading."""
    task, bends = guidance(skin, LINKS), np.linspace(1.6, 0.0, 4000)
    pulls = [asked(task, robot, pressed(robot, 8.0 * outward(robot, b), b), b) for b in bends]
    assert np.abs(np.diff(pulls, axis=0)).max() < 8.0 / 2.0 * 1.6 / 4000 * 2.0 / 0.1


def test_without_a_touch_the_hand_keeps_its_place(robot, skin):
    task = guidance(skin, stiffness=100.0)
    np.testing.assert_allclose(asked(task, robot, NOBODY), 0.0, atol=1e-9)
    before = robot.pose("hand")[0]
    pull = asked(task, robot, NOBODY, moved=0.02)
    np.testing.assert_allclose(pull, 100.0 * (before - robot.pose("hand")[0]) / 2.0, atol=1e-9)


def test_a_touch_carries_the_place_along_and_keeps_the_pull_that_was(robot, skin):
    task = guidance(skin, stiffness=100.0)
    asked(task, robot, NOBODY)
    pull = asked(task, robot, NOBODY, moved=0.01)
    force = pressed(robot, np.array([0.0, 6.0, 0.0]), 1.5)
    asked(task, robot, force, moved=0.3)
    np.testing.assert_allclose(asked(task, robot, NOBODY, moved=0.3), pull, atol=1e-9)


def test_the_place_slips_where_the_hand_is_carried_off(robot, skin):
    task = guidance(skin, stiffness=100.0, slack=0.03)
    asked(task, robot, NOBODY)
    assert np.linalg.norm(asked(task, robot, NOBODY, moved=0.5)) == pytest.approx(100.0 * 0.03 / 2.0)


def test_an_arm_of_two_links_cannot_bend(skin):
    with pytest.raises(InputError, match="upper, hand cannot bend; allowed: three or more"):
        guidance(skin, ("upper", "hand"))
