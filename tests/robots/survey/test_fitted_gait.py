"""Numbers of a walk that fit a robot: how quickly its motors let it step."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES
from plantar.errors import InputError, RobotError
from plantar.robots import load_robot
from plantar.robots.controller_settings import controller_settings
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.robot_model import build_leg_model, compiled_model
from plantar.robots.survey.fitted_gait import (
    APPROACH_HEIGHT,
    APPROACH_SPEED,
    QUICK_DOUBLE,
    QUICK_SINGLE,
    QUICK_STEP,
    FittedGait,
    _weak_ankle,
    fit_gait,
)
from plantar.robots.survey.plan_reach import plan_reach
from plantar.robots.survey.step_search import STEP_SHARE, straight_walk
from plantar.robots.survey.step_time import ankle_reach
from plantar.robots.survey.wishes import Wishes
from plantar.robots.walk import walk_timing
from plantar.sim.run.scene import load_scene

SLOW = BodyScale(mass=3.5, leg=0.22, sole=0.13, sole_width=0.09, pace_beats=1.6)


@pytest.mark.parametrize("name", ["turn", "stop", "s-curve", "wander"])
def test_scenes_at_a_velocity_ask_for_the_quick_steps_that_motors_are_measured_by(name):
    scene, robot = load_scene(name), load_robot("h1")
    timing = controller_settings(scene.for_body(SLOW), replace(robot, single_support=0.9), SLOW, {}).timing
    step = (QUICK_SINGLE + QUICK_DOUBLE) * SLOW.pace
    assert timing.single_support + timing.double_support == pytest.approx(step)
    table = scene.for_body(SLOW).walk.velocities(0)
    assert table is not None
    speeds = [abs(c.forward) for c in table.commands if c is not None]
    assert max(speeds) * step <= 1.01 * QUICK_STEP * SLOW.leg
    if name != "turn":
        assert max(speeds) > 0.0


def speed(fitted: FittedGait) -> float:
    robot = fitted.robot
    return STEP_SHARE * fitted.body.leg / (robot.single_support + robot.double_support)


@pytest.mark.long
def test_knees_that_bend_ahead_alone_are_walked_on_with_a_note(monkeypatch):
    def bird(spec, robot):
        for side in SIDES:
            spec.joint(f"{side}_knee").range = [-150.0, 5.0]  # degrees
        return compiled_model(spec, robot)

    monkeypatch.setattr("plantar.robots.kinematics.robot_model.compiled_model", bird)
    fitted = fit_gait(load_robot("h1"))
    assert any("bend the shank ahead, as a bird's do" in note for note in fitted.notes)
    assert math.degrees(fitted.reach.knee) >= 10.0
    assert math.degrees(fitted.robot.posture["left"][3]) < -10.0


@pytest.mark.long
def test_weak_motors_make_a_walk_slower():
    h1 = load_robot("h1")
    strong = fit_gait(replace(h1, effort_limits=(1000.0,) * 6))
    assert strong.robot.pace == 1.0
    assert strong.robot.leg_length == strong.robot.approach_support == 0.0
    weak = fit_gait(replace(h1, effort_limits=(51.0, 90.0, 30.0, 85.0, 25.0, 71.0)))
    assert speed(weak) < 0.9 * speed(strong)
    assert max(weak.reach.carrying / weak.robot.effort_limits) < 1.0


def test_a_height_and_a_stance_that_are_stated_are_kept():
    h1 = load_robot("h1")
    found = fit_gait(h1, wishes=Wishes(height=0.78, stance=0.2)).robot
    assert (found.com_height, found.stance_width) == (0.78, 0.2)
    with pytest.raises(RobotError, match=r"no height of its CoM, .* nearest is a CoM at 1.200 m"):
        fit_gait(h1, wishes=Wishes(height=1.2))


def test_a_robot_that_is_refused_hears_what_it_has_to_do_without_ankle_roll(monkeypatch):
    h1 = load_robot("h1")
    monkeypatch.setattr("plantar.robots.survey.fitted_gait.has_ankle_roll", lambda robot, legs: False)
    with pytest.raises(RobotError, match=r"without ankle roll it rocks from foot to foot .* no height of its CoM"):
        fit_gait(h1, wishes=Wishes(height=1.2))


def test_a_fit_with_what_is_known_of_the_legs_is_the_same(monkeypatch):
    h1 = load_robot("h1")
    wishes = Wishes(height=0.78, stance=0.2)
    first = fit_gait(h1, wishes=wishes)
    rotors = np.full(6, 0.02)
    alone = fit_gait(h1, (), rotors, wishes)
    monkeypatch.setattr("plantar.robots.survey.plan_reach._Pass.look", None)  # not looked at again
    again = fit_gait(h1, (), rotors, wishes, first.known)
    assert again.robot == alone.robot
    assert again.notes == alone.notes
    for name in ("torque", "speed", "spare"):
        assert getattr(again.reach, name).tolist() == getattr(alone.reach, name).tolist()


@pytest.mark.long
def test_slow_joints_make_a_walk_slower():
    h1 = replace(load_robot("h1"), effort_limits=(1000.0,) * 6)
    quick = fit_gait(replace(h1, velocity_limits=(50.0,) * 6))
    limit = 0.7 * float(quick.reach.speed.max())
    slow = fit_gait(replace(h1, velocity_limits=(limit,) * 6))
    assert quick.reach.speed == pytest.approx(fit_gait(h1).reach.speed)
    assert speed(slow) < 0.85 * speed(quick)
    assert float(slow.reach.speed.max()) < 0.95 * limit


@pytest.mark.sample(1, each="kept")
@pytest.mark.parametrize(("own", "kept"), [((8e3, 150.0), True), ((1e6, 1e3), False), ((8e3, 0.0), False)])
def test_servos_that_chatter_or_ring_are_replaced(own, kept):
    found = fit_gait(load_robot("h1"), [own] * 6)
    assert (found.robot.stiffness == (own[0],) * 6) == kept
    assert any(note.endswith("they are kept") for note in found.notes) == kept
    assert found.robot.own_stiffness == (own[0],) * 6


def test_a_walk_is_looked_at_for_as_long_as_it_bears():
    robot = load_robot("h1")
    legs = build_leg_model(robot)
    walk = straight_walk(robot, body_of(robot, legs.model), robot.com_height, steps=2)
    whole = plan_reach(robot, legs, walk)
    bent = 0.5 * (plan_reach(robot, legs, walk, lambda missed, knee, spare: False).knee + whole.knee)
    until = plan_reach(robot, legs, walk, lambda missed, knee, spare: knee >= bent)
    assert whole.knee <= until.knee < bent
    assert until.straightest <= whole.straightest
    assert (until.torque == math.inf).all()
    assert (whole.torque < math.inf).all()


def test_a_swing_that_comes_down_slowly_gets_the_time_that_its_motors_need():
    uneven = load_scene("uneven").for_body(SLOW)
    assert uneven.walk.approach_height == pytest.approx(APPROACH_HEIGHT * SLOW.leg)
    assert uneven.walk.approach_speed == pytest.approx(APPROACH_SPEED * SLOW.leg / SLOW.beat)
    weak = replace(load_robot("h1"), single_support=0.8, approach_support=1.1)
    for scene, single in ((uneven, 1.1), (load_scene("flat", ["approach_height=0"]).for_body(SLOW), 0.8)):
        assert controller_settings(scene, weak, SLOW, {}).timing.single_support == pytest.approx(single)


def test_a_time_that_a_scene_states_is_kept_or_refused():
    stated = load_scene("uneven", ["single_support=0.9"]).for_body(SLOW)
    weak = replace(load_robot("h1"), single_support=0.8, approach_support=1.1)
    assert controller_settings(stated, weak, SLOW, {}).timing.single_support == pytest.approx(0.9)
    with pytest.raises(InputError, match=r"single_support = 0\.9 s.* rocks .* allowed: 0"):
        walk_timing(stated.walk, replace(weak, rocks=True), SLOW)


def test_a_motor_that_is_named_for_a_weak_ankle_loads_the_soles_middle():
    weight = 500.0
    h1 = load_robot("h1")
    low, high = h1.layouts["left"].outline[:, 0].min(), h1.layouts["left"].outline[:, 0].max()
    middle = 0.5 * (low + high)

    def with_motor(torque):
        robot = replace(h1, effort_limits=(1000.0,) * 4 + (torque, 1000.0))
        return replace(robot, ankle_reach=ankle_reach(robot, weight, 4))

    assert _weak_ankle(with_motor(1.05 * weight * middle), weight, 4) == []
    weak = with_motor(0.8 * weight * middle)
    (note,) = _weak_ankle(weak, weight, 4)
    assert note.startswith(weak.legs["left"].joints[4])
    works = float(re.search(r"a motor of (\d+) N m", note)[1])
    assert with_motor(works).middle_of_sole("left")[0] == pytest.approx(middle, abs=0.03 * high)
    assert weak.middle_of_sole("left")[0] < 0.5 * middle
