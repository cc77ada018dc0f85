"""Encoder zero errors by two flat feet at known places.

The closed loop through the ground gives six equations, gravity two. The smallest explaining offsets are returned; the
rest appears as a CoM offset (`plantar.gait.estimate.com_offset`).
"""

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.mechanics.rotation import heading, level_rotation, orthonormalised, rotation_from_vector, sine_vector

_STEP = 1e-4  # chosen: rad of a joint over which its effect on the soles is differenced; their motion is nearly linear
_ITERATIONS = 2  # measured: Gauss-Newton steps; offsets of a degree are found to 1e-9 rad by the second one


class _Posture(Protocol):
    @property
    def positions(self) -> Mapping[Side, NDArray[np.float64]]: ...

    @property
    def rotations(self) -> Mapping[Side, NDArray[np.float64]]: ...


SoleMotions = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
"""Maps joint positions (k,) in rad to each sole's velocity in m and angular velocity in rad for a joint that turns by 1
rad, (2, 3, k) both, left sole first, base frame."""


class StandingTolerances(NamedTuple):
    """Standard deviations for a standing robot.

    `offset` of an encoder's zero in rad; `place` of each coordinate of a foot in m; `turn` of a sole's angles to the
    ground, and mean accelerometer direction, in rad.
    """

    offset: float
    place: float
    turn: float


def encoder_offsets(
    kinematics: Callable[[NDArray[np.float64]], _Posture],
    joint_positions: NDArray[np.float64],
    up: NDArray[np.float64],
    feet: Mapping[Side, tuple[float, float, float, float]],
    tolerances: StandingTolerances,
    motions: SoleMotions | None = None,
) -> NDArray[np.float64]:
    """Most probable reading less true angle (k,) in rad.

    `kinematics`: maps joint positions (k,) in rad to each sole's position (3,) in m and rotation (3, 3), base frame;
    `joint_positions`: mean encoders (k,) in rad; `up`: unit vector (3,) against gravity, base frame; `feet`: soles: x,
    y, z in m and heading in rad; `motions`: how the soles move with the joints; None differences the kinematics, at
    one call a joint.
    """
    k = len(joint_positions)
    offsets = np.zeros(k)
    rotation, position = standing_base(kinematics(joint_positions), up, feet)
    for _ in range(_ITERATIONS):
        joints = joint_positions - offsets
        places, turns, moved, turned = (
            _differenced(kinematics, joints) if motions is None else _moving(kinematics, motions, joints)
        )
        rows = np.zeros((14 + k, k + 6))
        errors = np.zeros(14 + k)
        for i, side in enumerate(SIDES):
            x, y, z, yaw = feet[side]
            arm = rotation @ places[i]
            place = slice(6 * i, 6 * i + 3)
            turn = slice(6 * i + 3, 6 * i + 6)
            rows[place, :k] = -rotation @ moved[i]
            rows[turn, :k] = -rotation @ turned[i]
            rows[place, k : k + 3] = -_cross(arm)
            rows[place, k + 3 :] = np.eye(3)
            rows[turn, k : k + 3] = np.eye(3)
            errors[place] = position + arm - (x, y, z)
            errors[turn] = sine_vector(rotation @ turns[i] @ level_rotation(yaw).T)
            rows[place] /= tolerances.place
            errors[place] /= tolerances.place
            rows[turn] /= tolerances.turn
            errors[turn] /= tolerances.turn
        above = rotation @ up
        rows[12:14, k : k + 3] = -_cross(above)[:2] / tolerances.turn
        errors[12:14] = above[:2] / tolerances.turn
        rows[14:, :k] = np.eye(k) / tolerances.offset
        errors[14:] = offsets / tolerances.offset
        # The prior of the offsets and two feet make all columns independent: the normal equations are regular.
        step = np.asarray(np.linalg.solve(rows.T @ rows, -(rows.T @ errors)), dtype=np.float64)
        offsets = offsets + step[:k]
        rotation = orthonormalised(rotation_from_vector(step[k : k + 3]) @ rotation)
        position = position + step[k + 3 :]
    return offsets


def standing_base(
    posture: _Posture, up: NDArray[np.float64], feet: Mapping[Side, tuple[float, float, float, float]]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns base to world (3, 3) and base position (3,) in m: level by gravity, placed by its feet.

    By the `posture`, each sole's position (3,) in m and rotation (3, 3) in the base frame, the unit vector `up` (3,)
    there, and soles `feet`: x, y, z in m and heading in rad.
    """
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    forward /= float(np.linalg.norm(forward))
    level = np.vstack([forward, np.cross(up, forward), up])
    # Mean of two headings as a mean of unit vectors: that of the angles is wrong across +-pi.
    turns = [feet[side][3] - heading(level @ posture.rotations[side]) for side in SIDES]
    rotation = level_rotation(math.atan2(sum(map(math.sin, turns)), sum(map(math.cos, turns)))) @ level
    places = [np.array(feet[side][:3]) - rotation @ posture.positions[side] for side in SIDES]
    return rotation, np.mean(places, axis=0)


def _moving(
    kinematics: Callable[[NDArray[np.float64]], _Posture], motions: SoleMotions, joints: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """As `_differenced`, by the soles' own motions."""
    posture = kinematics(joints)
    places = np.array([posture.positions[side] for side in SIDES])
    turns = np.array([posture.rotations[side] for side in SIDES])
    return places, turns, *motions(joints)


def _differenced(
    kinematics: Callable[[NDArray[np.float64]], _Posture], joints: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Each sole's place (2, 3) and rotation (2, 3, 3), velocity (2, 3, k) and angular velocity (2, 3, k) by joint, base
    frame.
    """
    count = len(joints)
    places = np.zeros((count + 1, 2, 3))
    turns = np.zeros((count + 1, 2, 3, 3))
    for i in range(count + 1):
        bent = joints.copy()
        if i > 0:
            bent[i - 1] += _STEP
        posture = kinematics(bent)
        for j, side in enumerate(SIDES):
            places[i, j] = posture.positions[side]
            turns[i, j] = posture.rotations[side]
    moved = (places[1:] - places[0]) / _STEP
    turn = turns[1:] @ turns[0].transpose(0, 2, 1)
    sine = np.stack(
        [turn[..., 2, 1] - turn[..., 1, 2], turn[..., 0, 2] - turn[..., 2, 0], turn[..., 1, 0] - turn[..., 0, 1]]
    )
    return places[0], turns[0], moved.transpose(1, 2, 0), sine.transpose(2, 0, 1) / (2.0 * _STEP)


def _cross(v: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y, z = v.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
