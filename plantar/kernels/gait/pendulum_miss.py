"""Where a pendulum comes to with the best ZMP of its support."""

import math

from ..base import memory
from ..geometry import convex

__all__ = ["best_zmp", "missed_by"]


def best_zmp(pendulum, left):
    """`plantar.gait.propose.proposer.Pendulum.beyond_zmp`."""
    dcm = memory.values(pendulum.dcm)
    goal = memory.values(pendulum.goal)
    offset = memory.values(pendulum.offset)
    growth = math.expm1(pendulum.omega * left)
    x = dcm[0] + (dcm[0] - goal[0]) / growth + offset[0]
    y = dcm[1] + (dcm[1] - goal[1]) / growth + offset[1]
    return growth, (x, y), convex.nearest(pendulum.zmp_region, x, y)


def missed_by(pendulum, left):
    """DCM error (x, y) in m of a `plantar.gait.propose.proposer.Pendulum` after `left` seconds with the best ZMP."""
    dcm = memory.values(pendulum.dcm)
    goal = memory.values(pendulum.goal)
    offset = memory.values(pendulum.offset)
    rate = pendulum.omega * left
    growth = math.expm1(rate)
    px, py = convex.nearest(
        pendulum.zmp_region,
        dcm[0] + (dcm[0] - goal[0]) / growth + offset[0],
        dcm[1] + (dcm[1] - goal[1]) / growth + offset[1],
    )
    grown = math.exp(rate)
    ux = px - offset[0]
    uy = py - offset[1]
    return ux + grown * (dcm[0] - ux) - goal[0], uy + grown * (dcm[1] - uy) - goal[1]
