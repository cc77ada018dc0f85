"""Rotations, SO(3): exponential, logarithm, heading, orthonormalisation.

R_a_to_b (3, 3) takes vectors of frame a into frame b. A rotation vector (3,) is the unit axis times the angle in rad.
"""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.base.vectors import matrix, vector
from plantar.kernels.mechanics import rotations

_THREE_HALVES = 1.5 * np.eye(3)  # nature: Newton's iteration for the nearest rotation, R (3 I - R^T R) / 2
# derived: Cosine below which the axis is taken from the rotation's symmetric part: its antisymmetric part vanishes
# there; at -0.9 it is still 0.4 of its largest
_NEAR_HALF_TURN = -0.9


def rotation_from_vector(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) of a vector (3,), axis times angle in rad: exponential map (Rodrigues), exact to rounding."""
    x, y, z = vector.tolist()
    rotation: NDArray[np.float64] = rotations.rotation_of(x, y, z)
    return rotation


def sine_vector(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axis times sine of the angle (3,) of a rotation (3, 3): the logarithm to first order."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = rotation.tolist()
    return vector(0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy))


def vector_from_rotation(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axis times angle (3,) in rad of a rotation (3, 3), of length 0 to pi; of half a turn, one of its two vectors.

    Logarithm map, exact to rounding, by R - R^T = 2 sin a [n]x and, near half a turn, R + R^T - 2 cos a I = 2 (1 - cos
    a) n n^T.
    """
    axis = sine_vector(rotation)
    sine = math.sqrt(float(axis.dot(axis)))
    cosine = 0.5 * (float(np.trace(rotation)) - 1.0)
    if cosine < _NEAR_HALF_TURN:
        outer = 0.5 * (rotation + rotation.T) - cosine * np.eye(3)
        column = outer[:, int(np.argmax(outer.diagonal()))]
        unit = column / math.sqrt(float(column.dot(column)))
        return np.asarray(unit * math.copysign(math.atan2(sine, cosine), float(unit.dot(axis))))
    # nature: floating point: sin a = a up to a^3 / 6, 2e-28
    return axis if sine < 1e-9 else np.asarray(axis * (math.atan2(sine, cosine) / sine))


def rotation_error(wanted: NDArray[np.float64], actual: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the error (3,) of a rotation `actual` (3, 3) from a `wanted` one, both to a common frame, in that frame.

    Along the axis of the shortest turn from `actual` to `wanted`; of length sine of the angle up to a quarter turn, 1
    beyond.
    """
    between = wanted.dot(actual.T)
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = between.tolist()
    if xx + yy + zz >= 1.0:  # up to a quarter turn
        return np.array([0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy)])
    turn = vector_from_rotation(between)
    return np.asarray(turn / math.sqrt(float(turn.dot(turn))))


def heading(rotation: NDArray[np.float64]) -> float:
    """Yaw in rad of a rotation (3, 3) to world: its x axis seen from above."""
    return math.atan2(rotation.item(1, 0), rotation.item(0, 0))


def level_rotation(yaw: float) -> NDArray[np.float64]:
    """Rotation (3, 3) to world from a level frame with a heading in rad."""
    c = math.cos(yaw)
    s = math.sin(yaw)
    return matrix(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)


def rotation_from_angles(yaw: float, pitch: float = 0.0, roll: float = 0.0) -> NDArray[np.float64]:
    """Returns rotation (3, 3) to world by `roll`, then `pitch`, then `yaw` in rad, about fixed axes x, y and z.

    Positive pitch lowers the front, positive roll raises the left.
    """
    cy, sy, cp, sp, cr, sr = (f(a) for a in (yaw, pitch, roll) for f in (math.cos, math.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def orthonormalised(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """One Newton step towards the nearest rotation, R (3 I - R^T R) / 2 (3, 3): an error e becomes 1.5 e^2."""
    return np.asarray(rotation.dot(_THREE_HALVES - 0.5 * rotation.T.dot(rotation)))
