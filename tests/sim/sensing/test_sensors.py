import mujoco
import numpy as np
import pytest

from plantar.robots.kinematics.ankle_sensors import ankle_sensors
from plantar.sim.model.contact_truth import contact_wrench_in_frame, foot_contacts
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.sensing.sensors import SensorSuite
from plantar.sim.sensing.settings import Sensing

QUIET = Sensing(force_noise=0.0, encoder_noise=0.0, gyro_noise=0.0, accelerometer_noise=0.0)


def test_noise_free_sensors_tell_the_state(world):
    mujoco.mj_forward(world.model, world.data)
    suite = SensorSuite(world, QUIET, 0)
    suite.read_skins()
    sensors = suite.read_body()
    assert np.array_equal(sensors.joint_positions, world.data.qpos[world.joint_qpos])
    assert np.array_equal(sensors.gyro, world.data.sensor("imu_gyro").data)
    assert np.array_equal(sensors.accelerometer, world.data.sensor("imu_accelerometer").data)


def test_noise_has_the_stated_size_and_follows_the_seed(world):
    mujoco.mj_forward(world.model, world.data)
    sensing = Sensing(encoder_noise=1e-3, gyro_noise=2e-2, accelerometer_noise=0.3)

    def series(seed: int) -> np.ndarray:
        suite = SensorSuite(world, sensing, seed)
        suite.read_skins()
        rows = []
        for _ in range(500):
            s = suite.read_body()
            rows.append(np.concatenate([s.joint_positions, s.gyro, s.accelerometer]))
        return np.array(rows)

    first = series(1)
    assert np.array_equal(first, series(1))
    assert not np.array_equal(first, series(2))
    spread = first.std(axis=0)
    assert spread[:12] == pytest.approx(np.full(12, 1e-3), rel=0.15)
    assert spread[12:15] == pytest.approx(np.full(3, 2e-2), rel=0.15)
    assert spread[15:] == pytest.approx(np.full(3, 0.3), rel=0.15)


def test_skin_is_sampled_at_its_rate(world):
    mujoco.mj_forward(world.model, world.data)
    suite = SensorSuite(world, Sensing(skin_rate=250.0), 0)
    times = []
    for k in range(20):
        if k % suite.skin_every == 0:
            suite.read_skins()
        times.append(round(1e3 * suite.readings["left"].time))
        mujoco.mj_step(world.model, world.data)
    assert times == [4 * (k // 4) for k in range(20)]


@pytest.mark.parametrize("name", ["h1", "hrp2kai"])
def test_ankle_sensors_tell_the_ground_s_wrench_on_a_standing_robot(name):
    simulation = Simulation(load_scene("flat", ["steps=0", "force_torque=true"], name), 0)
    world = simulation.world
    mujoco.mj_forward(world.model, world.data)
    quiet = Sensing(force_noise=0.0, ankle_force_noise=0.0, ankle_torque_noise=0.0)
    suite = SensorSuite(world, quiet, 0, force_torque=True)
    suite.read_skins()
    mounted = ankle_sensors(simulation.legs.model, simulation.robot)
    total = 0.0
    for side, measured in suite.read_body().ankles.items():
        site = world.sole_sites[side]
        rotation = world.data.site_xmat[site].reshape(3, 3)
        sensed = mounted[side].sole_wrench(measured, rotation).wrench_in_sole
        contacts = foot_contacts(world.model, world.data, frozenset(world.sole_geoms[side]))
        truth = contact_wrench_in_frame(contacts, world.data.site_xpos[site], rotation)
        assert sensed == pytest.approx(truth, abs=0.3)  # the foot settles: its inertia is all that differs
        total += sensed[2]
    assert total == pytest.approx(simulation.legs.mass * 9.81, rel=2e-3)


def test_ankle_noise_has_the_stated_size_and_leaves_the_other_sensors_alone(world):
    mujoco.mj_forward(world.model, world.data)
    sensing = Sensing(ankle_force_noise=2.0, ankle_torque_noise=0.1)
    with_ankles, without = SensorSuite(world, sensing, 3, force_torque=True), SensorSuite(world, sensing, 3)
    rows = []
    for _ in range(400):
        with_ankles.read_skins()
        without.read_skins()
        one, other = with_ankles.read_body(), without.read_body()
        assert np.array_equal(one.joint_positions, other.joint_positions)
        assert np.array_equal(one.readings["left"].force, other.readings["left"].force)
        assert other.ankles == {}
        rows.append(one.ankles["left"])
    assert np.std(rows, axis=0) == pytest.approx([2.0] * 3 + [0.1] * 3, rel=0.15)
