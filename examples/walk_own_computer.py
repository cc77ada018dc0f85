"""A walking controller in a loop of your own, without Plantar's simulator: sensors in, joint targets out.

    python examples/walk_own_computer.py

Here MuJoCo is the robot: position servos, encoders, an IMU, and contact forces that are given to the nearest taxels.
On a real robot those lines read its drivers instead; nothing else changes, and `plantar.sim` is not imported.
"""

import mujoco
import numpy as np

import plantar
from plantar.gait.command import Sensors
from plantar.robots.kinematics.robot_model import robot_spec

walker = plantar.load_controller("h1", {"walk": {"steps": 4, "length": 0.15}})
spec = robot_spec(walker.robot)
spec.option.timestep = 0.001
spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=[0.8, 0.005, 0.0001])
model = spec.compile()
data = mujoco.MjData(model)
qpos = np.array([model.joint(name).qposadr[0] for name in walker.joints])
servo = {int(model.actuator_trnid[a, 0]): a for a in range(model.nu)}
servos = np.array([servo[model.joint(name).id] for name in walker.joints])
stiffness = model.actuator_gainprm[servos, 0]
imu = data.site(walker.robot.imu_site)
soles = {side: model.site(walker.robot.legs[side].sole_site).id for side in ("left", "right")}


def reading(side):
    """Each contact's force, given to the taxel that is nearest to it."""
    layout, site = walker.robot.layouts[side], soles[side]
    origin, rotation = data.site_xpos[site], data.site_xmat[site].reshape(3, 3)
    force, wrench = np.zeros(len(layout)), np.zeros(6)
    for k, contact in enumerate(data.contact):
        if model.site_bodyid[site] in model.geom_bodyid[list(contact.geom)]:
            mujoco.mj_contactForce(model, data, k, wrench)
            away = layout.positions - rotation.T @ (contact.pos - origin)
            force[np.linalg.norm(away, axis=1).argmin()] += wrench[0]
    return plantar.Reading(data.time, force)


def sense():
    """What the robot's computer reads at a tick."""
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_SITE, imu.id, velocity, 1)
    gravity = imu.xmat.reshape(3, 3).T @ [0.0, 0.0, 9.81]
    return Sensors(data.time, data.qpos[qpos], velocity[:3], gravity, {side: reading(side) for side in soles})


data.qpos[:3], data.qpos[qpos] = walker.base_position, walker.stance.angles
data.ctrl[servos] = walker.stance.angles + walker.stance.torques / stiffness
mujoco.mj_step(model, data, 500)  # the soles settle on the floor
data.time = 0.0
while data.time < walker.controller.end:
    targets = walker.joint_targets(walker.step(sense()))
    data.ctrl[servos] = targets.angles + targets.torques / stiffness
    mujoco.mj_step(model, data, round(walker.period / model.opt.timestep))
head = data.body(walker.robot.torso_body).xpos
print(f"walked {head[0]:.2f} m and {'fell' if head[2] < 0.5 else 'stands'}")
