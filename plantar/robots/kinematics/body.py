"""How large a robot is: the body that its settings are shares of."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from plantar.robots.robot import Robot
from plantar.settings.body_scale import BodyScale
from plantar.sides import SIDES, Side

__all__ = ["body_of", "hanging_on", "leg_length", "pitching_joints", "rolling_joints", "stood"]

_RESOLUTION = 6  # decimals of a leg's length in m: sums of link lengths differ in their last bits
_ALONG = 0.7  # cosine with an axis of the torso from which a joint turns about it: nearer to it than to the others


def body_of(robot: Robot, model: mujoco.MjModel) -> BodyScale:
    """The body that a robot's settings are shares of.

    Returns:
        Its mass as the model has it, the leg's length as `[gait] leg_length` or else the model has it, the left sole's
        size as its layout's outline has it, and its pace as `[gait] pace`.
    """
    _, (half_length, half_width) = robot.sole_rectangle("left")
    return BodyScale(
        mass=float(model.body_subtreemass[model.body_rootid[model.body(robot.torso_body).id]]),
        leg=robot.leg_length or leg_length(robot, model),
        sole=2.0 * half_length,
        sole_width=2.0 * half_width,
        pace_beats=robot.pace,
    )


def leg_length(robot: Robot, model: mujoco.MjModel) -> float:
    """Length of a straight leg from hip to ankle, as the mean of both.

    It is summed over the joints that pitch, which are hip, knee and ankle of a leg, in the plane in which they bend it;
    their order and distance do not change with the posture. A leg with fewer than two of them counts from its first to
    its last joint.

    Args:
        robot: The robot, which names which joints the legs have, and how it stands.
        model: A model with the robot in it.

    Returns:
        The length in m.
    """
    data = stood(robot, model)
    return round(float(np.mean([_length(robot, side, model, data) for side in SIDES])), _RESOLUTION)


def hanging_on(model: Any, body: int) -> list[int]:
    """A body and all that hang on it, in the model's order, in which none comes before what it hangs on.

    Returns numbers of the bodies.
    """
    found = [body]
    for part in range(body + 1, model.nbody):
        if int(model.body_parentid[part]) in found:
            found.append(part)
    return found


def stood(robot: Robot, model: mujoco.MjModel) -> mujoco.MjData:
    """State of a model whose legs are in the robot's posture, with kinematics.

    Returns the state.
    """
    data = mujoco.MjData(model)
    for side in SIDES:
        for name, angle in zip(robot.legs[side].joints, robot.posture[side], strict=True):
            data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    return data


def pitching_joints(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData) -> list[int]:
    """Joints of a leg that turn about the torso's y axis more than about another: hip, knee and ankle.

    Takes `robot`, `side`, `model` and `data`; returns their ids from hip to ankle.
    """
    return _turning_joints(robot, side, model, data, 1)


def rolling_joints(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData) -> list[int]:
    """Joints of a leg that turn about the torso's x axis more than about another: hip and, if there is one, ankle.

    Takes `robot`, `side`, `model` and `data`; returns their ids from hip to ankle.
    """
    return _turning_joints(robot, side, model, data, 0)


def _turning_joints(robot: Robot, side: Side, model: mujoco.MjModel, data: mujoco.MjData, axis: int) -> list[int]:
    """Ids of a leg's joints, from hip to foot, that turn about an axis of the torso."""
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
