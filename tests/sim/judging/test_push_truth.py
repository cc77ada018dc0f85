"""The judge of pushes: steps compared by the way from foot to foot, and accelerations against a simulated pendulum."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plantar.common.gravity import GRAVITY
from plantar.gait.plan.footsteps import straight_plan
from plantar.sim.judging.push_truth import CHANGED, Pushed, PushTruth, Stride, step_changes, strides
from plantar.sim.judging.step_count import Stand

FEET, STEPS = straight_plan(6, length=0.0)
LEG = 0.6


def stands(*offsets: tuple[float, float]) -> list[Stand]:
    return [
        Stand(step.side, float(k), (step.x + dx, step.y + dy, 0.0))
        for k, (step, (dx, dy)) in enumerate(zip(STEPS, offsets, strict=False))
    ]


def test_only_the_step_that_left_the_plan_is_changed():
    moved = stands((0, 0), (0, 0), (0.08, 0.0), (0.08, 0.0), (0.08, 0.0))
    assert step_changes(moved, FEET, STEPS) == pytest.approx([0.0, 0.0, 0.08, 0.0, 0.0])


def test_changes_end_where_the_feet_come_out_of_turn():
    wrong = stands((0, 0), (0, 0), (0, 0))
    wrong[2] = replace(wrong[2], side=wrong[1].side)
    assert len(step_changes(wrong, FEET, STEPS)) == 2
    assert step_changes([], FEET, STEPS) == []


def pushes() -> list[Pushed]:
    return [
        Pushed(0, 1.0, 1.2, np.array([0.0, 12.0]), small=True),
        Pushed(3, 4.0, 4.2, np.array([0.0, 30.0]), small=False),
    ]


@pytest.mark.parametrize(
    ("changes", "criteria"),
    [
        ([0.0, 0.0, 0.0, 0.06, 0.0], []),
        ([0.0, 0.04, 0.0, 0.06, 0.0], ["steps_kept"]),
        ([0.0, 0.0, 0.0, 0.0, 0.01], ["stepped"]),
        ([], ["stepped"]),
    ],
)
def test_small_pushes_keep_the_steps_and_large_ones_change_one(changes, criteria):
    found = PushTruth(86.0, LEG).steps_reasons(pushes(), changes)
    assert [reason["criterion"] for reason in found] == criteria
    assert all(reason["limit"] == pytest.approx(CHANGED * LEG) for reason in found)


@pytest.mark.parametrize("above", [-0.2, 0.0, 0.4])
def test_a_pendulum_with_a_wrench_accelerates_by_the_corrected_sign(above):
    """Moments about the ZMP of an upright body, integrated here by themselves."""
    mass, height, zmp = 86.0, 0.83, np.array([0.02, -0.01])
    truth, step = PushTruth(mass, LEG), 0.005
    com, speed = np.array([0.0, 0.0, height]), np.zeros(2)
    way = np.array([math.cos(0.7), math.sin(0.7)])
    for k in range(100):
        time = step * k
        force = 150.0 * math.sin(math.pi * (time - 0.1) / 0.2) * way if 0.1 <= time < 0.3 else np.zeros(2)
        wrench = np.array([*force, 0.0, 0.0, 0.0, 0.0])
        wrench[3:] = np.cross(com + np.array([0.0, 0.0, above]), wrench[:3])
        truth.update(time, com, zmp, wrench)
        fine = 20
        for _ in range(fine):
            rate = GRAVITY / height * (com[:2] - zmp) + force * (height + above) / height / mass
            speed = speed + rate * step / fine
            com[:2] += speed * step / fine
    impulse = 150.0 * 0.2 * 2.0 / math.pi * way
    (told,) = truth.accelerations([Pushed(0, 0.1, 0.3, impulse, small=False)])
    assert told["above_com_m"] == pytest.approx(above, abs=1e-9)
    assert told["ratio"] == pytest.approx(1.0, abs=0.01)
    assert told["printed_Ns"] == pytest.approx(told["predicted_Ns"] * (height - above) / (height + above))
    assert truth.acceleration_reasons([Pushed(0, 0.1, 0.3, impulse, small=False)]) == []


@pytest.mark.parametrize("stride", [0.8, 0.0])
def test_what_the_walk_itself_does_to_the_pendulum_is_taken_off(stride):
    """A moment about the CoM that comes again with every stride, as that of legs that swing; it is no push."""
    mass, height, step, fine = 86.0, 0.83, 0.005, 20
    truth, at, speed = PushTruth(mass, LEG, stride), 0.0, 0.02
    for k in range(230):
        time = step * k
        force = 80.0 * math.sin(math.pi * (time - 0.9) / 0.2) if 0.9 <= time < 1.1 else 0.0
        truth.update(time, np.array([at, 0.0, height]), np.zeros(2), np.array([force, 0, 0, 0, height * force, 0]))
        moment = 20.0 * math.sin(2.0 * math.pi * (time - 0.85) / 0.8)
        for _ in range(fine):
            speed += (GRAVITY / height * at + (force * height + moment) / height / mass) * step / fine
            at += speed * step / fine
    impulse = 80.0 * 0.2 * 2.0 / math.pi
    (told,) = truth.accelerations([Pushed(2, 0.9, 1.1, np.array([impulse, 0.0]), small=False)])
    of_the_walk = 20.0 * 0.4 / math.pi * (math.cos(0.035 * math.tau / 0.8) - math.cos(0.265 * math.tau / 0.8)) / height
    assert told["ratio"] == pytest.approx(1.0 if stride else 1.0 + of_the_walk / impulse, abs=0.01)


def test_an_unexplained_acceleration_is_reported():
    truth = PushTruth(86.0, LEG)
    for k in range(100):
        time = 0.005 * k
        force = 100.0 if 0.1 <= time < 0.3 else 0.0
        truth.update(time, np.array([0.0, 0.0, 0.8]), np.zeros(2), np.array([force, 0.0, 0.0, 0.0, 0.8 * force, 0.0]))
    (reason,) = truth.acceleration_reasons([Pushed(0, 0.1, 0.3, np.array([20.0, 0.0]), small=False)])
    assert reason["criterion"] == "com_acceleration"


def test_a_stride_is_the_way_of_the_foot_itself():
    found = strides(stands((0.05, 0.0), (0.0, 0.0), (0.15, 0.01)), FEET, STEPS)
    assert [s.true for s in found] == [pytest.approx(way) for way in ((0.05, 0.0), (0.0, 0.0), (0.1, 0.01))]
    assert all(s.planned == (0.0, 0.0) for s in found)


def test_a_step_reacts_that_grows_along_its_push():
    ways = [Stride((0.0, 0.06), (0.0, 0.0)), Stride((0.0, 0.0), (0.0, 0.0))]
    pushes = [Pushed(k, 1.0 + k, 1.2 + k, np.array([0.0, 12.0]), small=False) for k in range(2)]
    truth = PushTruth(86.0, LEG)
    assert truth.stride_reasons(pushes[:1], ways) == []
    (reason,) = truth.stride_reasons(pushes, ways)
    assert (reason["criterion"], reason["value"], reason["limit"]) == ("strides", 1, 2)
    assert truth.stride_reasons([pushes[0]._replace(impulse=np.array([0.0, -12.0]))], ways)
