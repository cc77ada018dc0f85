"""The posture of a robot before its walk."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import RobotError, SceneError
from plantar.gait.plan.footsteps import Footstep
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.rotation import level_rotation
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import Robot


def solve_standing(
    robot: Robot,
    legs: LegModel,
    feet: Mapping[Side, Footstep],
    centers: Mapping[Side, NDArray[np.float64]],
    com_height: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stand on given footholds, CoM midway between the soles' centers.

    `legs`: its kinematics, which start from this posture afterwards; `centers`: point (2,) of each sole in the world in
    m that carries half the weight; `com_height`: above the soles in m. Returns joint angles (k,) in rad, and torques
    (k,) in N m that hold them.
    """
    posture = posture_of(robot, legs)
    ground = float(np.mean([feet[s].z for s in SIDES]))
    middle = np.mean([centers[s] for s in SIDES], axis=0)
    com = np.array([middle[0], middle[1], ground + com_height])
    yaw = feet["left"].yaw
    legs.set_configuration(com, np.array([np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)]), posture)
    error = legs.follow(
        com,
        level_rotation(yaw),
        {s: feet[s].position for s in SIDES},
        {s: feet[s].rotation_sole_to_world for s in SIDES},
        iterations=50,
    )
    if not error < 1e-6:
        raise SceneError(
            f"robot '{robot.name}' cannot stand with its CoM at {com_height:.3f} m and feet "
            f"{np.hypot(feet['left'].x - feet['right'].x, feet['left'].y - feet['right'].y):.3f} m apart; "
            "allowed: what the legs reach from [posture] (degrees), within their joints' limits"
        )
    half = np.array([0.0, 0.0, 0.5 * legs.mass * GRAVITY])
    legs.carry(dict.fromkeys(SIDES, half), {s: np.array([*centers[s], ground]) for s in SIDES})
    return legs.joints.copy(), legs.torques.copy()


def posture_of(robot: Robot, legs: LegModel) -> NDArray[np.float64]:
    """Returns the posture (k,) in rad of a `robot`'s `legs`; RobotError: feet swapped."""
    posture = np.array([*robot.posture["left"], *robot.posture["right"]])
    stands = legs.posture(posture).positions
    if not stands["left"][1] > stands["right"][1]:
        raise RobotError(
            f"robot '{robot.name}': the foot of [legs.left] is to the right of [legs.right]'s in [posture]; "
            "x points forward, y to the left"
        )
    return posture
