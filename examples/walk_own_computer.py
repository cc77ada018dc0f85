"""A walking controller in a loop of your own, without Plantar's simulator: sensors in, joint targets out.

    python examples/walk_own_computer.py
    python examples/walk_own_computer.py out/g1/robot.toml 20       a robot made by `plantar robot MODEL`, 20 steps

Here MuJoCo is the robot: position servos, encoders, an IMU, and skins. On a real robot those lines read its drivers
instead; nothing else changes, and `plantar.sim` is not imported. More: docs/tutorials/loop.md
"""

import sys

import mujoco
import numpy as np

import plantar
from plantar.gait.command import Sensors
from plantar.mujoco import Skin
from plantar.robots.kinematics.robot_model import robot_spec

robot, steps = (*sys.argv[1:], *("h1", "4")[len(sys.argv) - 1 :])
walker = plantar.load_controller(robot, {"walk": {"steps": int(steps), "length": "1/4 leg"}})
spec = robot_spec(walker.robot)
spec.option.timestep = 0.001
spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST  # joints are stiff and damped
spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=[0.8, 0.005, 0.0001])
model = spec.compile()
data = mujoco.MjData(model)
qpos = np.array([model.joint(name).qposadr[0] for name in walker.joints])
servo = {int(model.actuator_trnid[a, 0]): a for a in range(model.nu)}
servos = np.array([servo[model.joint(name).id] for name in walker.joints])
stiffness = model.actuator_gainprm[servos, 0]
imu = data.site(walker.robot.imu_site)
soles = {
    side: Skin(walker.robot.layouts[side], leg.foot_body, site=leg.sole_site).bind(model)
    for side, leg in walker.robot.legs.items()
}


def sense():
    """What the robot's computer reads at a tick."""
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_SITE, imu.id, velocity, 1)
    gravity = imu.xmat.reshape(3, 3).T @ [0.0, 0.0, 9.81]
    readings = {side: feel(data) for side, feel in soles.items()}
    return Sensors(data.time, data.qpos[qpos], velocity[:3], gravity, readings)


data.qpos[:3], data.qpos[qpos] = walker.base_position, walker.stance.angles
data.ctrl[servos] = walker.stance.angles + walker.stance.torques / stiffness
mujoco.mj_step(model, data, 500)  # the soles settle on the floor
ticks = 0
while ticks * walker.period < walker.end and not data.warning.number.any():
    targets = walker.joint_targets(walker.step(sense()))
    data.ctrl[servos] = targets.angles + targets.torques / stiffness
    mujoco.mj_step(model, data, round(walker.period / model.opt.timestep))
    ticks += 1
torso = data.body(walker.robot.torso_body)
end = "diverged" if data.warning.number.any() else "fell" if torso.xmat[8] < 0.7 else "stands"
print(f"walked {torso.xpos[0]:.2f} m and {end}; controller: {walker.state or 'walks'}")
print(*walker.findings, sep="\n")  # what bring-up found wrong: nothing here
