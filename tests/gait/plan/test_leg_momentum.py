"""The plan's shift, and what it expects of the base, against MuJoCo's dynamics of the motion that it plans."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.feet.swing import SwingTrajectory
from plantar.gait.feet.swing_flight import PolynomialSwing
from plantar.gait.feet.swing_kind import SwingStart
from plantar.gait.plan import leg_momentum
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.leg_momentum import LegMomentum
from plantar.gait.plan.phases import PhaseKind, Timing
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.mechanics.leg_inertia import LegInertia
from plantar.mechanics.lip import pendulum_frequency
from plantar.robots import load_robot
from plantar.robots.kinematics.leg_inertia import leg_inertia
from plantar.robots.kinematics.robot_model import build_leg_model

PERIOD, OMEGA = 0.01, 3.4
FREE = np.empty((0, 2))
MIDDLES = dict.fromkeys(SIDES, np.zeros(2))


def missed(robot, legs, leg: LegInertia) -> np.ndarray:
    """Planned VRP less the motion's ZMP (n, 2) in m, and the base's acceleration likewise in m/s^2: (n, 4), in single
    support.
    """
    inertia = leg.turning
    height, (feet, steps) = robot.com_height, straight_plan(4, length=0.2, width=robot.stance_width)
    omega = pendulum_frequency(height, 2.0 * inertia)
    plan = WalkPlan(feet, steps, Timing(0.7, 0.2, settle=0.5), MIDDLES, omega, 0.5)
    momentum, model, data = LegMomentum(plan, omega, inertia, 0.94), legs.model, mujoco.MjData(legs.model)
    posture = np.array([*robot.posture["left"], *robot.posture["right"]])
    legs.set_configuration(np.array([0.0, 0.0, height]), np.array([1.0, 0.0, 0.0, 0.0]), posture)
    times, postures, wanted, alone = np.arange(0.4, plan.schedule.walking_end, PERIOD), [], [], []
    for time in times.tolist():
        phase, shift, places = plan.schedule.at(time), momentum.at(time), {s: feet[s].position for s in SIDES}
        for step in steps[: phase.step]:
            places[step.side] = step.position
        if phase.swing is not None:
            ends = places[phase.swing], steps[phase.step].position
            swing = SwingTrajectory(*ends, 0.0, 0.0, 0.05, phase.end - phase.start)
            places[phase.swing] = swing.at(time - phase.start)[0]
        reference = plan.at(time).plus(shift)
        error = legs.follow(np.array([*reference.com, height]), np.eye(3), places, dict.fromkeys(SIDES, np.eye(3)), 5)
        assert error < 1e-4
        postures.append(legs.configuration)
        base = leg.base_acceleration(reference.com_acceleration, momentum.accelerations(reference, shift)[1])
        wanted.append([*reference.vrp, *base])
        alone.append(phase.kind == PhaseKind.SINGLE_SUPPORT)
    found, (before, after) = [], np.zeros((2, model.nv))
    for last, now, following in zip(postures, postures[1:], postures[2:], strict=False):
        mujoco.mj_differentiatePos(model, before, PERIOD, last, now)
        mujoco.mj_differentiatePos(model, after, PERIOD, now, following)
        data.qpos[:], data.qvel[:], data.qacc[:] = now, 0.5 * (before + after), (after - before) / PERIOD
        mujoco.mj_inverse(model, data)
        force, moment = data.qfrc_inverse[:3], data.xmat[1].reshape(3, 3) @ data.qfrc_inverse[3:6]
        moment = moment + np.cross(now[:3], force)
        found.append([-moment[1] / force[2], moment[0] / force[2], *data.qacc[:2]])
    return (np.array(wanted[1:-1]) - found)[np.array(alone[1:-1])]


@pytest.mark.parametrize("name", ["h1", "hrp2kai"])
def test_soles_press_and_the_base_accelerates_as_planned(name):
    robot = load_robot(name)
    legs = build_leg_model(robot)
    legs.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    legs.model.dof_damping[:] = 0.0
    inertia = leg_inertia(robot, legs, robot.com_height)
    without, counted = (np.sqrt((missed(robot, legs, leg) ** 2).mean(axis=0)) for leg in (LegInertia(), inertia))
    assert inertia.turning > 0.0
    assert (counted < 0.5 * without).all()
    assert counted[:2].max() < 8e-3


def walked(steps: int = 12, inertia: float = 5e-3) -> tuple[WalkPlan, LegMomentum]:
    plan = WalkPlan(*straight_plan(steps, length=0.2), Timing(0.7, 0.2), MIDDLES, OMEGA, 0.5)
    return plan, LegMomentum(plan, OMEGA, inertia, 0.94)


def test_the_shift_is_a_pendulums_over_what_the_swinging_leg_takes():
    """x' = w (x - p) and c' = w (x - c) at every time; it begins and ends at nothing."""
    plan, momentum = walked()
    step, seen = 1e-5, []
    for time in np.arange(0.0, plan.schedule.walking_end + 3.0, 0.0503).tolist():
        now = momentum.at(time)
        after = momentum._shift.at(time + step)
        assert (after.dcm - now.dcm) / step == pytest.approx(OMEGA * (now.dcm - now.vrp), abs=2e-3)
        assert (after.com - now.com) / step == pytest.approx(OMEGA * (now.dcm - now.com), abs=1e-3)
        assert now.com_velocity == pytest.approx(OMEGA * (now.dcm - now.com), abs=1e-9)
        seen.append(now.com)
    assert np.abs(seen[0]).max() < 1e-3 < np.abs(seen).max()
    assert np.abs(seen[-1]).max() < 1e-5
    assert np.abs(np.array(seen)[:, 1]).max() < 1e-12  # the feet go straight on


def test_the_next_four_steps_count_as_all_do(monkeypatch):
    (plan, near), times = walked(), np.arange(0.0, 8.0, 0.1).tolist()
    coms = np.array([near.at(time).com for time in times])
    monkeypatch.setattr(leg_momentum, "_AHEAD", 100)
    far = LegMomentum(plan, OMEGA, 5e-3, 0.94)
    assert np.array([far.at(time).com for time in times]) == pytest.approx(coms, abs=1e-5)
    assert np.abs(coms).max() > 2e-3


def test_a_changed_plan_moves_the_com_by_no_jump():
    plan, momentum = walked()
    phase = next(p for p in plan.schedule.phases if p.swing is not None and p.step == 3)
    time = phase.start + 0.3
    before = momentum.at(time)
    place = plan.view.foothold(3)
    plan.apply(
        PlanChange("a test", 3, foothold=replace(place, x=place.x + 0.1), vrp=(place.x + 0.1, place.y)), time, FREE
    )
    after = momentum.at(time)
    assert after.com == pytest.approx(before.com, abs=1e-12)
    assert after.dcm[0] != before.dcm[0]


def test_legs_without_inertia_shift_nothing():
    plan, momentum = walked(inertia=0.0)
    shift = momentum.at(plan.schedule.phases[2].start + 0.2)
    reference = plan.at(1.0)
    assert not any(part.any() for part in (shift.vrp, shift.dcm, shift.com))
    assert reference.plus(shift).com.tolist() == reference.com.tolist()


@pytest.mark.parametrize(("length", "single"), [(0.2, 0.9), (0.2, 0.8), (0.24, 0.6)])
def test_a_foot_moves_as_the_plan_counts_on_and_as_gently_as_there_is_time_for(length, single):
    plan = WalkPlan(*straight_plan(6, length=length), Timing(single, 0.2), MIDDLES, OMEGA, 0.5)
    momentum = LegMomentum(plan, OMEGA, 5e-3, 0.75)
    phase = next(p for p in plan.schedule.phases if p.swing is not None and p.step == 2)
    start, end = np.zeros(3), np.array([2.0 * length, 0.0, 0.0])
    swing = PolynomialSwing().begin(SwingStart(start, 0.0, end, 0.0, 0.05, single, PERIOD, 0.1, sees_ground=True))
    times = np.arange(0.0, single, PERIOD)
    shifts = [momentum.at(phase.start + t) for t in times]
    counted = np.array([momentum.accelerations(shift, shift)[1][0] for shift in shifts])
    moved = np.gradient(np.gradient([swing.at(t)[0][0] for t in times], times), times)
    assert np.sqrt(np.mean((counted - moved) ** 2)) < 0.1 * np.abs(moved).max()
    latest = 10.0 / np.sqrt(3.0) * 2.0 * length / (0.88 * single) ** 2
    assert np.abs(moved).max() < 1.02 * max(0.7 * 9.81, latest)
