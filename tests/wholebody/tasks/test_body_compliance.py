"""The body's compliance: the torques of a posture and of the tasks that it yields to add up."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.wholebody.tasks.posture import BodyCompliance
from plantar.wholebody.tasks.task import Demand, Task


class Asks(Task):
    """A task of some force along some directions; None asks for none."""

    def __init__(self, jacobian, force):
        self.asked = None if force is None else Demand(jacobian, force=force)

    def demand(self, robot, skin):
        return self.asked


def test_torques_of_posture_and_of_yielding_tasks_add_up():
    rng = np.random.default_rng(0)
    (posture, arm, hand), (p, a, h) = (rng.normal(size=(3, 2, 4)), rng.normal(size=(3, 2)))
    task = BodyCompliance(Asks(posture, p), Asks(arm, a), Asks(None, None), Asks(hand, h))
    asked = task.demand(SimpleNamespace(velocity=np.zeros(4)), None)
    assert asked.jacobian == pytest.approx(np.eye(4))
    assert asked.force == pytest.approx(posture.T @ p + arm.T @ a + hand.T @ h)
