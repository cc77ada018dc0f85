"""A command at every tick that moves no target far, whatever comes in; and the very same commands where all is well."""

import time

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.gait.command import Sensors
from plantar.kernels.safety.plausible import BodyCheck, SoleCheck
from plantar.sim.bench.stress.faults import FAULTS
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

from .fault_run import run_with_fault

WALKED_THROUGH = (
    "time +5 s",
    "time -5 s",
    "time back by 1 s for 0.5 s",
    "time jitter of 10 ms",
    "time frozen",
    "time frozen for 0.1 s",
    "time NaN for 0.1 s",
    "time twice as fast",
    "no sensors for 0.03 s",
    "IMU frozen for 0.1 s",
    "IMU NaN for 0.03 s",
    "gyro with noise of 0.05 rad/s",
    "gyro at 35 rad/s for a tick",
    "one encoder at 1e6 rad",
    "one encoder NaN",
    "one encoder inf",
    "one encoder off by 0.3 rad",
    "one encoder off by 0.24 rad",
    "one encoder off by 0.1 rad",
    "one encoder off by -0.1 rad",
    "one encoder off by 0.05 rad",
    "an ankle's encoder off by 0.15 rad",
    "an ankle's encoder off by -0.15 rad",
    "a hip's encoder off by 0.1 rad",
    "one encoder off by 0.1 rad for 0.3 s",
    "one encoder off by 0.1 rad for a tick",
    "one encoder stuck for 0.05 s",
    "encoders NaN for 0.03 s",
    "encoders frozen for 0.1 s",
    "encoders with noise of 1 mrad",
    "soles swapped",
    "left sole missing",
    "left skin NaN",
    "left skin zeros",
    "right sole missing",
    "right skin NaN",
    "right skin zeros",
    "left skin of another size",
    "left skin reports 80 %",
    "right skin reports 120 %",
    "soles NaN for 0.03 s",
    "no soles for 0.03 s",
)
"""Faults after which the robot walks on."""

SLOW = ("a knee's encoder drifts by 0.2 rad/s", "an ankle's encoder drifts by -0.2 rad/s", "a hip's encoder stuck")
"""What shows by the turn of the sole that stands, once it is large, or when the leg comes to stand."""

LATER = "both skins zeros"
"""Named at once; the robot sits once the foot in the air has landed, and one sole's silence is bridged until then."""


