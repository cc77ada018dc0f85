"""Joints are pushed back near the ends of their range, and only there."""

import mujoco
import numpy as np
import pytest

from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.standing.joint_range import JointRange

ARM = """<mujoco><worldbody><body><joint name="a" axis="0 0 1"/><geom size=".1" pos=".3 0 0"/>
<body pos=".3 0 0"><joint name="b" axis="0 0 1"/><geom size=".1" pos=".3 0 0"/></body></body></worldbody></mujoco>"""


def test_rows_are_those_of_joints_near_an_end():
    robot = MujocoDynamics(mujoco.MjModel.from_xml_string(ARM))
    task = JointRange([-1.0, -1.0], [1.0, 2.0], margin=0.1, stiffness=50.0, damping=2.0)
    robot.update(np.array([0.5, 1.0]), np.zeros(2), 0.0)
    assert task.demand(robot, None) is None
    robot.update(np.array([0.98, 1.0]), np.array([0.5, 0.0]), 0.0)
    found = task.demand(robot, None)
    assert found.jacobian.tolist() == [[1.0, 0.0]]
    assert found.force == pytest.approx([-50.0 * 0.08 - 2.0 * 0.5])
    robot.update(np.array([0.5, -0.97]), np.array([0.5, 1.0]), 0.0)
    found = task.demand(robot, None)
    assert found.force == pytest.approx([50.0 * 0.07])
