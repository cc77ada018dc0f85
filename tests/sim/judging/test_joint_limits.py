"""The judge of joint speeds and torques against what is counted joint by joint, step by step."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.sim.judging.joint_limits import JointLimits
from plantar.sim.model.world import PHYSICS_PERIOD, build_world
from plantar.sim.terrain import Ground

STEPS = 400


def swinging(rng: np.random.Generator, limits: np.ndarray) -> np.ndarray:
    """Speeds (steps, k) of joints that are mostly slow, some for long beyond their limits, in both directions."""
    time = PHYSICS_PERIOD * np.arange(STEPS)[:, None]
    rate, phase = rng.uniform(5.0, 40.0, len(limits)), rng.uniform(0.0, 6.0, len(limits))
    return limits * rng.uniform(0.1, 1.4, len(limits)) * np.sin(rate * time + phase)


def longest_run(over: np.ndarray) -> int:
    most = run = 0
    for now in over:
        run = run + 1 if now else 0
        most = max(most, run)
    return most


@pytest.fixture
def world(h1):
    return build_world(h1, Ground((), 0.0, 0.8))


@pytest.mark.parametrize("order", ["as in the model", "another"])
@pytest.mark.parametrize("seed", range(5))
def test_speeds_beyond_the_limits_are_counted_joint_by_joint(world, order, seed):
    rng = np.random.default_rng(seed)
    k = len(world.joint_qvel)
    if order == "another":
        world = replace(world, joint_qvel=world.joint_qvel[rng.permutation(k)])
    judge = JointLimits(world)
    limits = np.array([*world.robot.velocity_limits] * 2)
    speeds = swinging(rng, limits)
    for row in speeds:
        world.data.qvel[world.joint_qvel] = row
        judge.extremes.step()
    shares = np.abs(speeds) / limits
    runs = [longest_run(column > 1.0) for column in shares.T]
    assert judge.longest == pytest.approx(PHYSICS_PERIOD * np.array(runs), abs=1e-12)
    assert judge.fastest == pytest.approx(shares.max(axis=0), rel=1e-12)


def test_steps_at_a_torque_limit_are_counted(world):
    rng = np.random.default_rng(0)
    judge, servos = JointLimits(world), world.servos
    limits = world.model.actuator_forcerange[servos, 1]
    torques = limits * rng.uniform(-1.02, 1.02, (300, len(servos))).clip(-1.0, 1.0)
    for row in torques:
        world.data.actuator_force[servos] = row
        judge.extremes.step()
    held = np.abs(torques) >= 0.999 * limits
    found = judge.summary()["torque_limit"]
    assert found["share_of_time"] == pytest.approx(held.any(axis=1).mean(), abs=1e-4)
    wanted = {name: n / 300 for name, n in zip(judge.names, held.sum(axis=0), strict=True) if n}
    assert found["joints"] == pytest.approx(wanted, abs=1e-4)


def test_a_robot_without_limits_is_never_too_fast(world, h1):
    judge = JointLimits(replace(world, robot=replace(h1, velocity_limits=())))
    world.data.qvel[:] = 1e3
    judge.extremes.step()
    assert judge.longest.max() == 0.0
    assert judge.summary()["joint_speed"] is None


def test_a_joint_that_moves_alone_is_seen_at_its_own_limit(world):
    limits = np.array([*world.robot.velocity_limits] * 2)
    for i, limit in enumerate(limits):
        for share in (0.99, -0.99, 1.01, -1.01):
            judge = JointLimits(world)
            world.data.qvel[:] = 0.0
            world.data.qvel[world.joint_qvel[i]] = share * limit
            judge.extremes.step()
            assert (judge.longest > 0.0).tolist() == [j == i and abs(share) > 1.0 for j in range(len(limits))]
