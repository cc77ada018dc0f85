"""What a leg's servos move: inertia about each joint while its foot swings, and while its foot carries the robot."""

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
    """Inertia about each joint of a leg in kg m^2, the lesser one of both legs, with the rotor's.

    Attributes:
        swing: Of what a joint turns where the robot floats freely: 1 / (M^-1)_jj.
        stance: Of all that stands on a joint whose foot stands still.
        armature: The rotor's share.
        damping: The joint's own damping in N m s/rad.
    """

    swing: NDArray[np.float64]
    stance: NDArray[np.float64]
    armature: NDArray[np.float64]
    damping: NDArray[np.float64]


def joint_inertia(robot: Robot, model: Any, configuration: NDArray[np.float64]) -> JointInertia:
    """Measure the inertia about the joints of the legs.

    Returns the inertia about each joint.

    Args:
        robot: The robot.
        model: The robot alone as it is simulated, with its shoes.
        configuration: Configuration (nq,) in which it stands.
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
    """Inertia about each joint where the robot floats freely: 1 / (M^-1)_jj.

    Args:
        model: The robot alone as it is simulated.
        configuration: Its configuration (nq,).

    Returns:
        The inertia (nv,) in kg m^2, or kg of what slides.
    """
    return _floating(model, _at(model, configuration))


def _at(model: Any, configuration: NDArray[np.float64]) -> Any:
    """State of a model in a configuration (nq,)."""
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
