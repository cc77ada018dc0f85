import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.errors import SceneError
from plantar.gait.command import Command, Sensors
from plantar.robots.controller import RobotController, load_controller
from plantar.robots.motors.command_motors import motor_gains, planned_wrenches
from plantar.robots.robot_file import load_robot
from plantar.sensing.reading import Reading


def first_command(walker: RobotController) -> Command:
    """Command of a robot at rest in its stance, half of its weight on each sole."""
    readings = {}
    for side in SIDES:
        layout = walker.robot.layouts[side]
        readings[side] = Reading(0.0, np.full(len(layout), 0.5 * 9.81 * walker.legs.mass / len(layout)))
    return walker.step(Sensors(0.0, walker.stance.angles, np.zeros(3), np.array([0.0, 0.0, 9.81]), readings))


def test_another_stiffness_keeps_the_damping_ratio():
    robot = load_robot("h1")
    own, soft = motor_gains(robot, 0.0), motor_gains(robot, 200.0)
    assert own.stiffness.tolist() == [*robot.own_stiffness] * 2
    assert (soft.stiffness == 200.0).all()
    assert soft.damping / np.sqrt(soft.stiffness) == pytest.approx(own.damping / np.sqrt(own.stiffness))


def test_a_stiffness_that_does_nothing_is_refused():
    with pytest.raises(SceneError, match="joint_stiffness does nothing to drives 'servo'"):
        load_controller("h1", {"walk": {"steps": 4}, "control": {"joint_stiffness": 150}})


def test_a_resting_robot_gets_the_torques_that_hold_it():
    walker = load_controller("h1", {"walk": {"steps": 4}, "control": {"drives": "own", "joint_stiffness": 150}})
    command = first_command(walker)
    targets = command.joints
    assert targets.angles == pytest.approx(walker.stance.angles, abs=2e-3)
    assert np.abs(targets.torques - walker.stance.torques).max() < 0.02 * 9.81 * walker.legs.mass
    assert targets.velocities.tolist() == [0.0] * 12
    assert targets.stiffness.tolist() == [150.0] * 12
    assert walker.joint_targets(command) is targets


def test_planned_wrenches_act_at_the_centers_of_pressure():
    command = first_command(load_controller("hrp2kai", {"walk": {"steps": 4}}))
    wrenches = planned_wrenches(command)
    assert set(wrenches) == set(SIDES)
    for side, wrench in wrenches.items():
        foot = command.feet[side]
        place = foot.position[:2] + np.array([-wrench[4], wrench[3]]) / wrench[2]
        assert place == pytest.approx(foot.center_of_pressure)
