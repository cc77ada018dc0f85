"""What soles and accelerometer have to measure of a body that sways, against the derivatives of a known motion."""

import numpy as np
import pytest

from plantar.gait.estimate.estimator import Posture
from plantar.gait.safety.bring_up.body_motion import body_motion, smoothed
from plantar.mechanics.rotation import rotation_from_vector

PERIOD = 0.005
GRAVITY = 9.80665  # nature
COM, IMU = np.array([0.02, -0.01, 0.1]), np.array([0.03, 0.02, 0.25])  # in the base's frame
TIME = PERIOD * np.arange(500)
SWAY, TILT, RATE = 0.015, 0.03, 4.0  # m, rad, rad/s


def swayed(shape):
    """Motion of a base that moves forward and pitches by `shape` (n,), over soles 0.2 m apart, turned outward."""

    def posture(joints):
        turn = rotation_from_vector(np.array([0.0, TILT * joints[0], 0.0]))
        base = np.array([SWAY * joints[0], 0.0, 0.8])
        turns = {s: rotation_from_vector(np.array([0.0, 0.0, a])) for s, a in (("left", 0.1), ("right", -0.1))}
        places = {"left": np.array([0.0, 0.1, 0.0]), "right": np.array([0.0, -0.1, 0.0])}
        return Posture(
            COM,
            {s: turn.T @ (place - base) for s, place in places.items()},
            {s: turn.T @ turns[s] for s in places},
        )

    return body_motion(shape[:, None], posture, IMU, PERIOD)


def path(point, shape):
    """Place (n,) forward of a point (3,) in the base's frame."""
    return SWAY * shape + point[0] * np.cos(TILT * shape) + point[2] * np.sin(TILT * shape)


@pytest.mark.parametrize("what", ["zmp", "force"])
def test_what_is_to_be_measured_follows_from_the_motion(what):
    shape = np.sin(RATE * TIME)
    motion = swayed(shape)
    fine = PERIOD / 50.0
    near = [np.sin(RATE * (TIME + step)) for step in (-fine, 0.0, fine)]
    point = COM if what == "zmp" else IMU
    before, at, after = (path(point, each) for each in near)
    acceleration = (after - 2.0 * at + before) / fine**2
    # The CoM's height is that of base and CoM.
    expected = at - 0.9 * acceleration / GRAVITY if what == "zmp" else acceleration - GRAVITY * TILT * shape
    found = getattr(motion, what)[:, 0]
    wanted = smoothed(expected, PERIOD)
    # Soles that are turned outward by 0.1 rad show what is forward by the cosine of that, 0.5 % less.
    assert found - found.mean() == pytest.approx(wanted - wanted.mean(), abs=0.01 * np.abs(wanted).max())


def test_turns_are_those_of_the_torso():
    motion = swayed(np.sin(RATE * TIME))
    assert motion.turn == pytest.approx(np.outer(TILT * np.sin(RATE * TIME), [0.0, 1.0, 0.0]), abs=2e-5)


def test_a_body_that_does_not_move_has_nothing_to_be_measured():
    motion = swayed(np.zeros_like(TIME))
    assert np.ptp(motion.zmp, axis=0) == pytest.approx(0.0, abs=1e-12)
    assert motion.force == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("period", [0.001, 0.002, 0.005, 0.01])
def test_a_second_difference_is_the_smoothed_acceleration(period):
    time = period * np.arange(round(1.5 / period))
    motion = body_motion(
        np.sin(RATE * time)[:, None],
        lambda joints: Posture(
            np.zeros(3),
            {s: np.array([-SWAY * joints[0], 0.0, -1.0]) for s in ("left", "right")},
            {s: np.eye(3) for s in ("left", "right")},
        ),
        np.zeros(3),
        period,
    )
    wanted = smoothed(-SWAY * RATE**2 * np.sin(RATE * time), period)
    # The second difference over a period is off the derivative by its fourth: (w dt)^2 / 12 of it.
    assert motion.force[:, 0] == pytest.approx(wanted, abs=1.01 * (RATE * period) ** 2 / 12.0 * SWAY * RATE**2)
