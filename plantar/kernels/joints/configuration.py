"""Kernel of `mj_integratePos` over one unit of time, summed in its order."""

import math

__all__ = ["Configuration"]

_LEAST = 1e-15  # length that counts as none, and what a quaternion's may differ from 1


class Configuration:
    """A configuration (nq,) and its velocity (nv,).

    Args:
        ways: Indices (w,) in the configuration that the velocities `speeds` (w,) add to.
        turns: Where each quaternion begins (t,), w first; `rates` (t,) its angular velocity, in the body's frame.
    """

    def __init__(self, ways, speeds, turns, rates, configuration, velocity):
        self.ways, self.speeds, self.turns, self.rates = ways, speeds, turns, rates
        self.configuration, self.velocity = configuration, velocity

    def move(self):
        """Integrate the velocity over one unit of time."""
        for k in range(self.ways.shape[0]):
            self.configuration[self.ways[k]] += self.velocity[self.speeds[k]]
        for k in range(self.turns.shape[0]):
            self._turn(self.turns[k], self.rates[k])

    def _turn(self, place, rate):
        """Normalise a quaternion and multiply it by that of the turn."""
        q, velocity = self.configuration, self.velocity
        w, x, y, z = q[place], q[place + 1], q[place + 2], q[place + 3]
        length = math.sqrt((w * w + x * x) + (y * y + z * z))
        if length < _LEAST:
            w, x, y, z = 1.0, 0.0, 0.0, 0.0
        elif math.fabs(length - 1.0) > _LEAST:
            share = 1.0 / length
            w, x, y, z = share * w, share * x, share * y, share * z
        i, j, k = velocity[rate], velocity[rate + 1], velocity[rate + 2]
        angle = math.sqrt(i * i + j * j + k * k)
        if angle < _LEAST:
            i, j, k = 1.0, 0.0, 0.0
        else:
            share = 1.0 / angle
            i, j, k = share * i, share * j, share * k
        cosine, sine = math.cos(0.5 * angle), math.sin(0.5 * angle)
        i, j, k = sine * i, sine * j, sine * k
        q[place] = (w * cosine - x * i) - (y * j + z * k)
        q[place + 1] = (w * i + x * cosine) + (y * k - z * j)
        q[place + 2] = (w * j - x * k) + (y * cosine + z * i)
        q[place + 3] = (w * k + x * j) - (y * i - z * cosine)
