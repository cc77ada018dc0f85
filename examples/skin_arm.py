"""An arm covered with skin gives way to a ball that is pushed against it, and keeps its tip where it is.

    python examples/skin_arm.py

Plain MuJoCo, no runner: what a robot's own computer would do at each tick. The tip's task stands above the skin's, so
what touches the arm moves it in the null space of the tip alone, which does not feel a force that the skin shows.
"""

import mujoco
import numpy as np

from plantar.mujoco import FoamSkins
from plantar.sim.body_skin.surface import skin_from_tables
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.machine import load_machine
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.skin_interaction import DirectInteraction

machine = load_machine("planar-arm")
alone = machine.spec().compile()
spec = machine.spec()
ball = spec.worldbody.add_body(name="ball", mocap=True)
ball.add_geom(name="ball", size=[0.06, 0, 0])
model = spec.compile()
data = mujoco.MjData(model)
data.qpos[:] = machine.posture
mujoco.mj_forward(model, data)

skin = skin_from_tables(alone, machine.patches, machine.name)
foam = FoamSkins(model, skin, obstacles=["ball"])
robot = MujocoDynamics(alone)
tip = CartesianPose("link7", np.array([0.265, 0.0, 0.0]), PoseGains(stiffness=900.0, damping=60.0), "position")
touch = DirectInteraction(skin, gain=2.0)
stack = TaskStack([[tip], [touch, Posture(machine.posture, 20.0, 8.0, torques=True)]])

elbow = data.body("link4").xpos.copy()
toward = -np.array([np.sin(0.5), -np.cos(0.5), 0.0])
largest = 0.0
for k in range(3000):  # 3 s; the ball comes 8 cm nearer and goes back
    push = 0.08 * np.sin(np.pi * k / 3000) ** 2
    data.mocap_pos[0] = elbow - (0.1 - push) * toward
    mujoco.mj_step1(model, data)
    foam.press(data)
    robot.update(data.qpos, data.qvel, data.time)
    reading = foam.whole(data)
    measured = touch.demand(robot, reading)
    external = None if measured is None else measured.jacobian.T @ measured.force / touch.gain
    data.ctrl[:] = stack.step(robot, reading, external).torque
    mujoco.mj_step2(model, data)
    largest = max(largest, float(np.linalg.norm(data.body("link4").xpos - elbow)))
    if k % 500 == 499:
        force, off = foam.force.sum(), 1e3 * np.linalg.norm(tip.position_error(robot))
        print(f"{data.time:.1f} s: {force:5.1f} N on the skin, tip off by {off:.2f} mm")
print(f"the elbow gave way by {1e3 * largest:.0f} mm; {len(skin)} taxels, silent tasks skipped: {stack.silent}")
