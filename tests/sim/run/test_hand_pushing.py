"""Which pushes by hands a scene asks for: when, where, how strong."""

import mujoco
import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.settings.schema import Settings
from plantar.errors import SceneError
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import Timing, WalkSchedule
from plantar.sim.partner.hand_pushes import HandPushes
from plantar.sim.run.hand_pushing import hand_pushes
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Push, load_scene

from ..partner.floating import box_skin

FEET, STEPS = straight_plan(8, length=0.1)
SCHEDULE = WalkSchedule.of([s.side for s in STEPS], Timing(), begin=1.0)
SKIN = box_skin()


def hands(seed: int = 0, schedule: WalkSchedule = SCHEDULE, **given: object) -> HandPushes:
    push = Push(**({"by": "hands", "impulse": 20.0, "duration": 0.1} | given))
    return hand_pushes(push, lambda: schedule, (FEET, STEPS), SKIN, REFERENCE_BODY, seed)


def support(step: int, schedule: WalkSchedule = SCHEDULE) -> tuple[float, float]:
    phase = next(p for p in schedule.phases if p.swing is not None and p.step == step)
    return phase.start, phase.end


def test_a_small_push_comes_steps_before_the_large_one_and_at_the_same_phase():
    pushes = hands(step=6, small=0.4, small_before=4, direction="left", phase=0.25).pushes
    assert [p.step for p in pushes] == [2, 6]
    np.testing.assert_allclose([p.impulse for p in pushes], [[0.0, 8.0], [0.0, 20.0]])
    for push in pushes:
        start, end = support(push.step)
        assert push.when() == pytest.approx(start + 0.25 * (end - start))


def test_a_push_may_come_anywhere_in_a_stride_and_in_any_direction():
    (push,) = hands(step=2, cycle=0.5, direction="angle", angle=-120.0).pushes
    assert push.when() == pytest.approx(0.5 * (support(2)[0] + support(4)[0]))
    np.testing.assert_allclose(push.impulse, 20.0 * np.array([-0.5, -np.sqrt(0.75)]))
    assert set(push.shares()) == {"front", "left"}


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("place", ["com", "hip", "shoulder"])
def test_a_named_place_is_one_on_the_skin_however_high_the_robot_stands(robot, place):
    simulation = Simulation(load_scene("push-height", [f"push.place={place}", "push.direction=left"], robot), 0)
    world, touched = simulation.world, simulation.touch
    for base in np.random.default_rng(0).uniform(0.3, 3.0, 50):  # the last bits of sums differ from one to the next
        world.data.qpos[2] = base
        mujoco.mj_forward(world.model, world.data)
        touched.place()


@pytest.mark.parametrize(("direction", "side"), [("left", "left"), ("right", "right")])
def test_pushes_to_a_side_wait_for_the_foot_that_swings_there(direction, side):
    for step in (4, 5):
        (push,) = hands(step=step, direction=direction, with_swing=True).pushes
        assert push.step in (step, step + 1)
        assert STEPS[push.step].side == side
        (ahead,) = hands(step=step, direction="forward", with_swing=True).pushes
        assert ahead.step == step


def test_pushes_along_the_steps_follow_the_feet():
    pushes = hands(step=1, repeat=3, direction="step").pushes
    assert [p.step for p in pushes] == [1, 2, 3]
    np.testing.assert_allclose([p.impulse for p in pushes], [[20.0, 0.0]] * 3, atol=1e-9)


def test_a_push_moves_with_a_plan_that_changes():
    later = WalkSchedule.of([s.side for s in STEPS], Timing(), begin=1.5)
    plans = [SCHEDULE]
    push = Push(by="hands", impulse=20.0, step=3, direction="left")
    (made,) = hand_pushes(push, lambda: plans[-1], (FEET, STEPS), SKIN, REFERENCE_BODY, 0).pushes
    before = made.when()
    plans.append(later)
    assert made.when() == pytest.approx(before + 0.5)


def test_seeds_choose_direction_and_step_among_those_that_leave_room():
    found = [hands(seed, small=0.5, small_before=4, cycle=0.1) for seed in range(12)]
    assert [tuple(np.sign(h.pushes[-1].impulse)) for h in found[:4]] == [(1, 0), (-1, 0), (0, 1), (0, -1)]
    assert {h.pushes[-1].step for h in found} <= {4, 5}
    assert len({h.pushes[-1].step for h in found}) == 2


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"step": 8}, "allowed: 0 to 7"),
        ({"step": 2, "small": 0.5, "small_before": 4}, "allowed: 4 to 7"),
        ({"step": 6, "cycle": 0.0}, "allowed: 0 to 5"),
        ({"step": 6, "repeat": 3}, "allowed: 0 to 5"),
        ({"step": 0, "repeat": 30}, "allowed: a longer walk"),
        ({"count": 3}, "count is for pushes by a force"),
    ],
)
def test_what_the_walk_has_no_room_for_is_refused(given, words):
    with pytest.raises(SceneError, match=words):
        hands(**given)


@pytest.mark.parametrize(
    "given",
    [{"direction": "step"}, {"cycle": 0.1}, {"repeat": 2}, {"small": 0.5}, {"place": "com"}],
)
def test_a_force_refuses_what_only_hands_do(given):
    push: Settings = Push(impulse=10.0, **given)
    assert isinstance(push, Push)
    with pytest.raises(SceneError, match=f"{next(iter(given))} is for pushes by hands"):
        Pusher(push, SCHEDULE, 0)
