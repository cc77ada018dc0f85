"""The environments: Gymnasium's own checker, the same seed the same episode, skin that adds up, vectors of them."""

from dataclasses import replace

import numpy as np
import pytest

from plantar import InputError
from plantar.sensing.taxel_faults import TaxelFaults

gymnasium = pytest.importorskip("gymnasium")
mujoco = pytest.importorskip("mujoco")

from gymnasium.utils.env_checker import check_env  # noqa: E402

from plantar.sim.environments import ENVIRONMENTS  # noqa: E402
from plantar.sim.environments.walker import PlantarEnv  # noqa: E402
from plantar.sim.model.world import build_world  # noqa: E402


@pytest.mark.sample(2)
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_gymnasium_finds_nothing_wrong(name):
    check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


@pytest.mark.sample(1, each="robot")
@pytest.mark.parametrize("task", ENVIRONMENTS.values())
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_the_skin_adds_up_and_a_seed_repeats_an_episode(task, robot):
    env = PlantarEnv(task, robot)
    runs = []
    for _ in range(2):
        seen, _ = env.reset(seed=5)
        rewards = []
        for action in 0.2 * np.random.default_rng(1).uniform(-1.0, 1.0, (25, len(env.last_action))):
            seen, reward, fell, _, info = env.step(action)
            for side, load in zip(("left", "right"), info["load"], strict=True):
                assert seen[f"skin_{side}"].sum() == pytest.approx(load, rel=1e-4, abs=1e-5)
            assert seen in env.observation_space
            assert reward <= 1.0
            assert not fell
            rewards.append(reward)
        runs.append((rewards, seen))
    assert runs[0][0] == runs[1][0]
    assert all(np.array_equal(runs[0][1][k], runs[1][1][k]) for k in seen)


@pytest.mark.sample(2)
@pytest.mark.parametrize("mounted", [(1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5)])
def test_the_imu_reads_in_the_torsos_frame_however_it_is_mounted(mounted, monkeypatch):
    def build(robot, *given):
        world = build_world(robot, *given)
        world.model.site(robot.imu_site).quat = mounted
        return world

    monkeypatch.setattr("plantar.sim.environments.walker.build_world", build)
    env = PlantarEnv("stand", skin=False)
    env.reset(seed=1)
    for _ in range(30):
        imu = env.step(np.zeros(12))[0]["imu"]
    assert imu[3:6] == pytest.approx(-9.81 * imu[6:], abs=0.4)
    assert np.abs(imu[:3]).max() < 0.1


def test_ground_and_command_of_a_walk_are_drawn_again():
    env = PlantarEnv("walk")
    env.reset(seed=1)
    first = env.model.geom_pos.copy(), env.step(np.zeros(12))[0]["task"]
    env.reset()
    second = env.model.geom_pos.copy(), env.step(np.zeros(12))[0]["task"]
    assert not np.array_equal(first[0], second[0])
    assert not np.array_equal(first[1], second[1])
    assert np.ptp(second[0][:, 2]) > 0.0


@pytest.mark.parametrize("task", ["walk", "step"])
def test_what_a_step_is_rewarded_for_is_observed_before_it(task):
    env = PlantarEnv(task)
    first = env.reset(seed=1)[0]["task"]
    then = env.step(np.zeros(12))[0]["task"]
    assert first.any()
    assert np.array_equal(first, then) if task == "walk" else first[2:] == pytest.approx(then[2:], abs=0.02)


def test_a_swing_is_never_over_its_end():
    """Its time is no whole number of steps, and what is rewarded grows with the share of it that is over."""
    env = PlantarEnv("step")
    env.reset(seed=0)
    shares = [env.step(np.zeros(12))[0]["task"][1] for _ in range(60)]
    assert max(shares) == 1.0


