"""What sensors report of one walk is compared: a sound walk has no note, one fault has its own."""

import mujoco
import numpy as np
import pytest

from plantar.mechanics.rotation import rotation_from_vector
from plantar.sensing.reading import Reading
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

BEGIN = 4.4  # s, in the third single support


class Walk:
    """A walk of h1, whose loop gives its joint targets."""

    def __init__(self, *settings):
        self.run = Simulation(load_scene("flat", ["steps=6", *settings], "h1"), 69)
        self.steps = 0

    def until(self, end, change=lambda sensors, since: sensors):
        """Walk on to a time in s, with sensors changed; returns the notes of that time."""
        run = self.run
        shell = run.controller.shell
        begin = self.steps * run.world.period
        before = len(shell.log.faults)
        every = round(run.settings.period / run.world.period)
        while self.steps * run.world.period < end:
            if self.steps % run.sensors.skin_every == 0:
                run.sensors.read_skins(run.controller.proximity_sides, False)
            if self.steps % every == 0:
                sensors = run.sensors.read_body()
                command = run.controller.step(change(sensors, self.steps * run.world.period - begin))
                shell.commanded = run.servos.command(command)
            run.servos.drive()
            mujoco.mj_step(run.world.model, run.world.data)
            self.steps += 1
        return shell.log.faults[before:]


def late(seconds):
    kept = []

    def change(sensors, since):
        kept.append(sensors.readings)
        return sensors.changed(readings=kept[max(0, len(kept) - 1 - round(seconds / 0.005))])

    return change


def turned(sensors, since):
    turn = rotation_from_vector(np.array([0.0, np.radians(10.0), 0.0]))
    return sensors.changed(gyro=turn @ sensors.gyro, accelerometer=turn @ sensors.accelerometer)


def stuck():
    kept = []

    def change(sensors, since):
        kept.append(sensors.joint_positions[3])
        angles = sensors.joint_positions.copy()
        angles[3] = kept[0]
        return sensors.changed(joint_positions=angles)

    return change


def drifting(joint, rate):
    """An encoder of the standing leg that goes away by a rate in rad/s."""

    def change(sensors, since):
        angles = sensors.joint_positions.copy()
        angles[joint] += rate * since
        return sensors.changed(joint_positions=angles)

    return change


def noise(name, size):
    rng = np.random.default_rng(1)

    def change(sensors, since):
        given = getattr(sensors, name)
        return sensors.changed(**{name: given + rng.normal(0.0, size, len(given))})

    return change


def halved(sensors, since):
    given = sensors.readings
    return sensors.changed(readings={side: Reading(r.time, 0.5 * r.force, r.proximity) for side, r in given.items()})


FAULTS = {
    "an IMU that turned": (turned, "accelerometer"),
    "a stuck encoder": (stuck(), "joints that do not follow their targets, counted from 0: 3"),
    "late soles": (late(0.05), "readings of the"),
    "a noisy gyro": (noise("gyro", 0.05), "gyro jumps"),
    "noisy encoders": (noise("joint_positions", 1e-3), "encoders jump"),
    "soles of half the weight": (halved, "soles report 0."),
    "no encoders": (lambda s, t: s.changed(joint_positions=None) if t < 0.01 else s, "angles, IMU or soles missing"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_noted_in_a_third_of_a_second_and_the_robot_stays_up(name):
    walk = Walk()
    assert walk.until(BEGIN) == []
    change, words = FAULTS[name]
    notes = walk.until(BEGIN + 1.0, change)
    times = [note.time - BEGIN for note in notes if note.text.startswith(words)]
    assert times, notes
    assert times[0] < 0.33
    assert walk.run.controller.raised[0] == 0
    turn = walk.run.world.data.xmat[walk.run.world.torso].reshape(3, 3)
    assert turn[2, 2] > 0.95


@pytest.mark.parametrize("settings", [(), ("plant=random", "plant.level=3")])
def test_a_sound_walk_has_no_note(settings):
    assert Walk(*settings).until(7.0) == []


@pytest.mark.parametrize("joint", [7, 9])
def test_an_encoder_of_the_standing_leg_that_drifts_is_replaced(joint):
    """By its hip or its knee the standing sole turns, which shows that the encoder is wrong."""
    walk = Walk()
    walk.until(BEGIN + 0.3)
    assert walk.run.controller.schedule.at(BEGIN + 0.3).stance == "right"
    walk.until(BEGIN + 0.7, drifting(joint, 0.4))
    assert walk.run.controller.schedule.at(BEGIN + 0.7).stance == "right"
    assert walk.run.controller.shell._supervision._taken == {joint}


def test_a_drive_at_its_torque_limit_is_no_wrong_encoder():
    """The hip of a leg that holds an upright robot for long misses its target by more than a walk does."""
    run = Simulation(load_scene("feasibility-3", ["paper=T", "walk.lean=false", "settle=0.3"], "h1"), 63)
    supervision = run.controller.shell._supervision
    step = run.controller.step
    noticed = set()
    taken = set()

    def watched(sensors):
        command = step(sensors)
        if supervision.tracking is not None:
            noticed.update(np.flatnonzero(supervision.tracking.noticed).tolist())
        taken.update(supervision._taken)
        return command

    run.controller.step = watched
    summary = run.run()
    assert noticed
    assert not taken
    assert not summary["emergency_stop"]
    assert not summary["fell"]


def test_soles_that_are_too_late_to_walk_by_make_it_sit_down():
    walk = Walk()
    walk.until(BEGIN)
    walk.until(BEGIN + 0.4, late(0.1))
    assert walk.run.controller.safe_state == "blind"
    assert "late" in walk.run.controller.shell.reason


def test_a_loop_that_stalls_or_a_clock_that_stands_makes_no_sole_late():
    walk = Walk()
    walk.until(BEGIN)
    frozen = []

    def change(sensors, since):
        frozen.append(sensors.time)
        return sensors.changed(time=frozen[0]) if since < 0.1 else sensors

    notes = walk.until(BEGIN + 0.6, change)
    assert not any("sole" in note.text for note in notes)
    assert walk.run.controller.safe_state is None


def test_an_encoder_that_was_stuck_and_catches_up_has_not_jumped():
    walk = Walk()
    walk.until(BEGIN)
    change = stuck()
    notes = walk.until(BEGIN + 1.0, lambda s, t: change(s, t) if t < 0.05 else s)
    assert not any("jumped" in note.text for note in notes)
    assert walk.run.controller.safe_state is None
