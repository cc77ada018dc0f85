"""Pendulum over a VRP that moves along a line."""

import math

from ..base import memory, vectors

__all__ = ["on_segment"]


def on_segment(omega, since, until, segment, vrps, rates, growths, shrinkage):
    """Pendulum within a plan's segment: VRP, DCM and rate, CoM, first and second rate, new arrays (2,).

    `omega`: pendulum frequency in rad/s; `since`: time in s since segment began; `until` until it ends; `vrps`: VRP (k,
    2) at beginning of each segment in m, with `rates` in m/s; `growths`: A e^(w T) (k, 2) of each in m; `shrinkage` B
    (2,) of this one.
    """
    start = memory.values(vrps)
    rate = memory.values(rates)
    growth = memory.values(growths)
    offset = memory.values(shrinkage)
    i = 2 * segment
    j = 2 * segment + 1
    grown = math.exp(-omega * until)
    shrunk = math.exp(-omega * since)
    x = start[i] + since * rate[i]
    gx = grown * growth[i]
    sx = shrunk * offset[0]
    y = start[j] + since * rate[j]
    gy = grown * growth[j]
    sy = shrunk * offset[1]
    return (
        vectors.vector2(x, y),
        vectors.vector2(x + rate[i] / omega + gx, y + rate[j] / omega + gy),
        vectors.vector2(rate[i] + omega * gx, rate[j] + omega * gy),
        vectors.vector2(x + 0.5 * gx + sx, y + 0.5 * gy + sy),
        vectors.vector2(rate[i] + omega * (0.5 * gx - sx), rate[j] + omega * (0.5 * gy - sy)),
        vectors.vector2(omega * omega * (0.5 * gx + sx), omega * omega * (0.5 * gy + sy)),
    )
