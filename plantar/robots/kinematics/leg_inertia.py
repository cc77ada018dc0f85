"""How much a robot's legs turn and move its CoM as it moves over its feet."""

from typing import cast

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.leg_inertia import LegInertia
from plantar.mechanics.lip import GRAVITY
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot

_MOVED = 1e-4  # m of the CoM, of which the difference is taken
_ITERATIONS = 40
_LARGEST_STEP = 0.15  # rad


def leg_inertia(robot: Robot, legs: LegModel, com_height: float) -> LegInertia:
    """Returns a leg's, the mean forward and aside of a CoM over both feet, which moves the base by 1 / (1 - 2 mu).

    `com_height`: above the soles in m.
    """
    joints = np.array([*robot.posture["left"], *robot.posture["right"]])
    key = ("inertia", robot.torso_body, com_height, joints.tobytes())
    if key not in legs.known:
        legs.known[key] = _found(robot, legs, com_height, joints)
    return cast(LegInertia, legs.known[key])


def _found(robot: Robot, legs: LegModel, com_height: float, joints: NDArray[np.float64]) -> LegInertia:
    stands = legs.posture(joints)
    legs.set_configuration(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), joints)
    model = legs.model
    data = mujoco.MjData(legs.model)
    ends = []
    for moved in (0.0, _MOVED):  # forward and aside at once: one turns the legs about y, the other about x
        com = np.array([*(stands.com[:2] + moved), stands.positions["left"][2] + com_height])
        legs.follow(com, np.eye(3), stands.positions, stands.rotations, _ITERATIONS, largest_step=_LARGEST_STEP)
        ends.append(legs.configuration)
    x, y, _ = angular_momentum(model, data, _MOVED, *ends)[model.body_rootid[model.body(robot.torso_body).id]].tolist()
    turning = 0.25 * float(y - x) / (legs.mass * GRAVITY)
    forward, aside = (ends[1] - ends[0])[:2].tolist()
    return LegInertia(max(0.0, turning), max(0.0, 0.5 - _MOVED / (forward + aside)))


def angular_momentum(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    every: float,
    before: NDArray[np.float64],
    after: NDArray[np.float64],
    at: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """Returns those (b, 3) in N m s of all bodies' subtrees about their CoMs.

    `every`: time in s between two configurations; `before`: the first (nq,); `after` the second; `at`: that at which
    the motion is looked at; None for the first.
    """
    mujoco.mj_differentiatePos(model, data.qvel, every, before, after)
    data.qpos[:] = before if at is None else at
    for step in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel, mujoco.mj_subtreeVel):
        step(model, data)
    return np.array(data.subtree_angmom)
