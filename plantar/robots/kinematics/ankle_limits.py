"""How far from its ankle a foot carries the robot, and how high its leg has to stand, by torque limits."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.contact.standing_leg import StandingLeg
from plantar.robots.kinematics.body import pitching_joints, rolling_joints, stood
from plantar.robots.robot import Robot


def ankle_limits(robot: Robot, model: mujoco.MjModel, weight: float) -> dict[Side, NDArray[np.float64]]:
    """Where weight may act on each sole in single support, by torque limits.

    The weight W e_z at p has the torque a . ((p - c) x W e_z) on a joint with axis a through c: a strip of the sole for
    each joint. The ankle's joints are the last that pitches and the last that rolls.

    `weight` in N. Returns strips (m, 5) in each sole's frame: unit normal (x, y), the strip's middle and half width
    along it in m, and the ankle's height in m, by which a sloping sole moves it; none without limits.
    """
    data = stood(robot, model)
    limits = _torque_limits(model)
    found: dict[Side, NDArray[np.float64]] = {}
    for side in SIDES:
        site = model.site(robot.legs[side].sole_site).id
        origin = data.site_xpos[site]
        rotation = data.site_xmat[site].reshape(3, 3)
        strips = []
        pitching = pitching_joints(robot, side, model, data)
        for turning in (pitching, rolling_joints(robot, side, model, data)):
            if len(turning) < 2 or turning[-1] not in limits:  # one joint alone is the hip's
                continue
            axis = rotation.T @ data.xaxis[turning[-1]]
            anchor = rotation.T @ (data.xanchor[turning[-1]] - origin)
            lever = np.array([-axis[1], axis[0]])  # a . (r x e_z) = a_x r_y - a_y r_x
            size = float(np.hypot(*lever))
            lever /= size
            strips.append([*lever, float(lever @ anchor[:2]), limits[turning[-1]] / weight / size, anchor[2]])
        found[side] = np.array(strips).reshape(-1, 5)
    return found


def standing_legs(robot: Robot, model: mujoco.MjModel, weight: float, crouch: float) -> dict[Side, StandingLeg]:
    """Legs as they stand in a walk, lower than in their posture by `crouch` in m, which they may rise again.

    `weight` in N. None for a leg that has not three pitching joints, or a knee without a torque limit.
    """
    data = stood(robot, model)
    limits = _torque_limits(model)
    found: dict[Side, StandingLeg] = {}
    joints = {side: pitching_joints(robot, side, model, data) for side in SIDES}
    body = model.body(robot.torso_body).id
    torso = data.xmat[body].reshape(3, 3)
    apart = math.dist(*(data.xanchor[joints[side][0]][:2] for side in SIDES))
    for side, pitching in joints.items():
        if len(pitching) != 3 or pitching[1] not in limits:
            continue
        site = model.site(robot.legs[side].sole_site).id
        places = (data.xanchor[pitching] - data.site_xpos[site]) @ data.site_xmat[site].reshape(3, 3)
        hip, knee, ankle = places[:, [0, 2]]
        up = hip - ankle
        shank = knee - ankle
        found[side] = StandingLeg(
            thigh=float(np.linalg.norm(hip - knee)),
            shank=float(np.linalg.norm(shank)),
            apart=float(np.linalg.norm(up)) - crouch,
            rise=crouch,
            ankle=float(ankle[0]),
            ahead=float(np.sign(up[1] * shank[0] - up[0] * shank[1])),
            lever=limits[pitching[1]] / weight,
            high=float(ankle[1]),
            aside=0.5 * apart,
            hip=tuple(torso.T @ (data.xanchor[pitching[0]] - data.xpos[body])),
        )
    return found


def _torque_limits(model: mujoco.MjModel) -> dict[int, float]:
    return {
        int(model.actuator_trnid[a, 0]): float(model.actuator_forcerange[a, 1] * abs(model.actuator_gear[a, 0]))
        for a in range(model.nu)
        if model.actuator_forcelimited[a]
    }
