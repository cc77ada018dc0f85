"""The posture that a fit begins with: knees bent, soles apart."""

import math
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import RobotError
from plantar.robots.kinematics.body import pitching_joints, stood
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot

_SOLE_GAP = 0.25  # of the sole's width between two soles that stand side by side: h1 has 0.3
# of a knee
_SEED_BEND = math.radians(40.0)
_LEAST_BEND = math.radians(20.0)
_LEAST_AHEAD = math.radians(5.0)  # a posture that is straight but for rounding bends neither way; walks bend by 10

Array = NDArray[np.float64]


def bent_posture(robot: Robot, legs: LegModel, ahead: bool = False) -> dict[Side, tuple[float, ...]]:
    """Returns joint angles in rad of a `robot`'s `legs` with knees bent by 40 degrees, within their limits.

    `ahead`: whether knees bend the shank ahead, as a bird's do.

    Raises:
        RobotError: If the legs do not bend so.
    """
    model = legs.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    across = data.xmat[model.body(robot.torso_body).id].reshape(3, 3)[:, 1]
    posture: dict[Side, tuple[float, ...]] = {}
    for side in SIDES:
        ids = [model.joint(n).id for n in robot.legs[side].joints]
        pitch = [ids.index(i) for i in pitching_joints(robot, side, model, data)]
        if len(pitch) < 3:
            raise RobotError(
                f"robot '{robot.name}': the {side} leg has {len(pitch)} joints that pitch; allowed: hip, knee and ankle"
            )
        bend = _SEED_BEND
        if ahead:
            bend = -_SEED_BEND - _knee_bend(data, [ids[k] for k in pitch], across)  # most are drawn with bent legs
        found = _bent(model, data, np.array(ids), pitch, across, bend)
        if found is None:
            name = robot.legs[side].joints[pitch[-2]]
            low, high = np.degrees(model.jnt_range[ids[pitch[-2]]]).tolist()
            raise RobotError(
                f"robot '{robot.name}': knee '{name}', from {low:.0f} to {high:.0f} degrees, does not bend the shank "
                f"back by {math.degrees(_LEAST_BEND):.0f} degrees; allowed: knees that do: turn its axis round"
            )
        posture[side] = tuple(found.tolist())
    return posture


def knees_ahead(robot: Robot, model: mujoco.MjModel) -> bool:
    """Returns whether the left knee of a `robot` bends the shank ahead in its posture, as a bird's does."""
    data = stood(robot, model)
    across = data.xmat[model.body(robot.torso_body).id].reshape(3, 3)[:, 1]
    pitch = pitching_joints(robot, "left", model, data)
    return len(pitch) >= 3 and _knee_bend(data, pitch, across) < -_LEAST_AHEAD


def _knee_bend(data: mujoco.MjData, pitch: list[int], across: Array) -> float:
    """Angle in rad from thigh to shank about the robot's left, `across` (3,): positive where the shank is behind.

    `pitch`: ids of a leg's pitching joints from hip to ankle.
    """
    hip, knee, ankle = (data.xanchor[pitch[k]] for k in (0, -2, -1))
    axis = data.xaxis[pitch[-2]] * math.copysign(1.0, float(data.xaxis[pitch[-2]] @ across))
    thigh, shank = (way - (way @ axis) * axis for way in (knee - hip, ankle - knee))
    return math.atan2(float(np.cross(thigh, shank) @ axis), float(thigh @ shank))


def _bent(model: Any, data: Any, leg: Any, pitch: list[int], across: Array, bend: float) -> Array | None:
    """Angles (k,) in rad of a `leg` with its knees turned by `bend` in rad; None where the knee's limits forbid it."""
    angles: Array = model.qpos0[model.jnt_qposadr[leg]].copy()
    knees = pitch[1:-1]  # where two links roll on each other there are two, which bend alike
    for k, part in ((pitch[0], -0.5), *((k, 1.0 / len(knees)) for k in knees), (pitch[-1], -0.5)):
        angles[k] += part * bend * math.copysign(1.0, float(data.xaxis[leg[k]] @ across))
    wanted = angles[pitch[-2]]
    for k, joint in enumerate(leg):
        if model.jnt_limited[joint]:
            angles[k] = np.clip(angles[k], *model.jnt_range[joint])
    return angles if abs(angles[pitch[-2]] - wanted) <= _SEED_BEND - _LEAST_BEND else None


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
