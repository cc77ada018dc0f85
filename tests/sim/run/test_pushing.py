import mujoco
import numpy as np
import pytest

from plantar.common.settings.body_scale import BodyScale
from plantar.errors import SceneError
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import Timing, WalkSchedule
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Push, load_scene

SCHEDULE = WalkSchedule.of([s.side for s in straight_plan(6)[1]], Timing(), begin=1.0)


def test_the_push_has_its_impulse_time_and_direction(world):
    pusher = Pusher(Push(impulse=20.0, duration=0.1, direction="left", step=2), SCHEDULE, seed=0)
    swing = next(p for p in SCHEDULE.phases if p.swing and p.step == 2)
    assert pusher.shoves[0].start == pytest.approx(0.5 * (swing.start + swing.end))
    impulse = np.zeros(3)
    for k in range(8000):
        world.data.time = 0.001 * k
        pusher.apply(world)
        impulse += 0.001 * world.data.xfrc_applied[world.torso, :3]
    assert impulse == pytest.approx([0.0, 20.0, 0.0], rel=0.02)


def test_seeds_choose_all_directions_and_repeat():
    push = Push(impulse=20.0)
    chosen = [Pusher(push, SCHEDULE, seed) for seed in range(20)]
    assert [p.direction for p in chosen[:4]] == ["forward", "backward", "left", "right"]
    assert len({p.step for p in chosen}) >= 4
    again = [Pusher(push, SCHEDULE, seed) for seed in range(20)]
    assert [(p.direction, p.step) for p in chosen] == [(p.direction, p.step) for p in again]


def test_a_push_by_a_velocity_goes_with_the_mass(world):
    body = BodyScale(mass=30.0, leg=0.4, sole=0.2, sole_width=0.1)
    for push, impulse in ((Push(dv=0.2), 6.0), (Push(dv=0.2, impulse=20.0), 20.0)):
        (shove,) = Pusher(push.for_body(body), SCHEDULE, 0).shoves
        assert float(np.linalg.norm(shove.impulse)) == pytest.approx(impulse)


def test_steps_without_a_push_are_known_before(world):
    shove = Push(impulse=20.0, step=1, duration=0.05)
    pusher = Pusher(shove, SCHEDULE, 0)
    start = pusher.shoves[0].start
    rng = np.random.default_rng(1)
    for _ in range(20):  # of times at which rounding may go either way
        world.data.time = start - 10 * world.period + rng.normal(0.0, 1e-12)
        free = pusher.free_steps(world, 50)
        assert 7 <= free <= 9
        for _ in range(free):
            pusher.apply(world)
            assert not pusher.pushing
            world.data.time += world.period
    assert pusher.free_steps(world, 3) == 0
    begun = 0
    while not pusher.applied or pusher.pushing:
        begun += pusher.pushing
        assert pusher.free_steps(world, 3) == 0
        pusher.apply(world)
        world.data.time += world.period
    assert begun >= round(0.05 / world.period)
    assert pusher.free_steps(world, 3) == 3


def test_no_impulse_makes_no_push(world):
    pusher = Pusher(Push(), SCHEDULE, 0)
    world.data.time = 3.0
    pusher.apply(world)
    assert pusher.step is None
    assert not world.data.xfrc_applied.any()


def test_a_step_that_is_not_walked_is_an_error():
    with pytest.raises(SceneError, match="6 steps"):
        Pusher(Push(impulse=1.0, step=6), SCHEDULE, 0)


STANDING = WalkSchedule.of((), Timing(settle=24.0), begin=1.0)


def test_a_standing_robot_is_pushed_smoothly_all_around():
    push = Push(impulse=30.0, duration=1.0, count=6, interval=3.5, sideways=0.5)
    angles = []
    for seed in range(20):
        shoves = Pusher(push, STANDING, seed).shoves
        assert [s.start for s in shoves] == pytest.approx(1.5 + 3.5 * np.arange(6))
        for shove in shoves:
            times = np.arange(shove.start - 0.1, shove.end + 0.1, 1e-3)
            forces = np.array([shove.force(t, 1e-3) for t in times])
            assert forces.sum(axis=0) * 1e-3 == pytest.approx(shove.impulse, rel=1e-9, abs=1e-9)
            assert np.abs(np.diff(forces, axis=0)).max() < 0.5
            assert 0.6 * 30.0 * 0.5 <= np.linalg.norm(shove.impulse) <= 30.0
            assert abs(shove.impulse[1]) <= 15.0
            angles.append(np.arctan2(shove.impulse[1], shove.impulse[0]))
    assert np.histogram(angles, 4, (-np.pi, np.pi))[0].min() > 10


