"""Size of a robot, for settings that are shares of it."""

from typing import Any

import mujoco
import numpy as np

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.robots.robot import Robot

_RESOLUTION = 6  # decimals of a leg's length in m: sums of link lengths differ in their last bits
_ALONG = 0.7  # cosine with an axis of the torso from which a joint turns about it: nearer to it than to the others


def body_of(robot: Robot, model: mujoco.MjModel) -> BodyScale:
    """Size of a robot; Returns mass by the model, leg by `[gait] leg_length` or model, sole by the layout, pace."""
    _, (half_length, half_width) = robot.sole_rectangle("left")
    return BodyScale(
        mass=float(model.body_subtreemass[model.body_rootid[model.body(robot.torso_body).id]]),
        leg=robot.leg_length or leg_length(robot, model),
        sole=2.0 * half_length,
        sole_width=2.0 * half_width,
        pace_beats=robot.pace,
    )


def leg_length(robot: Robot, model: mujoco.MjModel) -> float:
    """Length in m of a straight leg, hip to ankle, both's mean.

    Summed over the pitching joints in the plane in which they bend the leg, independent of posture; with fewer than
    two, from first to last joint. Returns the length.
    """
    data = stood(robot, model)
    return round(float(np.mean([_length(robot, side, model, data) for side in SIDES])), _RESOLUTION)


def hanging_on(model: Any, body: int) -> list[int]:
    """Returns ids of a body and its descendants, in the model's order."""
    found = [body]
    for part in range(body + 1, model.nbody):
        if int(model.body_parentid[part]) in found:
            found.append(part)
    return found


def stood(robot: Robot, model: mujoco.MjModel) -> mujoco.MjData:
    """Returns data of a model with legs in the robot's posture."""
    data = mujoco.MjData(model)
    for side in SIDES:
        for name, angle in zip(robot.legs[side].joints, robot.posture[side], strict=True):
            data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    return data


def pitching_joints(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData) -> list[int]:
    """Joints of a leg that turn mostly about the torso's y axis.

    Takes `robot`, `side`, `model` and `data`; returns their ids from hip to ankle.
    """
    return _turning_joints(robot, side, model, data, 1)


def rolling_joints(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData) -> list[int]:
    """Joints of a leg that turn mostly about the torso's x axis.

    Takes `robot`, `side`, `model` and `data`; returns their ids from hip to ankle.
    """
    return _turning_joints(robot, side, model, data, 0)


def _turning_joints(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData, axis: int) -> list[int]:
    """Leg joints, hip to foot, that turn about an axis of the torso."""
    way = data.xmat[model.body(robot.torso_body).id].reshape(3, 3)[:, axis]
    ids = [int(model.joint(name).id) for name in robot.legs[side].joints]
    return [i for i in ids if abs(float(data.xaxis[i] @ way)) > _ALONG]


def _length(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData) -> float:
    pitching = pitching_joints(robot, side, model, data)
    if len(pitching) < 2:
        ids = [model.joint(name).id for name in robot.legs[side].joints]
        return float(np.linalg.norm(data.xanchor[ids[-1]] - data.xanchor[ids[0]]))
    links = np.diff(data.xanchor[pitching], axis=0)
    axes = data.xaxis[pitching[:-1]]
    links -= (links * axes).sum(axis=1)[:, None] * axes
    return float(np.linalg.norm(links, axis=1).sum())
