"""A task of your own is one class: here a link that keeps its heading, like a tray that must not turn.

    python examples/skin_new_task.py

It states its Jacobian and the acceleration that it asks for; in which order it stands to others is decided by the
stack. The same stack is run with the task and without it, while the tip is sent to a place.
"""

import mujoco
import numpy as np

from plantar.mechanics.rotation import heading
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.machine import load_machine
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.cartesian_pose import CartesianPose
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.task import Demand, Task


class Tray(Task):
    """Keeps the heading of a link: psi''* = k (psi_d - psi) - d psi'."""

    def __init__(self, link, stiffness=400.0):
        self.link, self.stiffness, self.target = link, stiffness, None

    def demand(self, robot, skin):
        actual = heading(robot.pose(self.link)[1])
        self.target = actual if self.target is None else self.target
        row = robot.jacobian(self.link)[5:]  # about the world's z axis
        pull = self.stiffness * (self.target - actual) - 2.0 * np.sqrt(self.stiffness) * (row @ robot.velocity)
        return Demand(row, acceleration=pull, drift=robot.drift(self.link)[5:])


def heading_of(data, link):
    return heading(data.body(link).xmat.reshape(3, 3))


def largest_turn(levels, link):
    """Largest angle in degrees by which a link turns in 3 s of a stack."""
    machine = load_machine("planar-arm")
    model = machine.spec().compile()
    data, robot = mujoco.MjData(model), MujocoDynamics(model)
    data.qpos[:] = machine.posture
    mujoco.mj_forward(model, data)
    stack, worst, first = TaskStack([*levels, [Posture(machine.posture, 5.0)]]), 0.0, heading_of(data, link)
    for _ in range(3000):
        robot.update(data.qpos, data.qvel, data.time)
        data.ctrl[:] = stack.step(robot).torque
        mujoco.mj_step(model, data)
        worst = max(worst, abs(heading_of(data, link) - first))
    return np.degrees(worst)


for kept in (True, False):
    tip, tray = CartesianPose("link7", rows="position"), Tray("link4")
    tip.target_position = np.array([0.6, -0.4, 0.8])
    turned = largest_turn([[tray], [tip]] if kept else [[tip]], "link4")
    print(f"{'with' if kept else 'without'} the task the tray turns by {turned:.2f} degrees")
