"""The posture that a fit begins with: knees bent, soles apart."""

import math

import mujoco
import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.errors import RobotError
from plantar.robots.kinematics.body import pitching_joints
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot

_SOLE_GAP = 0.25  # of the sole's width between two soles that stand side by side: h1 has 0.3
# of a knee
_SEED_BEND = math.radians(40.0)
_LEAST_BEND = math.radians(20.0)


def bent_posture(robot: Robot, legs: LegModel) -> dict[Side, tuple[float, ...]]:
    """Returns joint angles in rad of a `robot`'s `legs` with knees bent by 40 degrees, within their limits."""
    model = legs.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    across = data.xmat[model.body(robot.torso_body).id].reshape(3, 3)[:, 1]
    posture: dict[Side, tuple[float, ...]] = {}
    for side in SIDES:
        ids = [model.joint(n).id for n in robot.legs[side].joints]
        angles = model.qpos0[model.jnt_qposadr[ids]].copy()
        pitch = [ids.index(i) for i in pitching_joints(robot, side, model, data)]
        if len(pitch) < 3:
            raise RobotError(
                f"robot '{robot.name}': the {side} leg has {len(pitch)} joints that pitch; allowed: hip, knee and ankle"
            )
        for k, part in ((pitch[0], -0.5), (pitch[-2], 1.0), (pitch[-1], -0.5)):
            angles[k] += part * _SEED_BEND * math.copysign(1.0, float(data.xaxis[ids[k]] @ across))
        knee = pitch[-2]
        wanted = angles[pitch[-2]]
        for k, i in enumerate(ids):
            if model.jnt_limited[i]:
                angles[k] = np.clip(angles[k], *model.jnt_range[i])
        if abs(angles[knee] - wanted) > _SEED_BEND - _LEAST_BEND:
            name = robot.legs[side].joints[knee]
            low, high = np.degrees(model.jnt_range[ids[knee]]).tolist()
            raise RobotError(
                f"robot '{robot.name}': knee '{name}', from {low:.0f} to {high:.0f} degrees, does not bend the shank "
                f"back by {math.degrees(_LEAST_BEND):.0f} degrees; allowed: knees that do: turn its axis round"
            )
        posture[side] = tuple(angles.tolist())
    return posture


def stance_width(robot: Robot, legs: LegModel) -> float:
    """Returns the distance in m of a `robot`'s feet: as in the model of its `legs`, or wider for the soles."""
    feet = legs.posture(np.array([*robot.posture["left"], *robot.posture["right"]])).positions
    return round(max(float(feet["left"][1] - feet["right"][1]), least_stance(robot)), 3)


def least_stance(robot: Robot) -> float:
    """Least distance in m of a `robot`'s feet, by their soles."""
    across = robot.layouts["left"].outline[:, 1]
    return -2.0 * float(across.min()) + _SOLE_GAP * float(np.ptp(across))


def posture_height(robot: Robot, legs: LegModel) -> float:
    """Returns the height in m of the CoM above the soles of a `robot`'s `legs` in its posture."""
    posture = legs.posture(np.array([*robot.posture["left"], *robot.posture["right"]]))
    return float(posture.com[2] - np.mean([posture.positions[s][2] for s in SIDES]))
