"""Drive a robot by keyboard in a loop of your own at 500 Hz: it stands, starts, walks, turns and stops without end.

    python examples/walk_by_keyboard.py [out/g1/robot.toml]        h1, or a robot made by `plantar robot MODEL`

w s: forward, back; a d: left, right; q e: turn; x: end; any other: stop. Without a terminal it presses a script's keys.
Motors get q, dq, kp, kd and torque, as in makers' low-level commands. More: docs/tutorials/loop.md
"""

import atexit
import os
import select
import sys
import time
import tty

import mujoco
import numpy as np

import plantar
from plantar.gait.command import Sensors
from plantar.robots.kinematics.robot_model import robot_spec

KEYS = {"w": (0.2, 0, 0), "s": (-0.1, 0, 0), "a": (0, 0.06, 0), "d": (0, -0.06, 0), "q": (0, 0, 0.3), "e": (0, 0, -0.3)}
typed = sys.stdin.isatty()
SCRIPT = {} if typed else {1: "w", 4: "q", 6: "s", 8: "a", 10: " ", 13: "x"}  # s: key
table = {"control": {"period": 0.002}}
walker = plantar.load_controller(*(sys.argv[1:] or ["h1"]), table, commanded=True, soles="force_torque")
walker.count_as_checked()  # a simulator's sensors are wired right
spec = robot_spec(walker.robot)
spec.option.timestep, spec.option.integrator = 0.001, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=[0.8, 0.005, 0.0001])
data = mujoco.MjData(model := spec.compile())
at = np.array([model.joint(name).qposadr[0] for name in walker.joints])
motors = [list(model.actuator_trnid[:, 0]).index(model.joint(name).id) for name in walker.joints]
sensed = model.sensor("imu_gyro").adr[0]  # then accelerometer, left and right ankle
if typed:
    tty.setcbreak(0)
    atexit.register(os.system, "stty sane")


def exert(q, dq, kp, kd, torque):  # kp (q - angle) + kd (dq - rate) + torque in each joint, for 2 ms
    model.actuator_gainprm[motors, 0] = 1.0
    model.actuator_biasprm[motors, 1:3] = -np.column_stack([kp, kd])
    data.ctrl[motors] = kp * q + kd * dq + torque
    mujoco.mj_step(model, data, 2)


data.qpos[:3], data.qpos[at] = walker.base_position, walker.stance.angles
exert(walker.stance.angles, 0.0, *walker.gains, walker.stance.torques)
began, pressed = time.monotonic(), ""
while pressed != "x" and not data.warning.number.any():
    gyro, pull, left, right = np.split(data.sensordata[sensed : sensed + 18].copy(), (3, 6, 12))
    ankles = {"left": -left, "right": -right}  # by the foot on its leg; MuJoCo reports the leg's on the foot
    exert(*walker.motor_command(walker.step(Sensors(data.time, data.qpos[at], gyro, pull, {}, ankles))))
    pressed = SCRIPT.pop(round(data.time, 3), "")
    if typed and select.select([0], [], [], max(0.0, data.time - time.monotonic() + began))[0]:  # in real time
        pressed = os.read(0, 1).decode()
    if pressed:
        (walker.set_velocity if pressed in KEYS else walker.stop)(*KEYS.get(pressed, ()))
print(f"at {data.qpos[0]:.2f} {data.qpos[1]:.2f} m, {data.qpos[2]:.2f} m high; {walker.state or 'walks'}")
