"""Every fall ends limp, by the sensors that still work."""

import numpy as np
import pytest

from plantar.gait.command import Sensors
from plantar.gait.safety.fall_check import FallCheck
from plantar.sensing.reading import Reading

from .shoved_run import run_shoved

PERIOD = 0.005
WEIGHT = 800.0
UP = np.array([0.0, 0.0, 9.81])
STILL = np.array([1e-4, -2e-4, 1e-4])


def sensors(rng, *, gyro=STILL, pull=UP, load=WEIGHT):
    """A tick of a robot at rest, with noise."""
    force = np.full(10, load / 20.0) * (1.0 + 0.01 * rng.standard_normal(10))
    readings = {side: Reading(0.0, force) for side in ("left", "right")}
    noise = 1e-3 * rng.standard_normal(3)
    return Sensors(0.0, np.zeros(12), gyro + noise, pull + noise, readings)


def after(seconds, **changes):
    """Whether a robot lies that stood for a second and then reads `changes`, and whether that is known."""
    rng = np.random.default_rng(0)
    check = FallCheck(PERIOD, WEIGHT, 0.8)
    assert not any(check.is_down(sensors(rng)) for _ in range(200))
    ticks = [check.is_down(sensors(rng, **changes)) for _ in range(round(seconds / PERIOD))]
    return any(ticks), check.knows


def test_a_robot_that_turns_over_is_down_and_one_that_stands_is_not():
    turned, _ = after(1.0, gyro=np.array([2.0, 0.0, 0.0]), pull=np.array([0.0, 9.81, 0.0]))
    assert turned
    assert after(2.0) == (False, True)


@pytest.mark.parametrize("gyro", [np.full(3, np.nan), np.array([0.0, 35.0, 0.0]), np.zeros(2)])
def test_the_accelerometer_alone_shows_a_fall_where_the_gyro_fails(gyro):
    rng = np.random.default_rng(0)
    check = FallCheck(PERIOD, WEIGHT, 0.8)
    lies = Sensors(0.0, np.zeros(12), gyro, np.array([9.81, 0.0, 0.0]), sensors(rng).readings)
    down = [check.is_down(sensors(rng)) for _ in range(100)]
    for k in range(200):
        lies = lies.changed(accelerometer=np.array([9.81, 0.0, 1e-6 * k]))
        down.append(check.is_down(lies))
    assert not any(down[:100])
    assert down[-1]


def test_without_imu_soles_that_leave_the_ground_show_a_fall():
    broken = np.full(3, np.nan)
    assert after(2.0, gyro=broken, pull=broken) == (False, True)
    rng = np.random.default_rng(0)
    check = FallCheck(PERIOD, WEIGHT, 0.8)
    for _ in range(100):
        assert not check.is_down(sensors(rng, gyro=broken, pull=broken))
    down = [check.is_down(sensors(rng, gyro=broken, pull=broken, load=0.0)) for _ in range(100)]
    assert not any(down[:50])  # a robot in the air for a moment has not fallen
    assert down[-1]


def test_without_imu_and_soles_nothing_is_known():
    broken = np.full(3, np.nan)
    assert after(1.0, gyro=broken, pull=broken, load=0.0) == (False, False)
    assert FallCheck(PERIOD, WEIGHT, 0.8).is_down(None) is False


@pytest.mark.parametrize(
    ("fault", "state"),
    [
        ("IMU NaN", "blind"),
        ("both skins zeros", "blind"),
        ("time NaN", "late"),
        *(
            pytest.param(name, "blind", marks=pytest.mark.long)
            for name in ("encoders NaN", "encoders zeros", "gyro at 35 rad/s", "no IMU", "soles NaN")
        ),
    ],
)
@pytest.mark.parametrize("robot", ["h1", pytest.param("hrp2kai", marks=pytest.mark.long)])
def test_a_fall_from_any_state_ends_limp(robot, fault, state):
    seen = run_shoved(robot, fault)
    assert seen.upright < 0.5
    assert seen.states[0] == state
    assert seen.states[-1] == "fallen"
    assert seen.stiffness == 0.0


def test_a_robot_without_any_sensor_goes_limp_once_it_sits():
    seen = run_shoved("h1", "no sensors", 4.8)
    assert seen.states == ("blind", "limp")
    assert seen.stiffness == 0.0