def test_a_push_at_the_neck_tips_as_well(world):
    pusher = Pusher(Push(impulse=20.0, duration=1.0, count=1, height=0.6, direction="forward"), STANDING, 0)
    world.data.time = 1.9995  # a step about the middle of the push
    pusher.apply(world)
    fx = float(world.data.xfrc_applied[world.torso, 0])
    assert fx == pytest.approx(20.0 * np.pi / 2.0, rel=1e-6)
    assert world.data.xfrc_applied[world.torso].tolist() == pytest.approx([fx, 0.0, 0.0, 0.0, 0.6 * fx, 0.0])
    world.data.time = 2.6
    pusher.apply(world)
    assert not world.data.xfrc_applied[world.torso].any()


@pytest.mark.parametrize("duration", [1.5e-3, 0.1, 0.1004])
def test_what_is_applied_is_what_was_asked_for_whatever_the_duration(world, duration):
    pusher = Pusher(Push(impulse=20.0, duration=duration, step=2, phase=0.31), SCHEDULE, 0)
    applied = np.zeros(3)
    while world.data.time < pusher.shoves[0].end + 0.01:
        pusher.apply(world)
        applied += world.period * world.data.xfrc_applied[world.torso, :3]
        world.data.time += world.period
    assert applied == pytest.approx([20.0, 0.0, 0.0], abs=1e-6)
    assert pusher.applied[0] == pytest.approx(applied, abs=1e-9)
    assert not world.data.xfrc_applied.any()


@pytest.mark.parametrize(
    ("push", "schedule", "word"),
    [
        (Push(impulse=1.0, count=3), SCHEDULE, "6 steps"),
        (Push(impulse=1.0, count=60), STANDING, "ends after 25 s"),
        (Push(impulse=1.0, count=2, duration=5.0, interval=1.0), STANDING, "duration below"),
    ],
)
def test_pushes_that_do_not_fit_are_refused(push, schedule, word):
    with pytest.raises(SceneError, match=word):
        Pusher(push, schedule, 0)


def test_a_push_in_mid_swing_is_estimated_less_the_swing():
    """Against what the true CoM does beyond a pendulum with legs, by the same low pass."""
    sim = Simulation(load_scene("push", ["walk.steps=3", "push.step=1", "push.direction=forward"], "h1"))
    (estimator, step), model, data = (
        (sim.controller.estimation.estimator, sim.controller.step),
        sim.world.model,
        sim.world.data,
    )
    root, rows = model.body_rootid[sim.world.torso], []

    def stepped(sensors):
        command = step(sensors)
        mujoco.mj_subtreeVel(model, data)
        legs = -(estimator.omega**2) * sim.controller.momentum.at(sensors.time).vrp
        pendulum = estimator.omega**2 * (data.subtree_com[root][:2] - command.state.zmp) + legs
        rows.append([sensors.time, data.subtree_linvel[root][0], pendulum[0], estimator.push_acceleration[0]])
        return command

    sim.controller.step = stepped
    sim.run()
    times, speed, pendulum, estimated = np.array(rows).T
    true = np.gradient(speed, times) - pendulum
    low = [0.0]
    share = -np.expm1(-sim.settings.period / sim.settings.push_estimate.time_constant)
    for value in true:
        low.append(low[-1] + share * (value - low[-1]))
    (shove,) = sim.pusher.shoves
    during = (times > shove.start + 0.03) & (times <= shove.end)
    error = estimated[during] - np.array(low[1:])[during]
    assert np.mean(true[during]) > 1.5
    assert not estimated[times < shove.start].any()
    assert np.sqrt(np.mean(error**2)) < 0.4  # m/s^2; 0.66 with the base's share of the swing
