"""How much a robot's legs turn about its CoM as it moves over its feet."""

import mujoco
import numpy as np

from plantar.mechanics.lip import GRAVITY
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot

__all__ = ["leg_inertia"]

_MOVED = 1e-4  # m of the CoM, of which the difference is taken
_ITERATIONS = 40
_LARGEST_STEP = 0.15  # rad


def leg_inertia(robot: Robot, legs: LegModel, com_height: float) -> float:
    """Returns D in s^2, the mean forward and aside of a CoM over both feet (`plantar.gait.plan.leg_momentum`).

    Args:
        robot: The robot.
        legs: Its kinematics, left in that posture.
        com_height: Above the soles in m.
    """
    joints = np.array([*robot.posture["left"], *robot.posture["right"]])
    stands = legs.posture(joints)
    legs.set_configuration(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), joints)
    model, data = legs.model, mujoco.MjData(legs.model)
    root, found = int(model.body_rootid[model.body(robot.torso_body).id]), []
    for axis, turned, sign in ((0, 1, 1.0), (1, 0, -1.0)):
        ends = []
        for moved in (0.0, _MOVED):
            com = np.array([*stands.com[:2], stands.positions["left"][2] + com_height])
            com[axis] += moved
            legs.follow(com, np.eye(3), stands.positions, stands.rotations, _ITERATIONS, largest_step=_LARGEST_STEP)
            ends.append(legs.configuration)
        mujoco.mj_differentiatePos(model, data.qvel, _MOVED, *ends)
        data.qpos[:] = ends[0]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)
        found.append(sign * data.subtree_angmom[root, turned].item())
    return max(0.0, 0.5 * float(np.mean(found)) / (legs.mass * GRAVITY))
