"""Sensors and drives of the true plant: what they add, and that what comes late is what was, unchanged."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.sides import SIDES
from plantar.robots import load_robot
from plantar.sim.model.world import build_world
from plantar.sim.plant.delay import Delay
from plantar.sim.plant.draw import TruePlant, drawn_plant
from plantar.sim.plant.drives import RIPPLES, TorqueCurve, TrueDrives
from plantar.sim.plant.settings import Plant
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.sensing.sensors import SensorSuite
from plantar.sim.sensing.settings import Sensing
from plantar.sim.terrain import Ground

QUIET = Sensing(force_noise=0.0, encoder_noise=0.0, gyro_noise=0.0, accelerometer_noise=0.0)
LAYOUTS = load_robot("h1").layouts


def plant_of(**settings: object) -> TruePlant:
    found = drawn_plant(Plant(**settings), 2, REFERENCE_BODY, 12, LAYOUTS)
    assert found is not None
    return found


STILL = np.zeros(12)
STIFFNESS, DAMPING = np.full(12, 2000.0), np.full(12, 40.0)


def drives_of(**settings: object) -> TrueDrives:
    return TrueDrives(plant_of(**settings), STIFFNESS, DAMPING)


def torques(drives: TrueDrives, setpoint: np.ndarray, joints: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """What a servo of nominal gains exerts."""
    return drives.offset(0.0, STIFFNESS * setpoint, joints, speeds) - STIFFNESS * joints - DAMPING * speeds


def test_a_joint_moves_freely_by_its_play_and_winds_up_from_there():
    drives = drives_of(backlash=0.2)
    play = np.radians(0.2)
    errors = np.linspace(-2.0 * play, 2.0 * play, 401)
    torque = np.array([torques(drives, STILL, np.full(12, -e), STILL)[0] for e in errors])
    free = errors[np.abs(torque) < 1e-9]
    assert np.ptp(free) == pytest.approx(play, rel=0.02)
    assert torque[-1] == pytest.approx(2000.0 * 1.5 * play)
    assert np.diff(torque).min() > -1e-9
    # A load that turns round moves the joint by the play more than an ideal servo's.
    there, back = (float(np.interp(load, torque, -errors)) for load in (2.0, -2.0))
    assert back - there == pytest.approx(2.0 * 2.0 / 2000.0 + play, rel=1e-3)


def test_the_torque_swings_by_its_ripple_about_what_was_asked():
    drives = drives_of(torque_ripple=0.05)
    angles = np.linspace(0.0, 2.0 * np.pi / RIPPLES, 400, endpoint=False)
    speeds = np.full(12, 0.5)
    torque = np.array([torques(drives, np.full(12, a + 0.02), np.full(12, a), speeds)[3] for a in angles])
    asked = 2000.0 * 0.02 - 40.0 * 0.5
    assert torque.mean() == pytest.approx(asked)
    assert (torque.max() - asked, asked - torque.min()) == pytest.approx((0.05 * asked, 0.05 * asked), rel=1e-3)


def test_a_motors_torque_falls_with_its_speed_and_its_brake_keeps_it():
    ranges = np.array([[-8.0, 8.0]])
    model = SimpleNamespace(actuator_forcerange=ranges, actuator_forcelimited=np.ones(1, dtype=bool))
    curve = TorqueCurve(model, np.array([0]), np.array([10.0]), 0.5)
    assert curve.acts
    for speed, low, high in ((0, -8, 8), (5, -8, 8), (7.5, -8, 4), (-7.5, -4, 8), (12, -8, 0)):
        curve.limit(np.array([float(speed)]))
        assert ranges[0].tolist() == pytest.approx([low, high])


def test_a_joint_with_dry_friction_does_not_move_under_less_torque_than_that(h1):
    moved = []
    for friction, torque in ((0.0, 2.0), (3.0, 2.0), (3.0, 9.0), (3.0, 12.0)):
        plant = None if friction == 0.0 else plant_of(joint_friction=friction)
        world = build_world(h1, Ground((), 0.0, 0.8), plant=plant)
        model, data = world.model, world.data
        model.opt.gravity[:] = 0.0
        data.qpos[2] = 3.0  # it hangs in the air
        model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1:3] = 1.0, 0.0  # what is told is the torque
        knee = 3
        data.ctrl[world.servos[knee]] = torque
        start = data.qpos[world.joint_qpos[knee]]
        mujoco.mj_step(model, data, 50)
        moved.append(float(data.qpos[world.joint_qpos[knee]] - start))
        assert not world.joint_friction.any()  # what the controller's side goes by
    free, held, pulled, hard = moved
    assert held < 0.05 * free
    # Friction is an offset: what is pulled more moves the joint as much more as it moves one without friction.
    assert (hard - pulled) / 3.0 == pytest.approx(free / 2.0, rel=0.05)


def test_gyro_and_encoders_read_too_much_by_what_is_stated(world):
    plant = plant_of(gyro_bias=(0.01, -0.02, 0.03), encoder_offset=0.3)
    world.data.qvel[3:6] = (0.1, 0.2, 0.3)
    mujoco.mj_forward(world.model, world.data)
    suites = [SensorSuite(world, QUIET, 0, plant=true) for true in (None, plant)]
    for suite in suites:
        suite.read_skins()
    nominal, true = (suite.read_body() for suite in suites)
    assert true.gyro - nominal.gyro == pytest.approx([0.01, -0.02, 0.03], abs=1e-12)
    assert true.joint_positions - nominal.joint_positions == pytest.approx(plant.encoder_offsets, abs=1e-12)
    assert np.array_equal(true.accelerometer, nominal.accelerometer)


def test_what_is_read_late_is_what_was_read_then(world):
    suites = [SensorSuite(world, QUIET, 0, plant=true) for true in (None, plant_of(sensor_delay=0.01))]
    now, late = [], []
    for k in range(60):
        mujoco.mj_step(world.model, world.data)
        if k % 4 == 0:
            for suite in suites:
                suite.read_skins()
        if k % 5 == 0:
            now.append(suites[0].read_body())
            late.append(suites[1].read_body())
    assert [s.time for s in late] == [s.time for s in now]
    for earlier, arrived in zip([now[0], now[0], *now], late, strict=False):
        assert np.array_equal(arrived.joint_positions, earlier.joint_positions)
        assert np.array_equal(arrived.gyro, earlier.gyro)
        assert np.array_equal(arrived.accelerometer, earlier.accelerometer)
        assert all(arrived.readings[side].time == earlier.readings[side].time for side in SIDES)
        assert (earlier.sampled, arrived.sampled) == (None, earlier.time)
    assert not np.array_equal(now[0].joint_positions, now[-1].joint_positions)


def test_drives_follow_the_shifted_set_points():
    drives = drives_of(actuation_delay=0.007)
    sent = np.random.default_rng(0).normal(size=(40, 12))
    followed = [drives.offset(0.001 * k, row, STILL, STILL) for k, row in enumerate(sent)]
    assert np.array_equal(followed, [sent[max(0, k - 7)] for k in range(40)])


def test_a_delay_between_samples_waits_for_the_next_one():
    line: Delay[int] = Delay(0.012)
    assert [line.passed(0.005 * k, k) for k in range(6)] == [0, 0, 0, 0, 1, 2]
    none: Delay[int] = Delay(0.0)
    assert [none.passed(0.1 * k, k) for k in range(3)] == [0, 1, 2]


def test_a_joint_stands_off_by_its_encoder_s_error_and_reads_as_if_it_did_not():
    nominal, true = (
        Simulation(load_scene("flat", ["steps=0", "encoder_noise=0", f"encoder_offset={most}"]), 3) for most in (0, 0.1)
    )
    read = []
    for simulation in (nominal, true):
        simulation.sensors.read_skins()
        read.append(simulation.sensors.read_body().joint_positions)
    off = true.plant.encoder_offsets
    # Both feet stand on the ground, so the joints cannot all go their own way: most of each error shows.
    moved = true.world.data.qpos[true.world.joint_qpos] - nominal.world.data.qpos[nominal.world.joint_qpos]
    assert moved @ -off / (off @ off) > 0.6
    assert np.abs(read[1] - read[0]).max() < np.abs(moved).max()