@pytest.mark.parametrize(
    "name", [n if n in ("time +5 s", "no soles", SLOW[0]) else pytest.param(n, marks=pytest.mark.long) for n in FAULTS]
)
@pytest.mark.parametrize("robot", ["h1", pytest.param("hrp2kai", marks=pytest.mark.long)])
@pytest.mark.parametrize("walking", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_fault_moves_no_target_far_and_is_named_or_walked_through(name, robot, walking):
    seen = run_with_fault(robot, walking, name)
    assert seen.jump <= 3.0
    if seen.state is None:
        assert seen.upright
        assert name in (*WALKED_THROUGH, *SLOW, LATER) or not walking
    else:
        assert seen.state in ("late", "blind", "fallen")
        slowest = 0.9 if name == LATER and walking else 0.5 if name in SLOW else 0.2
        assert 0.0 <= seen.after <= slowest
    if name == LATER:
        assert seen.named <= 0.2
    assert seen.state is None or name not in WALKED_THROUGH


@pytest.mark.long
@pytest.mark.parametrize("name", ["time +5 s", "time inf", "left sole missing", "one encoder too few"])
def test_without_the_shell_a_fault_falls_jumps_or_raises(name):
    try:
        seen = run_with_fault("h1", True, name, shell=False)
    except (KeyError, IndexError, ValueError, InputError):
        return
    assert seen.jump > 20.0 or not seen.upright


def test_an_undisturbed_walk_is_the_same_to_the_last_bit():
    parts = Simulation(load_scene("flat", ["steps=2"]))
    world, sensors, controller = parts.world, parts.sensors, parts.controller
    other = Simulation(load_scene("flat", ["steps=2"])).controller
    other.shell = None
    every, readings = round(parts.settings.period / world.period), []
    for k in range(round(2.5 / world.period)):
        if k % sensors.skin_every == 0:
            sensors.read_skins(controller.proximity_sides, False)
        if k % every == 0:
            reading = sensors.read_body()
            readings.append(reading)
            command, bare = controller.step(reading), other.step(reading)
            assert np.array_equal(command.com, bare.com)
            for side, foot in command.feet.items():
                assert np.array_equal(foot.position, bare.feet[side].position)
                assert np.array_equal(foot.force, bare.feet[side].force)
            parts.servos.command(command)
        parts.servos.drive()
        mujoco.mj_step(world.model, world.data)
    assert controller.safe_state is None
    shell = controller.shell
    shell._tick = lambda sensors: command  # what remains is the shell's own time
    shell._last, times = command, []
    for reading in readings[-300:]:
        begun = time.thread_time()
        shell.step(reading)
        times.append(time.thread_time() - begun)
    # Processor time, of the quietest tenth of the run; 15 us are what all checks of a tick may take together where
    # nobody else uses the caches, and three times that elsewhere.
    assert np.median(np.reshape(times, (10, -1)), axis=1).min() < 45e-6


def test_what_comes_first_may_be_anything():
    parts = Simulation(load_scene("flat", ["steps=2"]))
    nothing = Sensors(time=np.nan, joint_positions=None, gyro=None, accelerometer=None, readings=None)
    command = parts.controller.step(nothing)
    assert command.com[2] == pytest.approx(parts.settings.com_height, abs=0.05)
    assert parts.controller.step(nothing).feet["left"].force[2] > 0.0


@pytest.mark.parametrize(
    ("loads", "swapped"),
    [
        ([(130, 660), (130, 655), (655, 132), (650, 135)], True),
        # A shock that passes the load from foot to foot within ticks, as measured:
        ([(156, 654), (155, 645), (282, 630), (476, 542), (720, 313), (199, 690), (133, 616)], False),
    ],
)
def test_exchanged_soles_differ_from_a_shock(loads, swapped):
    check = SoleCheck(86.0 * 9.81)
    for left, right in loads:
        check.update(np.array([left], dtype=float), 1, np.array([right], dtype=float), 1)
    assert check.swapped == swapped


def test_loads_that_changed_in_a_stall_are_no_exchanged_soles():
    check = SoleCheck(86.0 * 9.81)
    for left, right in [(130, 660), (130, 655), (655, 132)]:
        if left > 600:
            check.skip()
        check.update(np.array([left], dtype=float), 1, np.array([right], dtype=float), 1)
    assert not check.swapped


def checked_joints(changed, ticks=1):
    """What `BodyCheck` returns of 12 joints that move at up to 0.6 rad/s, and of 10 ticks after they `changed`."""
    check = BodyCheck(12, 24)
    imu = np.random.default_rng(0).normal(size=(40, 6))
    found = []
    for i in range(20):
        angles = 0.3 + 2.5e-4 * np.arange(12) * (i if i < 10 else i + ticks - 1)
        found.append(
            check.check(angles if i < 10 else changed(angles), imu[i, :3], imu[i, 3:], ticks if i == 10 else 1)
        )
    assert not any(found[:10])
    return check, found[10:]


def test_one_encoder_that_jumps_far_is_taken_back():
    check, found = checked_joints(lambda angles: angles + 0.4 * (np.arange(12) == 8))
    assert found == [1] + 9 * [0]  # the first one may be anything
    assert check.jumps == 1
    assert check.last_slip == 8
    assert check.slips == pytest.approx(0.4 * (np.arange(12) == 8), abs=1e-9)


@pytest.mark.parametrize(
    "changed",
    [
        lambda angles: angles * np.where(np.arange(12) == 8, -1.0, 1.0),  # a sign that has turned
        lambda angles: angles + 0.4 * (np.arange(12) >= 10),  # two at once
        lambda angles: angles + 100.0 * (np.arange(12) == 8),
    ],
)
def test_other_far_jumps_are_refused(changed):
    check, found = checked_joints(changed)
    assert found == 10 * [1]
    assert check.jumps == 0


def test_joints_move_on_in_a_stall():
    check, found = checked_joints(lambda angles: angles + 0.3, ticks=21)
    assert not any(found)
    assert check.jumps == 0


@pytest.mark.parametrize("part", [slice(0, 3), slice(3, 6)])
def test_a_gyro_or_an_accelerometer_that_is_stuck_alone_is_found(part):
    check = BodyCheck(12, 24)
    rng = np.random.default_rng(1)
    found = []
    for i in range(60):
        imu = rng.normal(size=6)
        if i >= 20:
            imu[part] = 0.25
        found.append(check.check(1e-3 * i + np.zeros(12), imu[:3].copy(), imu[3:].copy()))
    assert found == 44 * [0] + 16 * [3]
