import numpy as np

from plantar.wholebody.fusion.hierarchy import fuse
from plantar.wholebody.tasks.cartesian_pose import CartesianPose
from plantar.wholebody.tasks.point_force import AlongForce
from plantar.wholebody.tasks.task import Demand


class Pushes:
    """Wrenches on two links; the second may be none."""

    def __init__(self, *wrenches):
        self.wrenches = wrenches

    def demand(self, robot, skin):
        links = ("link6", "link3")[: len(self.wrenches)]
        return Demand(np.vstack([robot.jacobian(link) for link in links]), force=np.concatenate(self.wrenches))


def test_it_acts_as_the_task_does_but_leaves_the_rest_of_the_link(random_chain):
    robot = random_chain(np.random.default_rng(0), 7, parallel=True)
    robot.update(np.full(7, 0.4), np.zeros(7), 0.0)
    one, other = Pushes(np.array([3.0, -1.0, 2.0, 0.1, 0.2, 0.0]), np.zeros(6)), CartesianPose("link6", rows="position")
    other.demand(robot, None)
    other.target_position = other.target_position + 0.01
    whole, row = one.demand(robot, None), AlongForce(one).demand(robot, None)
    assert row.jacobian.shape == (1, 7)
    assert np.allclose(row.jacobian.T @ row.force, whole.jacobian.T @ whole.force)
    wanted = other.demand(robot, None)
    error = {
        name: np.linalg.norm(wanted.jacobian @ fuse(robot, [[first], [wanted]]).acceleration - wanted.acceleration)
        for name, first in (("whole", whole), ("row", row))
    }
    assert np.allclose(
        row.jacobian @ (fuse(robot, [[row], [wanted]]).acceleration), row.jacobian @ fuse(robot, [[row]]).acceleration
    )
    assert error["row"] < error["whole"]


def test_it_damps_the_motion_along_the_push(random_chain):
    robot = random_chain(np.random.default_rng(1), 7)
    task = AlongForce(Pushes(np.array([0.0, 0.0, 5.0, 0.0, 0.0, 0.0])), damping=10.0)
    row = task.demand(robot, None).jacobian[0]
    for speed, force in ((-0.2, 7.0), (0.2, 3.0)):
        robot.update(robot.model.qpos0, speed * row / (row @ row), 0.0)
        assert np.allclose(task.demand(robot, None).force, force)


def test_no_push_is_no_demand(random_chain):
    robot = random_chain(np.random.default_rng(2), 7)
    assert AlongForce(Pushes(np.zeros(6), np.zeros(6))).demand(robot, None) is None
