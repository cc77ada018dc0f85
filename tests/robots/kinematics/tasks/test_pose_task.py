import numpy as np
import pytest

from plantar.mechanics.rotation import rotation_from_vector
from plantar.robots.kinematics.tasks.pose_task import PoseTask


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("floating", [False, True])
def test_its_jacobian_is_the_derivative_of_its_error(random_robot, differentiate, seed, floating):
    model, data = random_robot(seed, limbs=2, joints=4, floating=floating)
    differentiate(model, data, PoseTask(model, data, model.site("b_end").id))


def test_its_error_is_way_and_turn_in_the_world_frame(random_robot):
    model, data = random_robot(2)
    task, out = PoseTask(model, data, model.site("a_end").id), np.empty(6)
    turn = np.array([0.002, -0.001, 0.003])
    task.position = task.position + np.array([0.1, 0.0, -0.1])
    task.rotation = rotation_from_vector(turn) @ task.rotation
    task.error(out)
    assert out == pytest.approx([0.1, 0.0, -0.1, *turn], abs=1e-8)
