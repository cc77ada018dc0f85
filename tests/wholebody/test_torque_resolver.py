import numpy as np
import pytest

from plantar.errors import InputError
from plantar.wholebody.torque_resolver import ResolverSettings, TorqueResolver

FREE = ResolverSettings(damping=0.0, velocity_pull=0.0, largest_lag=10.0, largest_acceleration=1e6)


def robot_at_rest(random_robot, size=4):
    robot = random_robot(np.random.default_rng(1), size)
    robot.velocity = np.zeros(size)
    return robot


def test_torques_of_an_acceleration_give_that_motion(random_robot):
    robot = robot_at_rest(random_robot)
    wanted = np.array([1.0, -2.0, 0.5, 0.0])
    resolver = TorqueResolver(np.full(4, 100.0), FREE)
    for _ in range(500):
        point = resolver.step(robot, robot.mass_matrix @ wanted + robot.bias, 2e-3)
        robot.velocity, robot.joint_positions = point.velocity, point.position  # ideal servos
    assert np.allclose(point.velocity, wanted, atol=1e-9)
    assert np.allclose(point.position, wanted / 2.0, atol=2e-3 * 2.0)


def test_gravity_alone_does_not_move_it(random_robot):
    robot = robot_at_rest(random_robot)
    point = TorqueResolver(np.full(4, 3.0)).step(robot, robot.bias, 2e-3)
    assert np.abs(point.velocity).max() < 1e-12


def test_damping_bounds_the_speed_whatever_its_rate(random_robot):
    robot = robot_at_rest(random_robot, 1)
    settings = ResolverSettings(damping=500.0, velocity_pull=0.0, largest_acceleration=1e6)
    resolver = TorqueResolver(np.array([100.0]), settings, mass=np.array([[2.0]]))
    for _ in range(200):
        point = resolver.step(robot, robot.bias + 1000.0, 0.05)
        robot.velocity, robot.joint_positions = point.velocity, point.position
    assert point.velocity[0] == pytest.approx(1000.0 / (2.0 * 500.0))


def test_limits_of_velocity_and_acceleration_hold(random_robot):
    robot = robot_at_rest(random_robot)
    resolver = TorqueResolver(np.array([0.5, 1.0, 1.5, 2.0]), ResolverSettings(largest_acceleration=20.0))
    last = np.zeros(4)
    for _ in range(300):
        point = resolver.step(robot, robot.bias + 1e4, 2e-3)
        assert (np.abs(point.velocity - last) <= 20.0 * 2e-3 + 1e-12).all()
        assert (np.abs(point.velocity) <= [0.5, 1.0, 1.5, 2.0]).all()
        last = robot.velocity = point.velocity
        robot.joint_positions = point.position


def test_the_virtual_robot_does_not_drift_from_one_that_is_held(random_robot):
    """Something holds the real joints: without the inner loop the virtual speed would grow without end."""
    robot = robot_at_rest(random_robot, 2)
    resolver = TorqueResolver(np.full(2, 1e3), ResolverSettings(damping=0.0, velocity_pull=5.0), mass=np.eye(2))
    for _ in range(5000):
        point = resolver.step(robot, robot.bias + 1.0, 2e-3)
    assert np.allclose(point.velocity, 1.0 / 5.0)
    assert (np.abs(point.position - robot.joint_positions) <= 0.1).all()
    drifting = TorqueResolver(np.full(2, 1e3), FREE, mass=np.eye(2))
    for _ in range(5000):
        point = drifting.step(robot, robot.bias + 1.0, 2e-3)
    assert (point.velocity > 9.9).all()


def test_it_starts_from_the_real_motion(random_robot):
    robot = random_robot(np.random.default_rng(2), 3)
    robot.joint_positions = np.array([0.1, 0.2, 0.3])
    point = TorqueResolver(np.full(3, 10.0), FREE).step(robot, robot.bias, 1e-3)
    assert np.allclose(point.velocity, robot.velocity)
    assert np.allclose(point.position, robot.joint_positions + 1e-3 * robot.velocity)


def test_bad_limits_and_masses_are_refused():
    with pytest.raises(InputError, match="velocity limit is 0; allowed: above 0"):
        TorqueResolver(np.array([1.0, 0.0]))
    with pytest.raises(InputError, match="virtual mass"):
        TorqueResolver(np.ones(2), mass=np.diag([1.0, -1.0]))
