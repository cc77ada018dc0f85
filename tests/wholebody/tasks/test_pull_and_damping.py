"""Tasks with a target pull towards it, brake what moves otherwise than wanted, and ask for no more at it."""

import numpy as np
import pytest

from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.posture import Posture

PLACE, SPEED = np.array([0.3, -0.2, 0.0]), np.array([0.5, -0.7, 0.0])


@pytest.fixture(autouse=True)
def moving(robot):
    robot.update(PLACE, SPEED, 0.1)


def test_a_centre_of_mass_is_pulled_and_braked(robot):
    task = CenterOfMass(PLACE + np.array([0.1, 0.0, 0.0]), stiffness=40.0, damping=3.0)
    assert task.demand(robot, None).acceleration == pytest.approx([40.0 * 0.1 - 3.0 * 0.5, 3.0 * 0.7, 0.0])
    task.target_velocity = SPEED
    assert task.demand(robot, None).acceleration == pytest.approx([4.0, 0.0, 0.0])
    held = CenterOfMass(PLACE, stiffness=40.0, axes=(1,))
    assert held.demand(robot, None).acceleration == pytest.approx([2.0 * np.sqrt(40.0) * 0.7])
    assert held.demand(robot, None).jacobian == pytest.approx(np.array([[0.0, 1.0, 0.0]]))


@pytest.mark.parametrize("torques", [False, True])
def test_a_posture_is_pulled_and_braked(robot, torques):
    task = Posture(PLACE + np.array([0.0, 0.1, 0.2]), stiffness=10.0, damping=2.0, torques=torques)
    demand = task.demand(robot, None)
    asked, other = (demand.force, demand.acceleration) if torques else (demand.acceleration, demand.force)
    assert other is None
    assert asked == pytest.approx([-2.0 * 0.5, 10.0 * 0.1 + 2.0 * 0.7, 10.0 * 0.2])
    task.target_velocity = SPEED
    demand = task.demand(robot, None)
    assert (demand.force if torques else demand.acceleration) == pytest.approx([0.0, 1.0, 2.0])
    part = Posture(PLACE + np.array([0.0, 0.1, 0.2]), stiffness=9.0, joints=(2, 0)).demand(robot, None)
    assert part.acceleration == pytest.approx([9.0 * 0.2, -2.0 * 3.0 * 0.5])
    assert part.jacobian == pytest.approx(np.eye(3)[[2, 0]])


def test_a_pose_is_pulled_no_faster_than_its_speed_and_braked(robot):
    turning = np.array([0.5, -0.7, 0.4])
    robot.update(np.array([0.3, -0.2, 0.0]), turning, 0.1)
    gains = PoseGains(stiffness=100.0, damping=4.0, speed=0.5, turn_stiffness=30.0, turn_damping=6.0)
    task = CartesianPose("hand", gains=gains)
    task.demand(robot, None)  # holds where it is
    still = task.demand(robot, None)
    assert still.acceleration == pytest.approx([-4.0 * 0.5, 4.0 * 0.7, 0.0, 0.0, 0.0, -6.0 * 0.4])
    task.target_velocity, task.target_acceleration = np.array([0.5, -0.7, 0.0]), np.array([0.0, 0.3, 0.0])
    task.target_position = PLACE + np.array([0.01, 0.0, 0.0])
    assert task.demand(robot, None).acceleration[:3] == pytest.approx([100.0 * 0.01, 0.3, 0.0])
    task.target_position = PLACE + np.array([3.0, 0.0, 0.0])
    assert task.position_error(robot) == pytest.approx([3.0, 0.0, 0.0])
    assert task.demand(robot, None).acceleration[:3] == pytest.approx([4.0 * 0.5, 0.3, 0.0])
    c, s = np.cos(0.1), np.sin(0.1)
    task.target_rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    assert task.demand(robot, None).acceleration[3:] == pytest.approx([0.0, 0.0, 30.0 * 0.1 - 6.0 * 0.4], abs=0.02)
    position = CartesianPose("hand", gains=gains, rows="position").demand(robot, None)
    turn = CartesianPose("hand", gains=gains, rows="orientation").demand(robot, None)
    assert position.jacobian == pytest.approx(still.jacobian[:3])
    assert turn.jacobian == pytest.approx(still.jacobian[3:])
    assert turn.acceleration == pytest.approx([0.0, 0.0, -6.0 * 0.4])
