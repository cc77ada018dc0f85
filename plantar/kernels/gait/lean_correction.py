"""Kernel of `plantar.gait.feet.posture_compensation`: keeps a swing foot in place while the body leans."""

import math

from ..base import fused, memory
from ..mechanics import rotations

__all__ = ["correct", "headed", "turned"]


def headed(rotation, yaw):
    """A rotation (3, 3) to world, turned to a heading in rad (summed as `fused`)."""
    r = memory.values(rotation)
    made = memory.new_matrix(3, 3)
    out = memory.room(made)
    angle = yaw - math.atan2(r[3], r[0])
    c = math.cos(angle)
    s = math.sin(angle)
    for j in range(3):
        x = r[j]
        y = r[3 + j]
        z = r[6 + j]
        out[j] = fused.multiply_add(0.0, z, fused.multiply_add(-s, y, c * x))
        out[3 + j] = fused.multiply_add(0.0, z, fused.multiply_add(c, y, s * x))
        out[6 + j] = fused.multiply_add(1.0, z, fused.multiply_add(0.0, y, 0.0 * x))
    return made


def turned(turn, rotation):
    """A rotation (3, 3) after a turn (3,) in rad, summed likewise."""
    t = memory.values(turn)
    r = memory.values(rotation)
    made = memory.new_matrix(3, 3)
    out = memory.room(made)
    xx, xy, xz, yx, yy, yz, zx, zy, zz = rotations._exponential(t[0], t[1], t[2])
    for j in range(3):
        x = r[j]
        y = r[3 + j]
        z = r[6 + j]
        out[j] = fused.multiply_add(xz, z, fused.multiply_add(xy, y, xx * x))
        out[3 + j] = fused.multiply_add(yz, z, fused.multiply_add(yy, y, yx * x))
        out[6 + j] = fused.multiply_add(zz, z, fused.multiply_add(zy, y, zx * x))
    return made


def correct(
    position, place, com_command, com_estimated, command, estimated, kept, largest_shift, largest_turn, weight, share,
    shift, turn,
):  # fmt: skip
    """One tick of the correction's low pass.

    Args:
        position: Desired sole position (3,) in command frame in m; `place` the same in world.
        com_command: CoM reference (3,) in command frame in m; `com_estimated` the CoM in world.
        command: Commanded torso orientation (3, 3); `estimated` one with commanded heading.
        kept: Additional commanded displacement (3,) of foot in m.
        largest_shift: Limit of `shift` in m; `largest_turn` of `turn` in rad.
        weight: Weight of correction, 0 to 1.
        shift: Correction of position (3,) in m, updated in place; `turn` of orientation in rad.
    """
    p = memory.values(position)
    q = memory.values(place)
    c = memory.values(com_command)
    e = memory.values(com_estimated)
    k = memory.values(kept)
    by = memory.room(shift)
    turned = memory.room(turn)
    dx = q[0] - e[0]
    dy = q[1] - e[1]
    dz = q[2] - e[2]
    # R_command R_estimated^T; only its antisymmetric part is a turn.
    xx, xy, xz, yx, yy, yz, zx, zy, zz = _between(memory.values(command), memory.values(estimated))
    sx = c[0] + (xx * dx + xy * dy + xz * dz) - p[0]
    sy = c[1] + (yx * dx + yy * dy + yz * dz) - p[1]
    sz = c[2] + (zx * dx + zy * dy + zz * dz) - p[2]
    # The sine instead of the angle: the leans are small, and it has no singularity to guard.
    tx = 0.5 * (zy - yz)
    ty = 0.5 * (xz - zx)
    tz = 0.5 * (yx - xy)
    size = math.sqrt(sx * sx + sy * sy + sz * sz)
    scale = 1.0 if size <= largest_shift else largest_shift / size
    by[0] += share * (weight * (scale * sx + k[0]) - by[0])
    by[1] += share * (weight * (scale * sy + k[1]) - by[1])
    by[2] += share * (weight * (scale * sz + k[2]) - by[2])
    size = math.sqrt(tx * tx + ty * ty + tz * tz)
    scale = 1.0 if size <= largest_turn else largest_turn / size
    turned[0] += share * (weight * scale * tx - turned[0])
    turned[1] += share * (weight * scale * ty - turned[1])
    turned[2] += share * (weight * scale * tz - turned[2])


def _between(a, b):
    """A B^T, as `rotations.between`, of values row by row."""
    return (
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
        a[0] * b[3] + a[1] * b[4] + a[2] * b[5],
        a[0] * b[6] + a[1] * b[7] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[1] + a[5] * b[2],
        a[3] * b[3] + a[4] * b[4] + a[5] * b[5],
        a[3] * b[6] + a[4] * b[7] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[1] + a[8] * b[2],
        a[6] * b[3] + a[7] * b[4] + a[8] * b[5],
        a[6] * b[6] + a[7] * b[7] + a[8] * b[8],
    )
