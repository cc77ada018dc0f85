import mujoco
import numpy as np
import pytest

from plantar.mechanics.rotation import rotation_from_vector
from plantar.robots.kinematics.tasks.pose_task import OrientationTask


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("floating", [False, True])
def test_its_jacobian_is_the_derivative_of_its_error(random_robot, differentiate, seed, floating):
    model, data = random_robot(seed, limbs=2, joints=4, floating=floating)
    differentiate(model, data, OrientationTask(model, data, model.body("a2").id))


def test_its_error_turns_the_body_into_the_target(random_robot):
    model, data = random_robot(1, floating=True)
    task, out = OrientationTask(model, data, model.body("root").id), np.empty(3)
    task.target = rotation_from_vector(np.array([0.5, -1.0, 2.0]))
    for _ in range(20):
        mujoco.mj_kinematics(model, data)
        task.error(out)
        data.qvel[3:6] = data.xmat[1].reshape(3, 3).T @ out  # a free joint's rate is in its own frame
        mujoco.mj_integratePos(model, data.qpos, data.qvel, 1.0)
    mujoco.mj_kinematics(model, data)
    assert data.xmat[1].reshape(3, 3) == pytest.approx(task.target, abs=1e-12)
