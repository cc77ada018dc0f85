"""The kernel that keeps a swing foot where it is wanted in the world while the body leans.

Plain Python that also compiles ahead of time (`lean_correction.pxd` gives the C types).
`gait.feet.posture_compensation` is the public face, with the equation.
"""

from __future__ import annotations

import math

from . import rotations

__all__ = ["correct"]


def correct(
    position, place, com_command, com_estimated, command, estimated, kept, largest_shift, largest_turn, weight, share,
    shift, turn,
):  # fmt: skip
    """One control tick of the correction's low pass.

    Args:
        position: Wanted sole position (3,) in the command frame in m.
        place: The same point in the world frame in m.
        com_command: CoM reference (3,) in the command frame in m.
        com_estimated: Estimated CoM (3,) in the world frame in m.
        command: Commanded torso orientation (3, 3).
        estimated: Estimated torso orientation (3, 3), heading as commanded.
        kept: What the foot was commanded farther (3,) in m.
        largest_shift: Largest correction of the position in m.
        largest_turn: Largest correction of the orientation in rad.
        weight: How much of the correction counts, 0 to 1.
        share: Share of a new correction in the low pass.
        shift: Correction of the position (3,) in m, moved on by one tick.
        turn: Correction of the orientation (3,) in rad, moved on by one tick.
    """
    dx, dy, dz = place[0] - com_estimated[0], place[1] - com_estimated[1], place[2] - com_estimated[2]
    # R_command R_estimated^T; only its antisymmetric part is a turn.
    xx, xy, xz, yx, yy, yz, zx, zy, zz = rotations.between(command, estimated)
    sx = com_command[0] + (xx * dx + xy * dy + xz * dz) - position[0]
    sy = com_command[1] + (yx * dx + yy * dy + yz * dz) - position[1]
    sz = com_command[2] + (zx * dx + zy * dy + zz * dz) - position[2]
    # The sine instead of the angle: the leans are small, and it has no singularity to guard.
    tx, ty, tz = 0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy)
    size = math.sqrt(sx * sx + sy * sy + sz * sz)
    scale = 1.0 if size <= largest_shift else largest_shift / size
    shift[0] += share * (weight * (scale * sx + kept[0]) - shift[0])
    shift[1] += share * (weight * (scale * sy + kept[1]) - shift[1])
    shift[2] += share * (weight * (scale * sz + kept[2]) - shift[2])
    size = math.sqrt(tx * tx + ty * ty + tz * tz)
    scale = 1.0 if size <= largest_turn else largest_turn / size
    turn[0] += share * (weight * scale * tx - turn[0])
    turn[1] += share * (weight * scale * ty - turn[1])
    turn[2] += share * (weight * scale * tz - turn[2])
