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

_STEP = 1e-4  # rad of a joint over which its effect on the soles is differenced; their motion is nearly linear
_ITERATIONS = 3  # Gauss-Newton steps; offsets of a degree are found to 1e-9 rad by the second one


class _Posture(Protocol):
    @property
    def positions(self) -> Mapping[Side, NDArray[np.float64]]: ...

    @property
    def rotations(self) -> Mapping[Side, NDArray[np.float64]]: ...


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
) -> NDArray[np.float64]:
    """Most probable reading less true angle (k,) in rad.

    `kinematics`: maps joint positions (k,) in rad to each sole's position (3,) in m and rotation (3, 3), base frame;
    `joint_positions`: mean encoders (k,) in rad; `up`: unit vector (3,) against gravity, base frame; `feet`: soles: x,
    y, z in m and heading in rad.
    """
    k = len(joint_positions)
    offsets = np.zeros(k)
    rotation, position = standing_base(kinematics(joint_positions), up, feet)
    for _ in range(_ITERATIONS):
        posture, moved, turned = _differenced(kinematics, joint_positions - offsets)
        rows: list[NDArray[np.float64]] = []
        errors: list[NDArray[np.float64]] = []
        for side in SIDES:
            x, y, z, yaw = feet[side]
            arm = rotation @ posture.positions[side]
            rows.append(np.hstack([-rotation @ moved[side], -_cross(arm), np.eye(3)]) / tolerances.place)
            rows.append(np.hstack([-rotation @ turned[side], np.eye(3), np.zeros((3, 3))]) / tolerances.turn)
            lean = sine_vector(rotation @ posture.rotations[side] @ level_rotation(yaw).T)
            errors += [(position + arm - np.array([x, y, z])) / tolerances.place, lean / tolerances.turn]
        above = rotation @ up
        rows.append(np.hstack([np.zeros((2, k)), -_cross(above)[:2], np.zeros((2, 3))]) / tolerances.turn)
        rows.append(np.hstack([np.eye(k), np.zeros((k, 6))]) / tolerances.offset)
        errors += [above[:2] / tolerances.turn, offsets / tolerances.offset]
        step = np.asarray(np.linalg.lstsq(np.vstack(rows), -np.concatenate(errors), rcond=None)[0], dtype=np.float64)
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


def _differenced(
    kinematics: Callable[[NDArray[np.float64]], _Posture], joints: NDArray[np.float64]
) -> tuple[_Posture, dict[Side, NDArray[np.float64]], dict[Side, NDArray[np.float64]]]:
    """A posture, and each sole's velocity (3, k) and angular velocity (3, k) by joint, base frame."""
    posture = kinematics(joints)
    moved: dict[Side, NDArray[np.float64]] = {side: np.zeros((3, len(joints))) for side in SIDES}
    turned: dict[Side, NDArray[np.float64]] = {side: np.zeros((3, len(joints))) for side in SIDES}
    for i in range(len(joints)):
        bent = joints.copy()
        bent[i] += _STEP
        other = kinematics(bent)
        for side in SIDES:
            moved[side][:, i] = (other.positions[side] - posture.positions[side]) / _STEP
            turned[side][:, i] = sine_vector(other.rotations[side] @ posture.rotations[side].T) / _STEP
    return posture, moved, turned


def _cross(v: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y, z = v.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
