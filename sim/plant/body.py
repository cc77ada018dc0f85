"""The true robot and ground in the simulator: mass and where it is, stiffness of the servos, friction and softness.

What is changed is the compiled model of the world. The controller has a model of its own (`sim.model.leg_model`), which
stays the nominal one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim.plant.draw import TruePlant

__all__ = ["make_true"]


def make_true(model: Any, plant: TruePlant, torso: int, servos: NDArray[np.int64], touching: Sequence[str]) -> None:
    """Change a compiled model into that of the true plant.

    Args:
        model: The MjModel of the world, which is changed.
        plant: The true plant.
        torso: Body id of the torso.
        servos: Indices of the legs' actuators.
        touching: Names of the geoms of soles and ground.
    """
    _scale_mass(model, plant.mass_ratio, torso)
    _move_com(model, plant.com_offset, torso)
    model.actuator_gainprm[servos, 0] *= plant.stiffness_ratio
    model.actuator_biasprm[servos, 1] *= plant.stiffness_ratio
    model.dof_frictionloss[model.jnt_dofadr[model.actuator_trnid[servos, 0]]] += plant.joint_friction
    contacts = [model.geom(name).id for name in touching]
    model.geom_friction[contacts, 0] *= plant.friction_ratio
    model.geom_solref[contacts, 0] = np.hypot(model.geom_solref[contacts, 0], plant.softness)
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _scale_mass(model: Any, ratio: float, torso: int) -> None:
    robot = model.body_rootid == model.body_rootid[torso]
    model.body_mass[robot] *= ratio
    model.body_inertia[robot] *= ratio


def _move_com(model: Any, offset: NDArray[np.float64], torso: int) -> None:
    """Move the centres of mass of all bodies that are fixed to the torso, and with them that of the whole."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    moved = data.xmat[torso].reshape(3, 3) @ offset
    for body in np.flatnonzero(model.body_weldid == model.body_weldid[torso]):
        model.body_ipos[body] += data.xmat[body].reshape(3, 3).T @ moved
