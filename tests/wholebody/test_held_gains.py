"""Gains that cannot be held, against closed forms of one joint and against simulation."""

import warnings

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.wholebody.held_gains import GainWarning, check_gains
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.skin_interaction import DirectInteraction

SLIDE = """<mujoco><option gravity="0 0 0"/><worldbody><body name="cart"><joint name="x" type="slide" axis="1 0 0"/>
  <geom size=".1" mass="2"/></body></worldbody><actuator><motor joint="x"/></actuator></mujoco>"""
INWARD = np.array([[[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]])
SKIN = BodySkin([SkinPatch("back", "cart", np.array([[-0.1, 0.0, 0.0]]), INWARD, np.array([1e-3]))])
PERIOD = 0.01


def cart() -> MujocoDynamics:
    robot = MujocoDynamics(mujoco.MjModel.from_xml_string(SLIDE))
    robot.update(np.zeros(1), np.zeros(1), 0.0)
    return robot


def checked(control, **given):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = check_gains(cart(), control, SKIN, PERIOD, [1000.0], **{"give": 0.0, **given})
    assert [str(w.message) for w in caught] == found
    assert all(issubclass(w.category, GainWarning) for w in caught)
    return found


@pytest.mark.parametrize(("damping", "holds"), [(1.98, True), (2.02, False)])
def test_a_damper_holds_up_to_two_a_tick(damping, holds):
    """v' = (1 - d T) v with a held force."""
    stack = TaskStack([[Posture([0.0], 1e-9, damping / PERIOD)]])
    found = checked(lambda robot, reading: stack.step(robot, reading).torque)
    assert bool(found) != holds
    if found:
        assert "free motion grows by e in 0.5 s at a period of 10 ms" in found[0]


@pytest.mark.parametrize(("stiffness", "holds"), [(0.9, True), (1.1, False)])
def test_a_spring_needs_damping(stiffness, holds):
    """Of x'' = -k x - d v with both held over T, by Jury: k T < 2 d."""
    stack = TaskStack([[Posture([0.0], stiffness * 2.0 * 40.0 / PERIOD, 40.0)]])
    assert bool(checked(lambda robot, reading: stack.step(robot, reading).torque)) != holds


def test_a_reflex_that_throws_the_robot_is_found_by_the_check_and_by_a_simulation():
    for gain in (0.5, 60.0):
        touch = DirectInteraction(SKIN, gain=gain)
        stack = TaskStack([[touch, Posture([0.0], 0.0, 4.0, torques=True)]])
        found = checked(lambda robot, reading, s=stack: s.step(robot, reading).torque, push=5.0)
        # The same spring and damper about its rest, stepped finely between ticks.
        mass, place, speed, torque = 2.0, 1e-6, 0.0, 0.0
        stiffness, damping = mass / 0.02**2, 2.0 * mass / 0.02
        for k in range(100 * 200):
            force = -stiffness * place - damping * speed
            if k % 200 == 0:
                torque = gain * force - 4.0 * speed
            speed += (force + torque) / mass * PERIOD / 200
            place += speed * PERIOD / 200
        assert bool(found) == (gain > 1.0)
        assert (abs(place) > 1e-6) == (gain > 1.0)
        if found:
            assert "a touch on patch 'back' grows" in found[0]


def test_torques_have_to_suffice_for_posture_and_touch():
    stack = TaskStack([[DirectInteraction(SKIN, gain=2.0), Posture([0.0], 10.0, 40.0, torques=True)]])
    with pytest.warns(GainWarning, match="20 N on patch 'back' ask joint 0 for 40 N m; its limit is 30"):
        check_gains(cart(), lambda robot, reading: stack.step(robot, reading).torque, SKIN, 1e-3, [30.0])
    with pytest.warns(GainWarning, match="joint 0 needs 5 N m to hold"):
        check_gains(cart(), lambda robot, reading: np.array([5.0]), SKIN, 1e-3, [3.0])


def test_the_robot_is_put_back_and_wrong_values_are_refused():
    robot = cart()
    robot.update(np.array([0.3]), np.array([0.2]), 1.5)
    stack = TaskStack([[Posture([0.3], 10.0, 5.0)]])
    assert check_gains(robot, lambda r, reading: stack.step(r, reading).torque, SKIN, 1e-3, [100.0], give=0.0) == []
    assert (robot.joint_positions[0], robot.velocity[0], robot.time) == (0.3, 0.2, 1.5)
    with pytest.raises(InputError, match="period"):
        check_gains(robot, lambda r, reading: np.zeros(1), SKIN, 0.0, [1.0])
    with pytest.raises(InputError, match="limits"):
        check_gains(robot, lambda r, reading: np.zeros(1), SKIN, 1e-3, [1.0, 2.0])
    free = MujocoDynamics(
        mujoco.MjModel.from_xml_string(
            '<mujoco><worldbody><body name="cart"><freejoint/><geom size=".1"/><body><joint/><geom size=".1"/></body>'
            "</body></worldbody></mujoco>"
        )
    )
    with pytest.raises(InputError, match="fixed base"):
        check_gains(free, lambda r, reading: np.zeros(1), SKIN, 1e-3, [1.0])


@pytest.mark.parametrize(("gain", "holds"), [(0.0, False), (1.5, True)])
def test_a_touch_has_to_yield(gain, holds):
    """By (1 + gain) F / k of a spring k."""
    stack = TaskStack([[DirectInteraction(SKIN, gain=gain), Posture([0.0], 3000.0, 100.0, torques=True)]])
    found = checked(lambda robot, reading: stack.step(robot, reading).torque, push=20.0, give=0.01)
    assert bool(found) != holds
    if found:
        assert "patch 'back' yields by 6.7 mm to 20 N, less than 10 mm" in found[0]
    with pytest.raises(InputError, match="give is -1"):
        checked(lambda robot, reading: np.zeros(1), give=-1.0)
