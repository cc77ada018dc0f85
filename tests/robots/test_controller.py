"""A robot's controller without a simulator: its stance, the joint targets of a robot at rest, and what it refuses."""

import subprocess
import sys

import numpy as np
import pytest

import plantar
from plantar.common.sides import SIDES
from plantar.errors import InputError, RobotError, SceneError
from plantar.gait.command import Sensors
from plantar.robots.controller import RobotController, load_controller


@pytest.fixture(scope="module")
def walker():
    return load_controller("h1", {"walk": {"steps": 2}})


def resting(walker: RobotController, time: float) -> Sensors:
    """Sensors of the robot at rest in its stance, half of its weight on each sole."""
    readings = {}
    for side in SIDES:
        layout = walker.robot.layouts[side]
        readings[side] = plantar.Reading(time, np.full(len(layout), 0.5 * 9.81 * walker.legs.mass / len(layout)))
    return Sensors(time, walker.stance.angles, np.zeros(3), np.array([0.0, 0.0, 9.81]), readings)


def test_no_simulator_is_loaded():
    code = "import sys, plantar; plantar.load_controller('h1'); print([m for m in sys.modules if 'plantar.sim' in m])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_the_stance_is_the_planned_one(robot):
    walker = load_controller(robot, {"walk": {"steps": 2, "crouch": 0.0}})
    posture = walker.legs.posture(walker.stance.angles)
    for side in SIDES:
        place = walker.base_position + posture.positions[side]
        half = (0.5 if side == "left" else -0.5) * walker.robot.stance_width
        assert place == pytest.approx([0.0, half, 0.0], abs=1e-6)
    assert (walker.base_position + posture.com)[2] == pytest.approx(walker.robot.com_height, abs=1e-6)


def test_joint_targets_of_a_robot_at_rest_are_its_stance(walker):
    command = walker.step(resting(walker, 0.0))
    targets = walker.joint_targets(command)
    assert targets.angles == pytest.approx(walker.stance.angles, abs=2e-3)
    weight = 9.81 * walker.legs.mass
    assert sum(foot.force[2] for foot in command.feet.values()) == pytest.approx(weight, rel=0.02)
    assert np.abs(targets.torques - walker.stance.torques).max() < 0.02 * weight


def test_a_clock_that_did_not_begin_with_the_walk_changes_nothing():
    targets = []
    for began in (0.0, 86_400.0):
        walker = load_controller("h1", {"walk": {"steps": 2, "settle": 0.2}})
        walker.count_as_checked()
        for tick in range(120):
            sensors = resting(walker, began + tick * walker.period)
            targets.append(walker.joint_targets(walker.step(sensors)).angles)
    assert np.allclose(targets[:120], targets[120:], atol=1e-6)
    assert not np.allclose(targets[0], targets[119], atol=1e-3)


@pytest.mark.parametrize("wrong", [np.degrees, lambda angles: angles * np.nan, lambda angles: angles[:-1]])
def test_sensors_that_never_make_sense_are_waited_for_and_named(wrong):
    walker = load_controller("h1", {"walk": {"steps": 2}})
    walker.count_as_checked()
    for tick in range(30):
        sensors = resting(walker, tick * walker.period)
        walker.controller.step(sensors.changed(joint_positions=wrong(sensors.joint_positions)))
    assert walker.controller.safe_state == "waiting"


@pytest.mark.parametrize(
    ("name", "wrong", "words"),
    [
        ("time", lambda time: np.nan, "time is NaN"),
        ("joint_positions", np.degrees, r"for left_hip_roll; allowed: -0.7\d+ to 1.0\d+ rad, not degrees"),
        ("joint_positions", lambda angles: angles * np.nan, "holds a value that is not finite"),
        ("joint_positions", lambda angles: angles[:-1], r"shape \(11,\); expected \(12,\)"),
        ("joint_positions", lambda angles: angles.astype(np.float32), "no contiguous array of float64"),
        ("joint_positions", lambda angles: np.repeat(angles, 2)[::2], "no contiguous array of float64"),
        ("gyro", lambda turn: turn[:2], r"gyro: shape \(2,\)"),
        ("accelerometer", lambda pull: pull / 9.81, r"reads 1; allowed at the start: about 9.81 m/s\^2"),
        ("readings", lambda soles: {"left": soles["left"]}, "forces of the right sole: not numeric .None."),
        ("readings", lambda soles: soles | {"left": plantar.Reading(0.0, np.ones(7))}, r"left sole: shape \(7,\)"),
        ("readings", lambda soles: soles | {"right": plantar.Reading(0.0, np.full(42, np.nan))}, "right sole hold no"),
    ],
)
def test_first_sensors_that_cannot_be_right_are_named(name, wrong, words):
    walker = load_controller("h1", {"walk": {"steps": 2}})
    sensors = resting(walker, 0.0)
    for _ in range(2):
        with pytest.raises(InputError, match=words):
            walker.step(sensors.changed(**{name: wrong(getattr(sensors, name))}))
    walker.step(sensors)
    walker.step(sensors.changed(**{name: wrong(getattr(sensors, name))}))  # from now on the shell bridges it
    assert walker.state == "bring-up"


def test_no_step_is_taken_before_bring_up_has_passed():
    walker = load_controller("h1", {"walk": {"steps": 2}})
    commands = [walker.step(resting(walker, tick * walker.period)) for tick in range(1700)]
    assert walker.state == "refused"  # by sensors that never move
    assert "gyro silent" in [finding.cause for finding in walker.findings]
    places = np.array([[command.feet[side].position for side in SIDES] for command in commands])
    assert np.ptp(places, axis=0).max() == 0.0
    assert np.ptp([command.com for command in commands], axis=0).max() < 0.02
    assert walker.end == pytest.approx(walker.controller.end + 5.95)


