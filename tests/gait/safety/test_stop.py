"""Emergency stop, heartbeat, supervision of joints, and the log of faults."""

import time

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.recordings.recording import read_mcap
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


def walked(run, begin, end, at=None, change=None):
    """Run a scene from a time in s to another; `at` ticks are called with the time and give the reading to use."""
    world, controller = run.world, run.controller
    every = round(run.settings.period / world.period)
    command = None
    for k in range(round(begin / world.period), round(end / world.period)):
        if k % run.sensors.skin_every == 0:
            run.sensors.read_skins(controller.proximity_sides, False)
        if k % every == 0:
            reading = run.sensors.read_body()
            if at is not None:
                at(k * world.period)
            command = controller.step(reading if change is None else change(reading))
            run.servos.command(command)
        run.servos.drive()
        mujoco.mj_step(world.model, world.data)
    return command


@pytest.fixture
def walk():
    return Simulation(load_scene("flat", ["steps=4"]))


def upright(run):
    return float(run.world.data.xmat[run.world.torso].reshape(3, 3)[2, 2])


def test_a_walking_robot_that_is_stopped_puts_both_feet_down_and_sits(walk):
    walked(walk, 0.0, 2.6)
    assert walk.controller.schedule.at(2.6).swing is not None
    walk.controller.shell.stop("button")
    command = walked(walk, 2.6, 5.6)
    assert walk.controller.safe_state == "stopped"
    assert walk.controller.shell.reason == "button"
    assert upright(walk) > 0.95
    assert command.stiffness == 1.0
    assert command.feet["left"].position[2] == pytest.approx(command.feet["right"].position[2], abs=1e-6)


def test_a_robot_that_is_released_goes_limp_in_half_a_second(walk):
    walked(walk, 0.0, 0.5)
    walk.controller.shell.stop("button")
    walk.controller.shell.stop("button", limp=True)
    assert walked(walk, 0.5, 1.1).stiffness == 0.0
    assert walk.controller.safe_state == "released"


def test_a_heartbeat_that_stops_stops_the_robot(walk):
    shell = walk.controller.shell
    with pytest.raises(InputError, match="longest time without a heartbeat"):
        shell.expect_heartbeat(0.0)
    shell.expect_heartbeat(60.0)
    walked(walk, 0.0, 0.1)
    assert shell.state is None
    shell.expect_heartbeat(0.05)
    time.sleep(0.1)
    walked(walk, 0.1, 0.15)
    assert shell.state == "stopped"
    assert shell.reason == "no heartbeat for 0.05 s"


def test_the_log_holds_two_seconds_before_each_fault(walk, tmp_path):
    shell = walk.controller.shell
    late = 0.2
    walked(walk, 0.0, 2.5)
    walked(walk, 2.5, 2.6, change=lambda s: s.changed(time=s.time + late))
    walked(walk, 2.6, 2.9, change=lambda s: s.changed(time=s.time + late, gyro=np.full(3, np.nan)))
    words = [fault.text[:18] for fault in shell.log.faults]
    assert words == ["a tick came 0.20 s", "encoders or IMU wi", "blind"]
    assert shell.log.faults[0].time == pytest.approx(2.5, abs=0.02)
    path = tmp_path / "faults.mcap"
    shell.log.write(path)
    topics = read_mcap(path).topics
    assert {"/skin/left", "/skin/right", "/joints", "/imu", "/command"} <= set(topics)
    times = topics["/joints"].time
    assert times[0] == pytest.approx(0.5, abs=0.03)
    assert times[-1] > 2.5
    assert (np.diff(times) > 0.0).all()


def test_an_encoder_that_does_not_follow_is_replaced_by_its_target(walk):
    shell = walk.controller.shell
    drives = walk.servos.command

    def given(command):
        shell.commanded = drives(command)

    walk.servos.command = given
    assert walked(walk, 0.0, 4.0) is not None
    assert shell.log.faults == []

    def off(sensors):  # it drifts, as one that jumps has its jump taken off
        angles = sensors.joint_positions.copy()
        angles[3] += 0.3 * (sensors.time - 4.0)
        return sensors.changed(joint_positions=angles)

    walked(walk, 4.0, 7.0, change=off)
    assert walk.controller.safe_state is None
    assert upright(walk) > 0.95
    words = [fault.text for fault in shell.log.faults]
    assert words[0] == "joints that do not follow their targets, counted from 0: 3"
    assert shell.log.faults[0].time < 4.3
