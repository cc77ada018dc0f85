import numpy as np
import pytest

from plantar.robots.kinematics.tasks.posture_task import PostureTask


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("floating", [False, True])
def test_its_jacobian_is_the_derivative_of_its_error(random_robot, differentiate, seed, floating):
    model, data = random_robot(seed, limbs=2, joints=4, floating=floating)
    ids = [model.joint(name).id for name in ("b1", "a0", "a3")]
    differentiate(model, data, PostureTask(model, data, ids))


def test_its_error_is_the_way_of_each_joint_in_the_given_order(random_robot):
    model, data = random_robot(3, limbs=2, joints=4, floating=True)
    ids = [model.joint(name).id for name in ("b1", "a0")]
    task, out = PostureTask(model, data, ids), np.empty(2)
    task.target = np.array([0.3, -0.2])
    task.error(out)
    assert out == pytest.approx([0.3 - data.joint("b1").qpos[0], -0.2 - data.joint("a0").qpos[0]])
