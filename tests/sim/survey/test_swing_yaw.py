"""The mass that swings with a foot, against the legs' Jacobians, and the time it takes not to turn the other sole."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar.robots import load_robot
from plantar.robots.kinematics.body import body_of, stood
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.sim.survey.swing_yaw import least_single_support, swinging_mass


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
def test_the_swinging_mass_is_what_a_foot_takes_along(name: str) -> None:
    found, true = carried_along(name)
    assert found == pytest.approx(true, rel=0.25)


def test_the_robots_that_do_not_slip_may_keep_their_pace(legs_of_h1: LegModel) -> None:
    robot = load_robot("h1")
    body = body_of(robot, legs_of_h1.model)
    assert least_single_support(robot, legs_of_h1, body, body.leg / 3.0) < robot.single_support


def test_the_time_grows_with_the_reach_and_falls_with_the_sole(legs_of_h1: LegModel) -> None:
    """As the square root of what the leg takes and friction holds."""
    robot = load_robot("h1")
    body = body_of(robot, legs_of_h1.model)
    usual = least_single_support(robot, legs_of_h1, body, 0.2)
    wider = replace(robot, stance_width=4.0 * robot.stance_width)
    assert least_single_support(wider, legs_of_h1, body, 0.2) == pytest.approx(2.0 * usual, abs=0.02)
    assert least_single_support(robot, legs_of_h1, body, 0.8) == pytest.approx(2.0 * usual, abs=0.02)


@pytest.fixture(scope="module")
def legs_of_h1() -> LegModel:
    return build_leg_model(load_robot("h1"))
