"""Rotation of a torso that leans over the foot that the CoM nears."""

import math

from ..base import memory, vectors

__all__ = ["leaning_torso"]


def leaning_torso(com, left, right, yaw, reach, lean, rounded):
    """Rotation (3, 3) to world of a torso with a heading in rad.

    `com`: CoM (3,) in m; `left` and `right`: soles (3,) in m; `reach`: way aside in m from the middle between them up
    to which it leans by `lean` in rad/m; `rounded`: share of it over which the lean ends.
    """
    place = memory.values(com)
    a = memory.values(left)
    b = memory.values(right)
    c = math.cos(yaw)
    d = math.sin(yaw)
    dx = place[0] - 0.5 * (a[0] + b[0])
    dy = place[1] - 0.5 * (a[1] + b[1])
    across = -d * dx + c * dy
    # Rounded where it ends: a kink would jerk the trunk.
    aside = math.fabs(across)
    # derived: the rounding begins as far before the reach, 0.05, as what it takes away needs to stay monotone
    over = min(max(aside - 0.95 * reach, 0.0), rounded * reach)
    # derived: 0.95 as above, where the rounding ends
    aside = min(aside, (0.95 + rounded) * reach) - over * over / (2.0 * rounded * reach)
    roll = -lean * math.copysign(aside, across)
    e = math.cos(roll)
    f = math.sin(roll)
    return vectors.matrix(c, -d * e, d * f, d, c * e, -c * f, 0.0, f, e)
