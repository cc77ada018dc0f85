import numpy as np
import pytest

from plantar.robots.kinematics.tasks.com_task import ComTask


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("floating", [False, True])
def test_its_jacobian_is_the_derivative_of_its_error(random_robot, differentiate, seed, floating):
    model, data = random_robot(seed, limbs=2, joints=4, floating=floating)
    differentiate(model, data, ComTask(model, data, model.body("root").id))


def test_its_error_is_the_way_to_the_target(random_robot):
    model, data = random_robot(0)
    task, out = ComTask(model, data, 0), np.empty(3)
    task.target = task.target + np.array([0.1, -0.2, 0.3])
    task.error(out)
    assert out == pytest.approx([0.1, -0.2, 0.3])
    masses = model.body_mass[1:] / model.body_mass[1:].sum()
    assert task.target - out == pytest.approx(masses @ data.xipos[1:])
