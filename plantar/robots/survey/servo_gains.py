"""Inertia about each leg joint, and servo gains."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES
from plantar.robots.kinematics.body import hanging_on
from plantar.robots.robot import Robot


@dataclass(frozen=True)
class JointInertia:
    """Inertia about each leg joint in kg m^2, the lesser leg's, with rotor.

    `swing`: robot floating freely: 1 / (M^-1)_jj; `stance` of all above a joint whose foot stands still; `armature`:
    the rotor's share; `damping`: the joint's own in N m s/rad.
    """

    swing: NDArray[np.float64]
    stance: NDArray[np.float64]
    armature: NDArray[np.float64]
    damping: NDArray[np.float64]


def joint_inertia(robot: Robot, model: Any, configuration: NDArray[np.float64]) -> JointInertia:
    """Returns leg joint inertia of a `robot` in a `configuration` (nq,) of its `model`, with shoes."""
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
    """Returns the inertia (nv,) in kg m^2, or kg, of a floating `model` in a `configuration` (nq,): 1 / (M^-1)_jj."""
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
    """Inertia in kg m^2 about a joint's axis of all bodies above it."""
    axis = data.xaxis[joint]
    anchor = data.xanchor[joint]
    hanging = set(hanging_on(model, int(model.jnt_bodyid[joint])))
    total = 0.0
    for body in range(1, model.nbody):
        if body in hanging:
            continue
        along = data.ximat[body].reshape(3, 3).T @ axis
        arm = np.cross(axis, data.xipos[body] - anchor)
        total += float(model.body_inertia[body] @ along**2) + float(model.body_mass[body]) * float(arm @ arm)
    return total


STIFFNESS = 12.0
"""Stiffness of a joint over m g h, which is the least at which two ankles of half of it each hold the pendulum up."""

LEAST_STIFFNESS = 3.0
"""The same at which a robot on one foot still stands with a third of it to spare."""

SAMPLED = 1.5
"""Phase in rad by which a joint swings on its servo in a control period at most; h1's ankle does so by 1.46."""

CHATTERS = 2.0
"""The same from which a servo chatters: a third of a turn, which answers steps with blows."""

DAMPED = 0.4
"""Damping over critical below which a joint rings on after each landing."""

_LEAD = 0.076  # damping over stiffness, in beats of the leg; h1 has 0.01875 s
# Error in rad at which a servo may reach its torque limit: with 0.003 Romeo's hips turned it by 4 degrees each way
_SATURATED = 7e-3


def servo_gains(
    inertia: JointInertia,
    mass: float,
    com_height: float,
    beat: float,
    period: float,
    limits: Sequence[float] = (),
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gains of a leg's servos.

    Stiffness is 12 m g h, as of h1, or less: a foot's own swing sqrt(k / I) by 1.5 rad in a control period at most, and
    0.007 rad take all torque at most. Damping is critical for the swing, or as of h1 if more, less the joint's own.

    `mass` in kg; `com_height` in m; `beat`: time scale sqrt(leg / g) in s; `period`: control period in s; `limits`:
    torque limits in N m, or empty. Returns stiffness in N m/rad and damping in N m s/rad of each joint, of two digits.
    """
    wanted = STIFFNESS * mass * GRAVITY * com_height
    least = LEAST_STIFFNESS * mass * GRAVITY * com_height
    most = np.minimum(wanted, np.array(limits) / _SATURATED) if limits else wanted
    stiffness = np.clip(np.minimum(inertia.swing * (SAMPLED / period) ** 2, most), least, wanted)
    damping = np.maximum(2.0 * np.sqrt(stiffness * inertia.swing), _LEAD * beat * stiffness)
    damping = np.maximum(damping - inertia.damping, 0.02 * damping)
    return _two_digits(stiffness), _two_digits(damping)


def rotor_inertia(inertia: JointInertia, mass: float, com_height: float, period: float) -> NDArray[np.float64]:
    """Rotor inertia to assume where none is stated and a joint is too light for its servo.

    With it a bare foot on a servo of `STIFFNESS` swings by `SAMPLED` in a control period: 0.07 kg m^2 about the ankles
    of JVRC-1, 0.02 about iCub's. On softer ankles a robot sways at its steps' pace, and the swinging leg rocks it.

    `mass` in kg; `com_height` in m; `period`: control period in s. Returns inertia in kg m^2 to add about each joint,
    of two digits; 0 if none is missing.
    """
    wanted = STIFFNESS * mass * GRAVITY * com_height
    missing = wanted * (period / SAMPLED) ** 2 - inertia.swing
    return _two_digits(np.where(inertia.armature > 0.0, 0.0, np.maximum(missing, 0.0)))


def _two_digits(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array([float(f"{v:.2g}") for v in values])
