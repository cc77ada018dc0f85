"""Force-torque sensors of the ankles in a robot's model."""

from typing import Any

import mujoco

from plantar.common.sides import SIDES, Side
from plantar.gait.estimate.ankle_sensor import AnkleSensor
from plantar.robots.robot import Robot


def ankle_sensors(model: Any, robot: Robot) -> dict[Side, AnkleSensor]:
    """Place of each ankle's force-torque sensor, and the mass below it.

    Takes `model` and `robot`; returns the sensors.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    sensors: dict[Side, AnkleSensor] = {}
    for side in SIDES:
        sole = model.site(robot.legs[side].sole_site).id
        site = model.site(f"{side}_ankle_force_torque").id
        body = model.site_bodyid[site]
        origin = data.site_xpos[sole]
        rotation = data.site_xmat[sole].reshape(3, 3)
        sensors[side] = AnkleSensor(
            position=rotation.T @ (data.site_xpos[site] - origin),
            rotation=rotation.T @ data.site_xmat[site].reshape(3, 3),
            mass=float(model.body_subtreemass[body]),
            com=rotation.T @ (data.subtree_com[body] - origin),
        )
    return sensors
