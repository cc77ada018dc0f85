"""How far from its ankle a foot can carry the whole robot, by the torque limits of the ankle's joints."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.robots.kinematics.body import pitching_joints, rolling_joints, stood
from plantar.robots.robot import Robot
from plantar.sides import SIDES, Side

__all__ = ["ankle_limits"]


def ankle_limits(robot: Robot, model: mujoco.MjModel, weight: float) -> dict[Side, NDArray[np.float64]]:
    """Where the weight may act on each sole while the robot stands on it, without an ankle joint beyond its limit.

    The weight W e_z at p has the torque a . ((p - c) x W e_z) on a joint with axis a through c: a strip of the sole for
    each joint. The ankle's joints are the last that pitches and the last that rolls.

    Args:
        robot: The robot.
        model: A model with the robot in it.
        weight: Its weight in N.

    Returns:
        Strips (m, 4) in each sole's frame: a unit normal (x, y), and the strip's middle and half width along it in m;
        none of a joint without a limit.
    """
    data = stood(robot, model)
    limits = _torque_limits(model)
    found: dict[Side, NDArray[np.float64]] = {}
    for side in SIDES:
        site = model.site(robot.legs[side].sole_site).id
        origin, rotation = data.site_xpos[site], data.site_xmat[site].reshape(3, 3)
        strips = []
        for turning in (pitching_joints(robot, side, model, data), rolling_joints(robot, side, model, data)):
            if len(turning) < 2 or turning[-1] not in limits:  # one joint alone is the hip's
                continue
            axis, anchor = rotation.T @ data.xaxis[turning[-1]], rotation.T @ (data.xanchor[turning[-1]] - origin)
            lever = np.array([-axis[1], axis[0]])  # a . (r x e_z) = a_x r_y - a_y r_x
            size = float(np.hypot(*lever))
            lever /= size
            strips.append([*lever, float(lever @ anchor[:2]), limits[turning[-1]] / weight / size])
        found[side] = np.array(strips).reshape(-1, 4)
    return found


def _torque_limits(model: mujoco.MjModel) -> dict[int, float]:
    """Torque limit in N m of each joint whose actuator has one."""
    return {
        int(model.actuator_trnid[a, 0]): float(model.actuator_forcerange[a, 1] * abs(model.actuator_gear[a, 0]))
        for a in range(model.nu)
        if model.actuator_forcelimited[a]
    }
