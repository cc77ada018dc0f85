"""Pendulum over a VRP that moves along lines."""

import math

import numpy as np

from ..base import memory, vectors

__all__ = ["PendulumCourse", "sums"]


class PendulumCourse:
    """DCM and CoM over the k segments between a plan's knots (`plantar.gait.plan.vrp_plan`).

    Args:
        omega: Pendulum frequency in rad/s.
        times: Of the knots (k + 1,) in s; `vrps` theirs (k + 1, 2) in m.
        rates: The VRP's in each segment (k, 2) in m/s.
        growths: A e^(w T) (k, 2) of each in m.
        com: CoM (2,) at the first knot in m.
    """

    def __init__(self, omega, times, vrps, rates, growths, com):
        self.omega = omega
        self.times = times
        self.vrps = vrps
        self.rates = rates
        self.growths = growths
        count = len(rates)
        self.shrinkages = np.zeros((count, 2))  # B of each segment, as far as it was asked for
        self.known = 0
        self.com_x, self.com_y = com
        self.last = 0

    def at(self, time):
        """VRP, DCM and rate, CoM, first and second rate, new arrays (2,); of a `time` in s before the last knot."""
        times = self.times
        count = self.rates.shape[0]
        if time < times[0]:
            time = times[0]
        k = self.last if time >= times[self.last] else 0
        while k + 1 < count and time >= times[k + 1]:
            k += 1
        self.last = k
        self._start(k + 1)
        omega = self.omega
        since = time - times[k]
        grown = math.exp(-omega * (times[k + 1] - time))
        shrunk = math.exp(-omega * since)
        rx = self.rates[k, 0]
        ry = self.rates[k, 1]
        x = self.vrps[k, 0] + since * rx
        gx = grown * self.growths[k, 0]
        sx = shrunk * self.shrinkages[k, 0]
        y = self.vrps[k, 1] + since * ry
        gy = grown * self.growths[k, 1]
        sy = shrunk * self.shrinkages[k, 1]
        return (
            vectors.vector2(x, y),
            vectors.vector2(x + rx / omega + gx, y + ry / omega + gy),
            vectors.vector2(rx + omega * gx, ry + omega * gy),
            vectors.vector2(x + 0.5 * gx + sx, y + 0.5 * gy + sy),
            vectors.vector2(rx + omega * (0.5 * gx - sx), ry + omega * (0.5 * gy - sy)),
            vectors.vector2(omega * omega * (0.5 * gx + sx), omega * omega * (0.5 * gy + sy)),
        )

    def end(self):
        """CoM (2,) in m at the last knot."""
        self._start(self.rates.shape[0])
        return vectors.vector2(self.com_x, self.com_y)

    def _start(self, count):
        """Forward pass: where the CoM starts in the first segments."""
        while self.known < count:
            i = self.known
            decay = math.exp(-self.omega * (self.times[i + 1] - self.times[i]))
            x = self.com_x - self.vrps[i, 0] - 0.5 * decay * self.growths[i, 0]
            y = self.com_y - self.vrps[i, 1] - 0.5 * decay * self.growths[i, 1]
            self.shrinkages[i, 0] = x
            self.shrinkages[i, 1] = y
            self.com_x = self.vrps[i + 1, 0] + 0.5 * self.growths[i, 0] + decay * x
            self.com_y = self.vrps[i + 1, 1] + 0.5 * self.growths[i, 1] + decay * y
            self.known += 1


def sums(one, other):
    """DCM and rate, CoM, first and second rate (2,) of two `LipReference` together, new arrays."""
    return (
        _sum(one.dcm, other.dcm),
        _sum(one.dcm_velocity, other.dcm_velocity),
        _sum(one.com, other.com),
        _sum(one.com_velocity, other.com_velocity),
        _sum(one.com_acceleration, other.com_acceleration),
    )


def _sum(one, other):
    a = memory.values(one)
    b = memory.values(other)
    return vectors.vector2(a[0] + b[0], a[1] + b[1])
