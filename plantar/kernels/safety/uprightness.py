"""Whether the base is upright, by the IMU alone, whatever becomes of the estimated state."""

import math

from ..base import memory

__all__ = ["Uprightness"]

# rad/s: faster, no robot turns that is on its feet; chosen: a falling pole of a leg's length turns by 6 rad/s as it
# hits the ground
_SPIN = 20.0
# m/s^2: the specific force of a robot that neither drops for long nor is broken; chosen: a walk has 0.7 to 1.3 of
# gravity; 0.3 of it, and 40 g, leave room for landings
_LEAST, _MOST = 2.9, 400.0
# chosen: m/s^2: 0.7 and 1.3 of gravity, between which the specific force shows what is up
_NEAR_LOW, _NEAR_HIGH = 6.9, 12.8
# chosen: s: time constants of the accelerometer beside a gyro, and without one; a gyro drifts by less than 0.05 rad in
# the first, a step sways a trunk in half a second
_DRAWN, _ALONE = 1.0, 0.2


class Uprightness:
    """Follows the direction up in the base frame: the gyro turns it, the accelerometer draws it.

    A sensor that reports NaN, nothing, what no robot does, or the same bits for `frozen` ticks is left out.

    Args:
        period: Of control in s.
        frozen: Ticks.
        gravity: In m/s^2.
        least: Cosine of the tilt by both, and by the accelerometer alone, below which it lies.

    Attributes:
        turned: Cosine of the tilt by both.
        pulled: Cosine of the tilt by the accelerometer alone.
        turns: Whether the gyro works; `pulls` likewise the accelerometer.
    """

    def __init__(self, period, frozen, gravity, least=(0.0, 0.0)):
        self.period = period
        self.gravity = gravity
        self.frozen = frozen
        self.least_turned, self.least_pulled = least
        self.begun = False
        self.x = 0.0
        self.y = 0.0
        self.ax = 0.0
        self.ay = 0.0
        self.z = 1.0
        self.az = 1.0
        self.turned = 1.0
        self.pulled = 1.0
        self.turns = False
        self.pulls = False
        self.gyro_x = 0.0
        self.gyro_y = 0.0
        self.gyro_z = 0.0
        self.force_x = 0.0
        self.force_y = 0.0
        self.force_z = 0.0
        self.gyro_same = 0
        self.force_same = 0

    def update(self, gyro, accelerometer):
        """Follow a tick's gyro (3,) in rad/s and accelerometer (3,) in m/s^2.

        Returns 0 where none of them works, 1 for a base that is up, 2 for one that lies.
        """
        turns = memory.size(gyro) == 3 and self._turn(memory.values(gyro))
        pulls = memory.size(accelerometer) == 3 and self._pull(memory.values(accelerometer), turns)
        self.turns = turns
        self.pulls = pulls
        self.turned = self.z
        size = math.sqrt(self.ax * self.ax + self.ay * self.ay + self.az * self.az)
        self.pulled = self.az / size if size > 0.0 else 1.0
        if turns and pulls:
            return 2 if self.turned < self.least_turned and self.pulled < self.least_pulled else 1
        if not (turns or pulls):
            return 0
        return 2 if (self.pulled if pulls else self.turned) < self.least_turned else 1

    def _turn(self, w):
        wx = w[0]
        wy = w[1]
        wz = w[2]
        same = wx == self.gyro_x and wy == self.gyro_y and wz == self.gyro_z
        self.gyro_same = self.gyro_same + 1 if same else 0
        self.gyro_x = wx
        self.gyro_y = wy
        self.gyro_z = wz
        spin = wx * wx + wy * wy + wz * wz
        if self.gyro_same >= self.frozen or not 0.0 < spin < _SPIN * _SPIN:
            return False
        x = self.x
        y = self.y
        z = self.z
        dt = self.period
        # A direction that is fixed in the world turns by -w in the base frame.
        self.x = x + dt * (y * wz - z * wy)
        self.y = y + dt * (z * wx - x * wz)
        self.z = z + dt * (x * wy - y * wx)
        return True

    def _pull(self, a, turns):
        x = a[0]
        y = a[1]
        z = a[2]
        same = x == self.force_x and y == self.force_y and z == self.force_z
        self.force_same = self.force_same + 1 if same else 0
        self.force_x = x
        self.force_y = y
        self.force_z = z
        size = math.sqrt(x * x + y * y + z * z)
        if self.force_same >= self.frozen or not _LEAST < size < _MOST:
            return False
        if not self.begun:
            self.begun = True
            self.x = x / size
            self.y = y / size
            self.z = z / size
            self.ax, self.ay, self.az = self.x, self.y, self.z
        share = min(1.0, self.period / _ALONE)
        self.ax += share * (x / self.gravity - self.ax)
        self.ay += share * (y / self.gravity - self.ay)
        self.az += share * (z / self.gravity - self.az)
        if _NEAR_LOW < size < _NEAR_HIGH:
            share = min(1.0, self.period / (_DRAWN if turns else _ALONE))
            self.x += share * (x / size - self.x)
            self.y += share * (y / size - self.y)
            self.z += share * (z / size - self.z)
        size = math.sqrt(self.x * self.x + self.y * self.y + self.z * self.z)
        if size > 0.0:
            self.x, self.y, self.z = self.x / size, self.y / size, self.z / size
        return True
