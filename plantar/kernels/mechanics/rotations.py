"""Rotations: products of matrices (3, 3) and vectors (3,), exponential map, nearest rotation, errors."""

import math

from ..base import vectors

__all__ = [
    "between",
    "exponential",
    "missing_pose",
    "missing_turn",
    "multiply",
    "orthonormalise",
    "rotation_of",
    "turn",
    "turn_back",
]

# nature: Angle in rad below which sin a / a and (1 - cos a) / a^2 are 1 and 1/2: what is left out is a^2 / 24 of terms
# of size a^2, 4e-26.
_SMALL = 1e-6


def turn(rotation, vector, out):
    """Rotate a vector (3,) by a rotation (3, 3) into `out`, another array: R v."""
    for i in range(3):
        out[i] = rotation[i, 0] * vector[0] + rotation[i, 1] * vector[1] + rotation[i, 2] * vector[2]


def turn_back(rotation, vector, out):
    """Rotate a vector back: R^T v."""
    for i in range(3):
        out[i] = rotation[0, i] * vector[0] + rotation[1, i] * vector[1] + rotation[2, i] * vector[2]


def multiply(a, b, out):
    """Product A B of two matrices (3, 3) into `out`, another array."""
    for i in range(3):
        for j in range(3):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]


def between(a, b):
    """A B^T, nine numbers row by row: for rotations to one frame, from B's frame to A's."""
    xx = 0.0
    xy = 0.0
    xz = 0.0
    yx = 0.0
    yy = 0.0
    yz = 0.0
    zx = 0.0
    zy = 0.0
    zz = 0.0
    for k in range(3):
        xx += a[0, k] * b[0, k]
        xy += a[0, k] * b[1, k]
        xz += a[0, k] * b[2, k]
        yx += a[1, k] * b[0, k]
        yy += a[1, k] * b[1, k]
        yz += a[1, k] * b[2, k]
        zx += a[2, k] * b[0, k]
        zy += a[2, k] * b[1, k]
        zz += a[2, k] * b[2, k]
    return xx, xy, xz, yx, yy, yz, zx, zy, zz


def exponential(x, y, z, out):
    """Rotation (3, 3) of a rotation vector x, y, z in rad into `out` (Rodrigues), exact to rounding."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = _exponential(x, y, z)
    out[0, 0] = xx
    out[0, 1] = xy
    out[0, 2] = xz
    out[1, 0] = yx
    out[1, 1] = yy
    out[1, 2] = yz
    out[2, 0] = zx
    out[2, 1] = zy
    out[2, 2] = zz


def rotation_of(x, y, z):
    """Same as a new array (3, 3)."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = _exponential(x, y, z)
    return vectors.matrix(xx, xy, xz, yx, yy, yz, zx, zy, zz)


def _exponential(x, y, z):
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < _SMALL:
        s = 1.0
        c = 0.5
    else:
        s = math.sin(angle) / angle
        c = (1.0 - math.cos(angle)) / (angle * angle)
    xx = c * x * x
    yy = c * y * y
    zz = c * z * z
    xy = c * x * y
    xz = c * x * z
    yz = c * y * z
    x = s * x
    y = s * y
    z = s * z
    return 1.0 - yy - zz, xy - z, xz + y, xy + z, 1.0 - xx - zz, yz - x, xz - y, yz + x, 1.0 - xx - yy


def orthonormalise(rotation, work, out):
    """One Newton step towards the nearest rotation, R (3 I - R^T R) / 2, into `out`, with `work` (3, 3)."""
    for i in range(3):
        for j in range(3):
            total = rotation[0, i] * rotation[0, j] + rotation[1, i] * rotation[1, j] + rotation[2, i] * rotation[2, j]
            # nature: a step of Newton's iteration, R (3 I - R^T R) / 2
            work[i, j] = (1.5 if i == j else 0.0) - 0.5 * total
    multiply(rotation, work, out)


def missing_turn(wanted, actual, out):
    """`plantar.mechanics.rotation.rotation_error` of `wanted` and `actual` (3, 3) into `out` (3,).

    Returns whether it is at most a quarter turn; beyond, the error is wrong.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz = between(wanted, actual)
    out[0] = 0.5 * (zy - yz)
    out[1] = 0.5 * (xz - zx)
    out[2] = 0.5 * (yx - xy)
    return xx + yy + zz >= 1.0


def missing_pose(position, rotation, at, turned, out):
    """Missing way (3,) in m and turn (3,) from `at` and `turned` to `position` and `rotation`; returns as
    `missing_turn`.
    """
    for i in range(3):
        out[i] = position[i] - at[i]
    return missing_turn(rotation, turned, out[3:])
