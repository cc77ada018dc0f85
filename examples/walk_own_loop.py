"""The walking controller in your own loop: what a robot's computer does 200 times a second.

    python examples/walk_own_loop.py

The controller takes `Sensors` (a reading of each sole, joint angles, IMU) and returns a `Command`; the leg servos turn
it into joint angles. Nothing here but MuJoCo's own step knows the true state.
"""

import mujoco
import numpy as np

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

parts = Simulation(load_scene("flat", ["steps=4", "settle=0.5"]))  # builds and wires the parts; its loop is not used
world, sensors, controller, servos = parts.world, parts.sensors, parts.controller, parts.servos
tick_every = round(parts.settings.period / world.period)

for k in range(round(parts.end / world.period)):
    if k % sensors.skin_every == 0:
        sensors.read_skins(controller.proximity_sides, False)  # 250 Hz
    if k % tick_every == 0:
        command = controller.step(sensors.read_body())  # 200 Hz: sense, estimate, plan, balance
        servos.command(command)  # inverse kinematics
    if k % 500 == 0:
        loads = [f"{side} {percept.vertical_force:4.0f} N" for side, percept in command.percepts.items()]
        com = np.round(command.state.com, 3).tolist()
        print(f"{world.data.time:4.1f} s: {', '.join(loads)}, CoM estimated at {com} m")
    servos.drive()
    mujoco.mj_step(world.model, world.data)

print(f"walked {world.data.qpos[0]:.2f} m; the controller thinks {command.state.com[0]:.2f} m")
