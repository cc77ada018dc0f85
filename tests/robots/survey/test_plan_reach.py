"""What a swinging leg takes of the sole that carries, by the planned motion alone."""

import math
from dataclasses import asdict, replace

import mujoco
import numpy as np
import pytest

from plantar.common.gravity import GRAVITY
from plantar.gait.plan.footsteps import straight_plan
from plantar.robots import builtin_robots, load_robot
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.survey.fitted_gait import _crouch, fit_gait
from plantar.robots.survey.plan_reach import _FRICTION, _Pass, plan_reach
from plantar.robots.survey.step_search import SHIFT, TURN, straight_walk
from plantar.sim.terrain import terrain_kinds


def reach_of(name, slower):
    robot = load_robot(name)
    robot = replace(robot, single_support=slower * robot.single_support, double_support=slower * robot.double_support)
    legs = build_leg_model(robot)
    body = body_of(robot, legs.model)
    return plan_reach(robot, legs, straight_walk(robot, body, robot.com_height - 0.1 * body.leg, steps=2))


def test_what_is_known_of_a_walk_is_all_that_was_found(monkeypatch):
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    body = body_of(robot, legs.model)
    walk = straight_walk(robot, body, robot.com_height - 0.25 * body.leg, steps=2)
    first = asdict(plan_reach(robot, legs, walk))
    end = legs.configuration
    monkeypatch.setattr(_Pass, "look", None)  # not looked at again
    again = asdict(plan_reach(robot, legs, walk))
    assert first["low"] > 0.0
    assert {name: np.array(value).tolist() for name, value in again.items()} == {
        name: np.array(value).tolist() for name, value in first.items()
    }
    assert legs.configuration.tolist() == end.tolist()


@pytest.mark.parametrize("name", builtin_robots())
def test_a_swinging_leg_takes_less_at_half_the_pace(name):
    usual, slow = reach_of(name, 1.0), reach_of(name, 2.0)
    assert 0.0 < slow.shift < 0.75 * usual.shift  # the pelvis moves, too
    assert 0.0 < slow.turn < 0.5 * usual.turn


def test_the_moment_about_the_com_is_that_of_inverse_dynamics():
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    found = _Pass(robot, legs, straight_walk(robot, body_of(robot, legs.model), robot.com_height, steps=2))
    found.set_out(robot)
    every = found.every
    for time in np.arange(1.6, 2.9, every).tolist():
        found.look(time)
    configurations = np.array([seen[0] for seen in found.seen])
    moments = np.gradient(found.probe.angular_momenta(configurations, every), every, axis=0)
    model = legs.model
    data = mujoco.MjData(model)
    velocities = np.zeros((len(configurations), model.nv))
    for i in range(1, len(configurations) - 1):
        mujoco.mj_differentiatePos(model, velocities[i], 2.0 * every, configurations[i - 1], configurations[i + 1])
    off, size = 0.0, 0.0
    for i in range(3, len(configurations) - 3):
        data.qpos[:], data.qvel[:] = configurations[i], velocities[i]
        data.qacc[:] = (velocities[i + 1] - velocities[i - 1]) / (2.0 * every)
        mujoco.mj_inverse(model, data)
        turn = data.xmat[model.body(robot.torso_body).id].reshape(3, 3) @ data.qfrc_inverse[3:6]
        root = int(model.body_rootid[model.body(robot.torso_body).id])
        about_com = turn + np.cross(data.qpos[:3] - data.subtree_com[root], data.qfrc_inverse[:3])
        off, size = max(off, float(np.abs(about_com - moments[i]).max())), max(size, float(np.abs(moments[i]).max()))
    assert size > 3.0  # N m
    assert off < 0.15 * size


@pytest.mark.long
def test_a_robot_whose_legs_would_rock_it_walks_more_slowly():
    h1 = replace(load_robot("h1"), effort_limits=(1000.0,) * 6)
    heavy = replace(h1, biped=replace(h1.biped, link_masses=[2.5 * mass for mass in h1.biped.link_masses]))
    for robot, slower in ((h1, 1.0), (heavy, 1.15)):  # at its pendulum's pace h1 moves the ZMP by 0.19, so it is kept
        fitted = fit_gait(robot)
        assert fitted.reach.shift <= 1.25 * SHIFT
        assert fitted.reach.turn <= 1.25 * TURN
        single = fitted.robot.single_support / math.sqrt(fitted.robot.com_height / GRAVITY)
        assert single >= 3.1 * slower
        assert slower > 1.0 or single < 3.2


def test_steps_aside_lean_the_torso_about_the_feet_and_not_about_the_start():
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    walked = straight_walk(robot, body_of(robot, legs.model), robot.com_height - 0.05, steps=2)
    few, many = (
        plan_reach(robot, legs, replace(walked, feet=feet, steps=steps, lean=0.8))
        for feet, steps in (straight_plan(n, length=0.0, sideways=0.08, width=0.19) for n in (4, 30))
    )
    assert many.missed == pytest.approx(few.missed, abs=1e-3)
    assert many.carrying == pytest.approx(few.carrying, rel=0.03)


def test_a_crouch_leaves_a_swinging_foot_its_clearance_where_the_ankle_is_at_its_limit():
    h1 = replace(load_robot("h1"), effort_limits=())
    lower = list(h1.biped.joint_lower)
    lower[4] = -45.0  # degrees: the sole's toes towards the shank
    stiff = replace(h1, biped=replace(h1.biped, joint_lower=tuple(lower)))
    crouches = []
    for robot, held_down in ((h1, False), (stiff, True)):
        legs = build_leg_model(robot)
        body = body_of(robot, legs.model)
        walked = straight_walk(robot, body, robot.com_height - 0.05 * body.leg, steps=2)
        reach = plan_reach(robot, legs, walked)
        assert (reach.low > 0.4 * walked.swing_height) == held_down
        assert reach.low <= 10.0 * reach.missed + 1e-9
        crouches.append(_crouch(robot, legs, body, 0.0))
        lowest = plan_reach(robot, legs, straight_walk(robot, body, robot.com_height - crouches[-1]))
        assert lowest.low <= 0.34 * walked.swing_height
    assert crouches[1] < 0.05 * body.leg <= crouches[0]


def test_the_ground_is_as_slippery_as_scenes_lay_it():
    assert terrain_kinds()["flat"]().friction == _FRICTION
