"""The true robot: mass, CoM, servo stiffness, joint friction; the controller's model stays nominal."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.mujoco.quaternions import quaternion_of, rotation_of
from plantar.sim.plant.draw import TruePlant
from plantar.sim.plant.ground import make_ground_true


def make_true(
    model: Any,
    plant: TruePlant,
    torso: int,
    servos: NDArray[np.int64],
    touching: Sequence[str],
    body: BodyScale,
) -> None:
    """Change a compiled world `model` in place into the true `plant`.

    By the `torso`'s id, `servos` of the legs' actuators, names of geoms `touching`, soles and ground, and the size by
    the robot's file, `body`.
    """
    load = plant.load * float(model.body_mass[model.body_rootid == model.body_rootid[torso]].sum())
    _scale_mass(model, plant.mass_ratio, torso)
    _move_com(model, plant.com_offset, torso)
    _carry(model, load, plant.load_place, torso)
    model.actuator_gainprm[servos, 0] *= plant.stiffness_ratio
    model.actuator_biasprm[servos, 1] *= plant.stiffness_ratio
    joints = model.jnt_dofadr[model.actuator_trnid[servos, 0]]
    model.dof_frictionloss[joints] += plant.joint_friction
    model.dof_damping[joints] += plant.joint_damping
    make_ground_true(model, plant, [model.geom(name).id for name in touching], body)
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _scale_mass(model: Any, ratio: float, torso: int) -> None:
    robot = model.body_rootid == model.body_rootid[torso]
    model.body_mass[robot] *= ratio
    model.body_inertia[robot] *= ratio


def _move_com(model: Any, offset: NDArray[np.float64], torso: int) -> None:
    """Move the CoM of all that is fixed to the torso."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    moved = data.xmat[torso].reshape(3, 3) @ offset
    for body in np.flatnonzero(model.body_weldid == model.body_weldid[torso]):
        model.body_ipos[body] += data.xmat[body].reshape(3, 3).T @ moved


def _carry(model: Any, load: float, place: NDArray[np.float64], torso: int) -> None:
    """Add a point mass `load` in kg to the torso, at `place` (3,) in m from its CoM."""
    if not load:
        return
    mass = float(model.body_mass[torso])
    axes = rotation_of(model.body_iquat[torso])
    reduced = mass * load / (mass + load)
    inertia = (axes * model.body_inertia[torso]) @ axes.T + reduced * (
        place @ place * np.eye(3) - np.outer(place, place)
    )
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 0] *= np.linalg.det(axes)
    model.body_iquat[torso] = quaternion_of(axes)
    model.body_inertia[torso] = moments
    model.body_ipos[torso] += load / (mass + load) * place
    model.body_mass[torso] = mass + load