def test_velocities_are_those_of_a_torso_that_is_turned_on_its_base():
    env = PlantarEnv("stand")
    env.reset(seed=1)
    chest = env.model.body("chest")
    chest.pos, chest.quat = (0.1, 0.0, 0.2), (0.5, 0.5, 0.5, 0.5)
    env.world = replace(env.world, torso=chest.id)
    env.data.qvel[:6] = 0.1, 0.2, 0.3, 0.4, 0.5, 0.6
    mujoco.mj_forward(env.model, env.data)
    true = np.zeros(6)
    mujoco.mj_objectVelocity(env.model, env.data, mujoco.mjtObj.mjOBJ_XBODY, chest.id, true, 0)
    assert np.hypot(*env.velocity[:2]) == pytest.approx(np.hypot(*true[3:5]))
    assert env.velocity[2] == pytest.approx(true[2])


def test_physics_that_diverge_end_the_episode():
    env = PlantarEnv("stand")
    env.reset(seed=1)
    env.data.qvel[0] = 1e11
    assert env.step(np.zeros(12))[2]
    env.reset(seed=1)
    assert not env.step(np.zeros(12))[2]


def test_a_robot_that_falls_ends_the_episode():
    env = PlantarEnv("stand")
    env.reset(seed=0)
    ends = [env.step(np.tile([0.0, 0.0, 1.0, 0.0, -1.0, 0.0], 2))[2] for _ in range(150)]
    assert ends[0] is False
    assert any(ends)


def test_without_skin_and_with_faults():
    assert "skin_left" not in PlantarEnv("stand", skin=False).observation_space.spaces
    env = PlantarEnv("stand", faults=TaxelFaults(gain=0.2, noise=1.0, dead=0.1))
    a, b = env.reset(seed=1)[0]["skin_left"], env.reset(seed=2)[0]["skin_left"]
    assert not np.array_equal(a, b)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"task": "fly"}, "allowed: stand, step, walk, board"),
        ({"render_mode": "human"}, "rgb_array"),
        ({"period": 0.0}, "above 0"),
        ({"period": 0.005}, "whole multiples of physics_period, 0.002 s"),
        ({"physics_period": -1.0}, "above 0"),
        ({"difficulty": -1.0}, "0 or more"),
        ({"faults": 0.1}, "expected a TaxelFaults"),
    ],
)
def test_wrong_arguments_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        PlantarEnv(**given)


def test_a_video_runs_at_the_environments_pace():
    assert [PlantarEnv(period=period).metadata["render_fps"] for period in (0.02, 0.01)] == [50, 100]


def test_a_step_before_the_first_reset_is_refused():
    with pytest.raises(InputError, match="call reset"):
        PlantarEnv().step(np.zeros(12))


def test_many_at_once():
    envs = gymnasium.make_vec("plantar.sim.environments:PlantarStand-v0", num_envs=2, vectorization_mode="sync")
    seen, _ = envs.reset(seed=3)
    assert seen["skin_left"].shape[0] == 2
    seen, reward, *_ = envs.step(np.zeros((2, 12), dtype=np.float32))
    assert reward.shape == (2,)
    envs.close()


@pytest.mark.sample(1)
@pytest.mark.parametrize("task", ["step", "walk"])
def test_standing_still_fails_a_task_that_asks_for_steps(task):
    env = PlantarEnv(task, skin=False)
    env.reset(seed=0)
    for _ in range(500):
        _, _, ended, truncated, info = env.step(np.zeros_like(env.last_action))
        if ended:
            break
    assert info["failed"]
    assert not info["fell"]
    assert not truncated
    if task == "step":
        assert info["missed"] == 3
        assert info["steps"] == 0
    else:
        assert info["behind"] > 1.0


def test_what_is_behind_is_the_command_less_the_way():
    """Told to walk at a steady velocity, a robot that stands is behind by that times the time."""
    env = PlantarEnv("walk", skin=False, difficulty=0.0)
    env.reset(seed=0)
    env.task._next = np.inf
    env.task.command = np.array([0.2, -0.1, 0.0])
    for k in range(1, 41):
        *_, info = env.step(np.zeros_like(env.last_action))
        told = np.hypot(0.2, 0.1) * k * env.period / env.task.beat
        assert info["behind"] == pytest.approx(told, abs=0.03)
    assert not info["failed"]
