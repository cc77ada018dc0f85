import numpy as np
import pytest

from plantar.mechanics.rotation import rotation_from_vector
from plantar.robots.kinematics.tasks.pose_task import RollingPoseTask


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("floating", [False, True])
def test_its_jacobian_is_the_derivative_of_its_error(random_robot, differentiate, seed, floating):
    model, data = random_robot(seed, limbs=2, joints=4, floating=floating)
    differentiate(model, data, RollingPoseTask(model, data, model.site("b_end").id))


def test_a_roll_of_any_size_is_no_error(random_robot):
    model, data = random_robot(2)
    task, out = RollingPoseTask(model, data, model.site("a_end").id), np.empty(5)
    stands = task.rotation.copy()
    task.position = task.position + np.array([0.1, 0.0, -0.1])
    task.rotation = stands @ rotation_from_vector(np.array([0.4, 0.0, 0.0]))
    task.error(out)
    assert out == pytest.approx([0.1, 0.0, -0.1, 0.0, 0.0], abs=1e-9)
    task.rotation = stands @ rotation_from_vector(np.array([0.0, 0.002, -0.001]))
    task.error(out)
    assert out[3:] == pytest.approx([0.002, -0.001], abs=1e-7)
