"""How far from its ankle a foot carries the robot, by torque limits."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.robots.kinematics.body import pitching_joints, rolling_joints, stood
from plantar.robots.robot import Robot


def ankle_limits(
    robot: Robot, model: mujoco.MjModel, weight: float, crouch: float = 0.0
) -> dict[Side, NDArray[np.float64]]:
    """Where weight may act on each sole in single support, by torque limits.

    The weight W e_z at p has the torque a . ((p - c) x W e_z) on a joint with axis a through c: a strip of the sole for
    each joint. The ankle's joints are the last that pitches and the last that rolls.

    `weight` in N; `crouch`: how much lower in m than in its posture it walks. Returns strips (m, 5) in each sole's
    frame: unit normal (x, y), the strip's middle and half width along it in m, and the ankle's height in m, by which a
    sloping sole moves it; none without limits.
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
        if len(pitching) == 3 and pitching[1] in limits:
            places = (data.xanchor[pitching] - origin) @ rotation
            strips.append(_knee_strip(places[:, [0, 2]], limits[pitching[1]] / weight, crouch))
        found[side] = np.array(strips).reshape(-1, 5)
    return found


def _knee_strip(places: NDArray[np.float64], reach: float, crouch: float) -> list[float]:
    """Strip across the sole in which the knee's lever is at most `reach` in m.

    With the hip above p and the ankle at a the knee is a share s of the way from a to p, and k ahead of that line: |p -
    (a + s (p - a) + k)| <= r. `places` (3, 2) are hip, knee and ankle in m.
    """
    hip, knee, ankle = places
    up = places[0] - places[2]
    thigh = float(np.linalg.norm(hip - knee))
    shank = float(np.linalg.norm(knee - ankle))
    apart = max(float(np.linalg.norm(up)) - crouch, 1e-6)
    foot = (apart**2 + shank**2 - thigh**2) / (2.0 * apart)  # of the triangle's height, from the ankle
    share = foot / apart
    ahead = np.sqrt(max(shank**2 - foot**2, 0.0))
    side = np.sign(up[1] * (knee - ankle)[0] - up[0] * (knee - ankle)[1])
    return [1.0, 0.0, float(ankle[0] + side * ahead / (1.0 - share)), reach / (1.0 - share), float(ankle[1])]


def _torque_limits(model: mujoco.MjModel) -> dict[int, float]:
    return {
        int(model.actuator_trnid[a, 0]): float(model.actuator_forcerange[a, 1] * abs(model.actuator_gear[a, 0]))
        for a in range(model.nu)
        if model.actuator_forcelimited[a]
    }
