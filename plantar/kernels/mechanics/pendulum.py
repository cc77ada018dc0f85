"""Pendulum over a VRP that moves along a line."""

import math

from ..base import memory, vectors

__all__ = ["on_segment"]


def on_segment(omega, since, until, segment, vrps, rates, growths, shrinkage):
    """Pendulum within a plan's segment: VRP, DCM and rate, CoM, first and second rate, new arrays (2,).

    Args:
        omega: Pendulum frequency in rad/s.
        since: Time in s since segment began; `until` until it ends.
        segment: Number of segment.
        vrps: VRP (k, 2) at beginning of each segment in m, with `rates` in m/s.
        growths: A e^(w T) (k, 2) of each in m; `shrinkage` B (2,) of this one.
    """
    start, rate, growth = memory.values(vrps), memory.values(rates), memory.values(growths)
    offset, i, j = memory.values(shrinkage), 2 * segment, 2 * segment + 1
    grown, shrunk = math.exp(-omega * until), math.exp(-omega * since)
    x, gx, sx = start[i] + since * rate[i], grown * growth[i], shrunk * offset[0]
    y, gy, sy = start[j] + since * rate[j], grown * growth[j], shrunk * offset[1]
    return (
        vectors.vector2(x, y),
        vectors.vector2(x + rate[i] / omega + gx, y + rate[j] / omega + gy),
        vectors.vector2(rate[i] + omega * gx, rate[j] + omega * gy),
        vectors.vector2(x + 0.5 * gx + sx, y + 0.5 * gy + sy),
        vectors.vector2(rate[i] + omega * (0.5 * gx - sx), rate[j] + omega * (0.5 * gy - sy)),
        vectors.vector2(omega * omega * (0.5 * gx + sx), omega * omega * (0.5 * gy + sy)),
    )
