"""Touches guide an arm that nobody prepared: skin round its links, MuJoCo's own contacts, torques at its joints.

    python examples/skin_any_arm.py                                             a planar arm
    python examples/skin_any_arm.py panda.xml 87,87,87,87,12,12,12 link5 link7  your model, torques in N m, links
    python examples/skin_any_arm.py ur5e.xml 150,150,150,28,28,28 forearm_link wrist_3_link     and last the hand

Gains that torques and period cannot hold are warned of before it moves. Needs the extra `sim`
"""

import sys

import mujoco
import numpy as np

from plantar.mujoco import Skin, Skins
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.machine import load_machine
from plantar.wholebody.held_gains import check_gains
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.tactile_guidance import GuidanceGains, TactileGuidance

path, most, *links, hand = sys.argv[1:] or ["", "60,60,60,60,60,60,60", "link4", "link7"]
spec = mujoco.MjSpec.from_file(path) if path else load_machine("planar-arm").spec()
for actuator in list(spec.actuators):
    spec.delete(actuator)
for joint in spec.joints:
    spec.add_actuator(target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
robot = MujocoDynamics(spec.copy().compile())
spec.worldbody.add_body(name="ball", mocap=True, pos=[9, 0, 0]).add_geom(size=[0.04] * 3)
model = spec.compile()
data = mujoco.MjData(model)
data.qpos[:] = model.jnt_range.mean(axis=1) + 0.3
mujoco.mj_forward(model, data)
robot.update(data.qpos, data.qvel, 0.0)

skins = Skins([Skin(body=name, around=(0, 0, 1)).bind(model) for name in links])
follow = TactileGuidance(
    skins.body_skin, list(skins.body_skin.slices), hand, np.zeros(3), GuidanceGains(inertia=5.0, damping=60.0)
)
stack = TaskStack([[follow], [Posture(robot.joint_positions.copy(), 20.0)]])
limits = np.array(most.split(","), dtype=float)
check_gains(robot, lambda arm, reading: stack.step(arm, reading).torque, skins.body_skin, model.opt.timestep, limits)

first = skins.skins[0]
pose = first.pose(data)
place = pose.position_in_world + pose.rotation_sole_to_world @ first.layout.positions[0]
out = -pose.rotation_sole_to_world @ first.layout.rotations[0][:, 2]
start = robot.pose(hand)[0]
largest = 0.0
for _ in range(int(1.0 / model.opt.timestep)):  # a ball comes 5 cm nearer, and stays
    data.mocap_pos[0] = place + (0.06 - min(0.1 * data.time, 0.05)) * out
    reading = skins.whole(data)  # of the step before: mj_step2 solves the forces of contacts, mj_step1 clears them
    mujoco.mj_step1(model, data)
    robot.update(data.qpos, data.qvel, data.time)
    data.ctrl[:] = np.clip(stack.step(robot, reading).torque, -limits, limits)
    mujoco.mj_step2(model, data)
    largest = max(largest, float(reading.force.sum()))
moved = 1e3 * (robot.pose(hand)[0] - start)
print(f"{len(skins.body_skin)} taxels on {', '.join(links)}: {largest:.0f} N at most, hand moved by {moved.round()} mm")
