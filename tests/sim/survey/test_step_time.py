"""Legs without ankle roll: how quickly they step, and where weak ankles let a sole be loaded."""

import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar.gravity import GRAVITY
from plantar.robots import builtin_robots, load_robot
from plantar.robots.kinematics.body import body_of, stood
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.sides import SIDES
from plantar.sim.survey.step_time import (
    LEAN_MOST,
    ankle_reach,
    has_ankle_roll,
    least_single_support,
    rocking,
    swinging_mass,
)


@pytest.mark.parametrize(("height", "width"), [(0.97, 0.41), (0.97, 0.55), (0.6, 0.15)])
def test_a_pendulum_that_is_carried_by_turns_stays_as_near_the_middle_as_it_shall(height, width):
    robot = rocking(replace(load_robot("h1"), stance_width=width), height)
    assert robot.rocks
    step = robot.single_support + robot.double_support
    omega, foot = math.sqrt(GRAVITY / height), 0.5 * width
    # Integrated from the middle, with the speed from which it is there again after a step.
    y, speed, most = 0.0, foot * omega * math.tanh(0.5 * omega * step), 0.0
    dt = step / 20000
    for _ in range(20000):
        speed += omega**2 * (y - foot) * dt
        y += speed * dt
        most = max(most, y)
    assert y == pytest.approx(0.0, abs=1e-3 * foot)
    share, lean = most / foot, math.atan(most / height)
    assert share <= 0.205
    assert lean <= 1.05 * LEAN_MOST
    assert share >= 0.19 or lean >= 0.95 * LEAN_MOST


@pytest.mark.parametrize("name", builtin_robots())
def test_the_built_in_robots_have_ankles_that_roll(name):
    robot = load_robot(name)
    legs = build_leg_model(robot)
    assert has_ankle_roll(robot, legs)
    names = {s: replace(robot.legs[s], joints=robot.legs[s].joints[:5]) for s in SIDES}
    posture = {s: robot.posture[s][:5] for s in SIDES}
    assert not has_ankle_roll(replace(robot, legs=names, posture=posture), legs)


def test_weak_ankles_bear_the_robot_as_far_as_their_torque_goes():
    robot = load_robot("h1")
    weight = 800.0
    limits = np.full(6, 1000.0)
    assert ankle_reach(robot, weight, 4) is None
    assert ankle_reach(replace(robot, effort_limits=tuple(limits)), weight, 4) is None
    limits[4] = 0.05 * weight
    assert ankle_reach(replace(robot, effort_limits=tuple(limits)), weight, 4) == pytest.approx(0.05, abs=1e-4)


def carried_along(name: str) -> tuple[float, float]:
    """Mass in kg that a foot takes along, by `swinging_mass` and by where the leg's parts go as the sole moves forward
    and stays level."""
    robot = load_robot(name)
    legs = build_leg_model(robot)
    model, data = legs.model, stood(robot, legs.model)
    mujoco.mj_comPos(model, data)
    dofs = [model.joint(joint).dofadr[0] for joint in robot.legs["left"].joints]
    place, turn = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jacSite(model, data, place, turn, model.site(robot.legs["left"].sole_site).id)
    moved = np.zeros(model.nv)
    moved[dofs] = np.linalg.lstsq(np.vstack([place, turn])[:, dofs], np.array([1.0, 0, 0, 0, 0, 0]), rcond=None)[0]
    along = 0.0
    for part in range(1, model.nbody):
        mujoco.mj_jacBodyCom(model, data, place, None, part)
        along += model.body_mass[part] * float(place[0] @ moved)
    return swinging_mass(robot, legs), along


@pytest.mark.parametrize("name", ["h1", "hrp2kai"])
def test_the_swinging_mass_is_what_a_foot_takes_along(name):
    found, true = carried_along(name)
    assert found == pytest.approx(true, rel=0.25)


def test_the_robots_that_do_not_slip_may_keep_their_pace(legs_of_h1):
    robot = load_robot("h1")
    body = body_of(robot, legs_of_h1.model)
    assert least_single_support(robot, legs_of_h1, body, body.leg / 3.0) < robot.single_support


def test_the_time_grows_with_the_reach_and_falls_with_the_sole(legs_of_h1):
    """As the square root of what the leg takes and friction holds."""
    robot = load_robot("h1")
    body = body_of(robot, legs_of_h1.model)
    usual = least_single_support(robot, legs_of_h1, body, 0.2)
    wider = replace(robot, stance_width=4.0 * robot.stance_width)
    assert least_single_support(wider, legs_of_h1, body, 0.2) == pytest.approx(2.0 * usual, abs=0.02)
    assert least_single_support(robot, legs_of_h1, body, 0.8) == pytest.approx(2.0 * usual, abs=0.02)


@pytest.fixture(scope="module")
def legs_of_h1():
    return build_leg_model(load_robot("h1"))
