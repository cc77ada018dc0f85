import mujoco
import numpy as np
import pytest

from sim.scene import Sensing
from sim.sensors import SensorSuite
from sim.world import World

QUIET = Sensing(force_noise=0.0, encoder_noise=0.0, gyro_noise=0.0, accelerometer_noise=0.0)


def test_noise_free_sensors_tell_the_state(world: World) -> None:
    mujoco.mj_forward(world.model, world.data)
    suite = SensorSuite(world, QUIET, 0)
    assert suite.sample_skin(0)
    sensors = suite.sample_body()
    assert np.array_equal(sensors.joint_positions, world.data.qpos[world.joint_qpos])
    assert np.array_equal(sensors.gyro, world.data.sensor("imu_gyro").data)
    assert np.array_equal(sensors.accelerometer, world.data.sensor("imu_accelerometer").data)


def test_noise_has_the_stated_size_and_follows_the_seed(world: World) -> None:
    mujoco.mj_forward(world.model, world.data)
    sensing = Sensing(encoder_noise=1e-3, gyro_noise=2e-2, accelerometer_noise=0.3)

    def series(seed: int) -> np.ndarray:
        suite = SensorSuite(world, sensing, seed)
        suite.sample_skin(0)
        rows = []
        for _ in range(500):
            s = suite.sample_body()
            rows.append(np.concatenate([s.joint_positions, s.gyro, s.accelerometer]))
        return np.array(rows)

    first = series(1)
    assert np.array_equal(first, series(1))
    assert not np.array_equal(first, series(2))
    spread = first.std(axis=0)
    assert spread[:12] == pytest.approx(np.full(12, 1e-3), rel=0.15)
    assert spread[12:15] == pytest.approx(np.full(3, 2e-2), rel=0.15)
    assert spread[15:] == pytest.approx(np.full(3, 0.3), rel=0.15)


def test_skin_is_sampled_at_its_rate(world: World) -> None:
    mujoco.mj_forward(world.model, world.data)
    suite = SensorSuite(world, Sensing(), 0)
    due = []
    for k in range(20):
        due.append(suite.sample_skin(k))
        mujoco.mj_step(world.model, world.data)
    assert [k for k, d in enumerate(due) if d] == [0, 4, 8, 12, 16]
