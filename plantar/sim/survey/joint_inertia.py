"""Inertia about each joint of a leg while its foot swings, and while its foot carries the robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.robots.kinematics.body import hanging_on
from plantar.robots.robot import Robot
from plantar.sides import SIDES

__all__ = ["JointInertia", "floating_inertia", "joint_inertia"]


@dataclass(frozen=True)
class JointInertia:
    """Inertia about each joint of a leg in kg m^2, the lesser of both legs, with the rotor's.

    Attributes:
        swing: With the robot floating freely: 1 / (M^-1)_jj.
        stance: Of all above a joint whose foot stands still.
        armature: The rotor's share.
        damping: The joint's own in N m s/rad.
    """

    swing: NDArray[np.float64]
    stance: NDArray[np.float64]
    armature: NDArray[np.float64]
    damping: NDArray[np.float64]


def joint_inertia(robot: Robot, model: Any, configuration: NDArray[np.float64]) -> JointInertia:
    """Returns the inertia about the legs' joints of a `robot` in a `configuration` (nq,) of its `model` alone, with
    shoes.
    """
    data = _at(model, configuration)
    free = _floating(model, data)
    found = []
    for side in SIDES:
        joints = [model.joint(name).id for name in robot.legs[side].joints]
        dofs = model.jnt_dofadr[joints]
        standing = np.array([_above(model, data, joint) for joint in joints]) + model.dof_armature[dofs]
        found.append((free[dofs], standing, model.dof_armature[dofs], model.dof_damping[dofs]))
    swing, stance, armature, damping = (np.minimum(a, b) for a, b in zip(*found, strict=True))
    return JointInertia(swing, stance, armature, damping)


def floating_inertia(model: Any, configuration: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the inertia (nv,) in kg m^2, or kg, of a `model` that floats freely in a `configuration` (nq,): 1 /
    (M^-1)_jj.
    """
    return _floating(model, _at(model, configuration))


def _at(model: Any, configuration: NDArray[np.float64]) -> Any:
    data = mujoco.MjData(model)
    data.qpos[:] = configuration
    mujoco.mj_forward(model, data)
    return data


def _floating(model: Any, data: Any) -> NDArray[np.float64]:
    whole = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, whole)
    return np.asarray(1.0 / np.diag(np.linalg.inv(whole)))


def _above(model: Any, data: Any, joint: int) -> float:
    """Inertia in kg m^2 about a joint's axis of all bodies that do not hang on it."""
    axis, anchor = data.xaxis[joint], data.xanchor[joint]
    hanging = set(hanging_on(model, int(model.jnt_bodyid[joint])))
    total = 0.0
    for body in range(1, model.nbody):
        if body in hanging:
            continue
        rotation = data.ximat[body].reshape(3, 3)
        along = rotation.T @ axis
        arm = np.cross(axis, data.xipos[body] - anchor)
        total += float(model.body_inertia[body] @ along**2) + float(model.body_mass[body]) * float(arm @ arm)
    return total
