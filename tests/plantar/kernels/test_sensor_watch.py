"""What encoders, IMU and soles report of one motion is compared; motions that agree give no word."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar import kernels
from plantar.common.gravity import GRAVITY
from plantar.kernels.safety import sensor_watch
from plantar.kernels.safety.sensor_watch import ACCELERATION, ENCODER_NOISE, GYRO_NOISE, LATE, LOAD, SELDOM, TURN
from plantar.mechanics.rotation import rotation_from_vector

FORMS = [sensor_watch, kernels.python_form("sensor_watch")]
PERIOD = 0.005
MASS = 50.0
WEIGHT = MASS * GRAVITY
NOISES = (0.045, 1e-3, 0.25)
TAXELS = np.array([(x, y, 0.0) for x in np.linspace(-0.1, 0.1, 7) for y in np.linspace(-0.05, 0.05, 5)])
EVEN = np.full(len(TAXELS), 1.0)
EDGE = 1.0 * (TAXELS[:, 1] < -0.04)  # its right edge


def watch_of(form, joints=3):
    leasts = (0.5, 0.07, 0.12, 0.5)
    soles = (TAXELS, TAXELS)
    return form.SensorWatch(joints, MASS, GRAVITY, soles, PERIOD, 60, 12, 40, 2.0, leasts, 0.03, 4, 0.5, NOISES)


class Motion:
    """A base that sways by 5 cm at 1 Hz, tilted by 0.1 rad, with soles that carry its weight."""

    def __init__(self, form):
        self.watch = watch_of(form)
        self.ticks = 0
        self.rng = np.random.default_rng(3)

    def tick(self, *, off=0.0, load=1.0, turn=0.0, gyro=0.0, joints=0.0, stamp=None, clock=0.0, force=EVEN):
        t = PERIOD * self.ticks
        self.ticks += 1
        sway = 2.0 * np.pi * t
        position = np.array([0.05 * np.sin(sway), 0.02 * np.cos(sway), 0.8])
        rotation = rotation_from_vector(np.array([0.0, 0.1, 0.0]))
        acceleration = (2.0 * np.pi) ** 2 * np.array([-0.05 * np.sin(sway), -0.02 * np.cos(sway), 0.0])
        specific = rotation.T @ (acceleration + np.array([off, 0.0, 9.81]))
        sensors = SimpleNamespace(
            time=t,
            joint_positions=0.1 * np.sin(sway + np.arange(3.0)) + joints * self.rng.normal(size=3),
            gyro=0.1 * np.cos(sway + np.arange(3.0)) + gyro * self.rng.normal(size=3),
            accelerometer=specific,
            readings={
                "left": SimpleNamespace(time=t, force=EVEN),
                "right": SimpleNamespace(time=t if stamp is None else stamp, force=force),
            },
        )
        rotations = {"left": np.eye(3), "right": rotation_from_vector(np.array([turn, 0.0, 0.0]))}
        state = SimpleNamespace(position_base=position, rotation_base_to_world=rotation, rotations_sole=rotations)
        loads = 0.6 * WEIGHT * load, 0.4 * WEIGHT * load
        return self.watch.update(sensors, SimpleNamespace(state=state), *loads, t + clock)

    def after(self, ticks, **changes):
        """Codes of some ticks together; changes are functions of the tick, from 0."""
        found = 0
        for k in range(ticks):
            found |= self.tick(**{name: change(k) for name, change in changes.items()})
        return found


@pytest.mark.parametrize("form", FORMS)
def test_a_motion_that_agrees_gives_no_word(form):
    motion = Motion(form)
    for _ in range(3):
        assert motion.after(200) == 0
        motion.watch.end_support()


@pytest.mark.parametrize("form", FORMS)
def test_an_accelerometer_that_is_off_is_measured_in_the_window(form):
    motion = Motion(form)
    motion.after(200)
    assert motion.watch.acceleration < 0.06
    assert motion.after(10, off=lambda k: 1.5) == 0
    assert motion.after(40, off=lambda k: 1.5) == ACCELERATION
    motion.after(60, off=lambda k: 1.5)
    assert motion.watch.acceleration == pytest.approx(1.5, abs=0.06)


@pytest.mark.parametrize("form", FORMS)
def test_what_a_support_showed_is_usual_from_its_end_on(form):
    motion = Motion(form)
    motion.after(200)
    assert motion.after(100, off=lambda k: 0.4) == 0
    motion.watch.end_support()
    assert motion.after(150, off=lambda k: 1.2) == 0  # 2 x 0.4 + 0.5
    assert motion.after(150, off=lambda k: 1.5) == ACCELERATION


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(("share", "found"), [(0.9, 0), (0.82, LOAD), (1.1, 0), (1.2, LOAD), (0.3, LOAD)])
def test_soles_that_carry_another_weight_than_before(form, share, found):
    motion = Motion(form)
    motion.after(100)
    motion.watch.end_support()
    assert motion.after(60, load=lambda k: share) == found
    assert motion.watch.load == pytest.approx(share, abs=0.01)


@pytest.mark.parametrize("form", FORMS)
def test_a_standing_sole_that_turns(form):
    motion = Motion(form)
    motion.after(100, turn=lambda k: 0.002 * k)  # both stand: it may roll in any way
    motion.watch.begin_support(True)
    assert motion.after(60, turn=lambda k: 0.2 + 0.001 * k) == 0
    assert motion.after(40, turn=lambda k: 0.26 + 0.001 * k) == TURN
    assert motion.watch.turn == pytest.approx(np.sin(0.299) - np.sin(0.2), abs=1e-6)
    # The other sole, one that lifts off, and one that rolls over its edge may turn.
    for right, load, force in ((False, 1.0, EVEN), (True, 0.7, EVEN), (True, 1.0, EDGE), (True, 1.0, np.nan * EVEN)):
        motion = Motion(form)
        motion.after(100)
        motion.watch.begin_support(right)
        found = 0
        for k in range(100):
            found |= motion.tick(turn=0.001 * k, load=load, force=force)
        assert found & TURN == 0


@pytest.mark.parametrize("form", FORMS)
def test_a_sole_that_turned_as_a_flat_one_in_earlier_supports_may_turn_farther(form):
    motion = Motion(form)
    motion.watch.begin_support(True)
    assert motion.after(60, turn=lambda k: 0.001 * k) == 0
    motion.watch.end_support()
    motion.watch.begin_support(True)
    assert motion.after(185, turn=lambda k: 0.001 * k) == 0  # 2 x 0.059 + 0.07
    assert motion.after(10, turn=lambda k: 0.19 + 0.001 * k) == TURN


@pytest.mark.parametrize("form", FORMS)
def test_of_ticks_that_cannot_be_compared_the_turn_is_looked_at(form):
    motion = Motion(form)
    motion.watch.begin_support(False)
    found = 0
    for turn in (0.0, 0.08):
        rotations = {"left": rotation_from_vector(np.array([0.0, turn, 0.0]))}
        command = SimpleNamespace(state=SimpleNamespace(rotations_sole=rotations))
        sensors = SimpleNamespace(readings={"left": SimpleNamespace(force=EVEN)})
        found = motion.watch.turned(sensors, command, 0.6 * WEIGHT, 0.0)
        assert found == (TURN if turn else 0)


@pytest.mark.parametrize("form", FORMS)
def test_white_noise(form):
    motion = Motion(form)
    motion.after(50)
    assert motion.after(40, gyro=lambda k: 0.002, joints=lambda k: 5e-5) == 0
    assert motion.after(40, gyro=lambda k: 0.05) == GYRO_NOISE
    motion.after(60)
    assert motion.after(40, joints=lambda k: 1e-3) == ENCODER_NOISE


@pytest.mark.parametrize("form", FORMS)
def test_after_missed_ticks_the_windows_begin_again(form):
    motion = Motion(form)
    motion.after(200)
    motion.watch.skip()
    motion.ticks += 37
    assert motion.after(200) == 0
    assert motion.watch.acceleration < 0.06


def test_compiled_and_interpreted_watch_agree():
    motions = [Motion(form) for form in FORMS]
    rng = np.random.default_rng(8)
    for k in range(500):
        changes = {"off": rng.normal(), "load": rng.uniform(0.3, 1.5), "turn": 0.1 * rng.normal(), "gyro": 0.03}
        found = [motion.tick(**changes) for motion in motions]
        assert found[0] == found[1]
        for name in ("acceleration", "turn", "load"):
            assert getattr(motions[0].watch, name) == pytest.approx(getattr(motions[1].watch, name), abs=1e-9)
        if k % 130 == 129:
            for motion in motions:
                motion.watch.end_support()
                motion.watch.begin_support(k % 2 == 0)
        if k == 333:
            for motion in motions:
                motion.watch.skip()


@pytest.mark.parametrize("form", FORMS)
def test_readings_that_come_later_or_seldom(form):
    motion = Motion(form)
    for k in range(60):
        found = motion.tick(stamp=PERIOD * k if k < 30 else PERIOD * (k - 8))
        assert bool(found & LATE << 1) == (k >= 33)
        assert not found & LATE
    assert motion.watch.later[1] == pytest.approx(0.04)
    motion = Motion(form)
    for k in range(60):
        found = motion.tick(stamp=PERIOD * min(k, 30))
        assert bool(found & SELDOM << 1) == (k > 38) or k == 38  # 0.03 s and two readings, to the last bit


@pytest.mark.parametrize("form", FORMS)
def test_a_clock_that_stands_or_is_behind_makes_no_sole_late(form):
    motion = Motion(form)
    for k in range(90):  # by the reported time it is late after the clock goes on, not by the plan's
        assert motion.tick(clock=-0.05 if 20 <= k < 40 else 0.0) == 0
    motion.watch.restart_clock()
    for _ in range(40):
        assert motion.tick(clock=5.0) == 0
