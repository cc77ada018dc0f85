import numpy as np
import pytest

from plantar.errors import InputError
from plantar.wholebody.fusion.null_space import weighted_sum
from plantar.wholebody.tasks.task import Demand


def test_it_is_the_weighted_sum_of_the_tasks_torques(random_robot):
    rng = np.random.default_rng(1)
    robot = random_robot(rng, 5)
    one, other = (Demand(rng.normal(size=(m, 5)), force=rng.normal(size=m)) for m in (2, 3))
    each = np.array([1.0, 0.0, 2.0, 0.5, 1.0])
    found = weighted_sum(robot, [[one, None], [other]], weights=[0.5, each])
    wanted = 0.5 * one.jacobian.T @ one.force + each * (other.jacobian.T @ other.force)
    assert np.allclose(found.torque - robot.bias, wanted)
    assert np.allclose(robot.mass_matrix @ found.acceleration, wanted)


def test_every_task_disturbs_every_other(random_robot):
    rng = np.random.default_rng(2)
    robot = random_robot(rng, 6)
    first, second = (Demand(rng.normal(size=(2, 6)), acceleration=np.ones(2)) for _ in range(2))
    assert np.allclose(first.jacobian @ weighted_sum(robot, [[first]]).acceleration, 1.0)
    assert np.abs(first.jacobian @ weighted_sum(robot, [[first], [second]]).acceleration - 1.0).max() > 1e-2


def test_a_support_stays(random_robot):
    rng = np.random.default_rng(3)
    robot = random_robot(rng, 15, base=6)
    support = Demand(rng.normal(size=(6, 15)), acceleration=np.zeros(6), drift=np.zeros(6))
    found = weighted_sum(robot, [[Demand(np.eye(15), force=rng.normal(size=15))]], support)
    assert np.abs(support.jacobian @ found.acceleration).max() < 1e-11
    assert found.support_force is not None


def test_a_weight_for_each_level_is_needed(random_robot):
    robot = random_robot(np.random.default_rng(4), 3)
    with pytest.raises(InputError, match="2 weights for 1 levels"):
        weighted_sum(robot, [[]], weights=[1.0, 1.0])