@pytest.mark.parametrize("period", [0.002, 0.003])
def test_bring_up_judges_at_any_period(period):
    walker = load_controller("h1", {"control": {"period": period}})
    for tick in range(round(3.3 / period)):
        walker.step(resting(walker, tick * period))
    assert walker.state == "refused"  # by sensors that never move
    assert walker.findings


@pytest.mark.parametrize("drives", ["own", "torque"])
def test_motors_hold_the_stance_while_bring_up_checks(drives):
    walker = load_controller("h1", {"control": {"drives": drives, "joint_stiffness": 100}})
    for tick in range(3):
        motors = walker.motor_command(walker.step(resting(walker, tick * walker.period)))
        assert motors.q == pytest.approx(walker.stance.angles, abs=1e-3)
        height = walker.controller.settings.com_height
        share = 0.005 * 9.81 * walker.legs.mass * height  # of what holds a pendulum, m g h
        assert motors.torque == pytest.approx(walker.stance.torques, abs=share)
        assert motors.kp.min() >= 0.25 * min(walker.robot.stiffness)
    walker.count_as_checked()
    assert walker.motor_command(walker.step(resting(walker, 0.02))).kp.max() == 100.0


def test_targets_are_the_callers_own(walker):
    command = walker.step(resting(walker, 0.005))
    first = walker.joint_targets(command)
    kept = first.angles.copy()
    walker.joint_targets(walker.step(resting(walker, 0.01)))
    assert np.array_equal(first.angles, kept)


def test_a_motor_command_is_the_joint_targets_with_gains_and_rates(walker):
    command = walker.step(resting(walker, 0.015))
    motors = walker.motor_command(command)
    assert [field.shape for field in motors] == [(12,)] * 5
    assert np.array_equal(motors.q, walker.legs.joints)
    assert np.array_equal(motors.torque, walker.legs.torques)
    assert np.array_equal(motors.dq, walker.motion.velocity[6:])
    assert motors.kp.tolist() == [*walker.robot.stiffness] * 2
    limp = walker.motor_command(walker.step(resting(walker, 0.02)).changed(stiffness=0.0))
    assert not limp.kp.any()
    assert not limp.torque.any()
    assert limp.kd.tolist() == [*walker.robot.damping] * 2


def test_gains_of_single_joints_replace_those_of_the_motors():
    control = {"control": {"drives": "own"}}
    own = load_controller("h1", control).gains
    gains = load_controller("h1", control, gains={"left_knee": 150.0, "right_knee": (150, 4.0)}).gains
    left = 3
    right = 9
    assert [gains.stiffness[left], gains.stiffness[right], gains.damping[right]] == [150.0, 150.0, 4.0]
    share = gains.damping[left] / own.damping[left]
    assert share == pytest.approx(np.sqrt(150.0 / own.stiffness[left]))  # the same share of critical
    rest = [k for k in range(12) if k not in (left, right)]
    assert np.array_equal(gains.stiffness[rest], own.stiffness[rest])
    assert np.array_equal(gains.damping[rest], own.damping[rest])


@pytest.mark.parametrize(
    ("drives", "gains", "words"),
    [
        ("own", {"knee": 150.0}, "joint 'knee'; allowed: left_hip_yaw, "),
        ("own", {"left_knee": -1.0}, r"'left_knee' are -1.0; allowed: stiffness in N m/rad"),
        ("own", {"left_knee": (1.0, 2.0, 3.0)}, "allowed: stiffness in N m/rad, or"),
        ("own", {"left_knee": "150"}, "are '150'"),
        ("servo", {"left_knee": 150.0}, "drives 'servo' has its own; allowed: drives 'own' or 'torque'"),
    ],
)
def test_gains_that_no_motor_takes_are_named(drives, gains, words):
    with pytest.raises(InputError, match=words):
        load_controller("h1", {"control": {"drives": drives}}, gains=gains)


@pytest.mark.parametrize(
    ("more", "tables", "words"),
    [
        ({"soles": "shoes"}, {}, "soles is 'shoes'; allowed: taxels, force_torque, torques"),
        ({"soles": "torques"}, {"control": {"pfc": True}}, r"pfc is True; allowed for soles = 'torques': False"),
        ({"commanded": True}, {"walk": {"steps": 4}}, "steps is given, and commanded, too"),
    ],
)
def test_what_does_not_go_together_is_named(more, tables, words):
    with pytest.raises(SceneError, match=words):
        load_controller("h1", tables, **more)


def test_a_velocity_that_is_no_number_is_named(walker):
    with pytest.raises(InputError, match="velocity 'left' is nan"):
        walker.set_velocity(0.1, float("nan"), 0.0)


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"walks": {}}, "walk"),
        ({"walk": {"step": 2}}, "steps"),
        ({"estimator": {"gravity": -1}}, "gravity"),
        ({"walk": {"pattern": "box", "steps": 5}}, "whole rounds of 6"),
        ({"conformity": {"gap": 0.002}, "control": {"conform": True, "pfc": False}}, "pfc = true"),
    ],
)
def test_a_wrong_table_is_named(tables, words):
    with pytest.raises(SceneError, match=words):
        load_controller("h1", tables)


def test_an_unknown_robot_is_named():
    with pytest.raises(RobotError, match="h1"):
        load_controller("h2")
