"""Safety shell: plausibility of sensors, and largest change of commands per tick."""

import math

import numpy as np

from ..base import memory

__all__ = ["BodyCheck", "SoleCheck", "farthest"]

_FAST = 0.25  # rad that a joint's angle may change by in a tick: 50 rad/s at 200 Hz
_TURNED = 12.0  # rad: beyond, no joint of a leg has an angle
_SPIN = 20.0  # rad/s: faster, no robot turns that is on its feet
_SHOCK = 400.0  # m/s^2


class BodyCheck:
    """Plausibility of joint angles and IMU, tick by tick.

    `frozen`: ticks of same bits after which sensors are stuck; `slip`: difference in rad of joint's last two steps by
    which encoders jump. Attributes `imu_same`: ticks without a change of IMU; `joints_same`: ticks without a change of
    any joint; `slipped`: whether an encoder has jumped, by `slips` (k,) in rad.
    """

    def __init__(self, joints, frozen, slip=0.02):
        self.joints = joints
        self.frozen = frozen
        self.begun = False
        self.imu_same = 0
        self.joints_same = 0
        self.kept = np.zeros(joints + 6)
        self.slip = slip
        self.slipped = False
        self.slips = np.zeros(joints)
        self.steps = np.zeros(joints)

    def check(self, joints, gyro, accelerometer):
        """Check a reading of the right sizes: joint angles (k,) in rad, gyro (3,) in rad/s and accelerometer (3,) in
        m/s^2.

        Returns 0 for no fault, 1 impossible joint angle, 2 impossible IMU, 3 stuck IMU, 4 stuck joints. NaN is not
        checked.
        """
        q = memory.values(joints)
        w = memory.values(gyro)
        a = memory.values(accelerometer)
        kept = memory.room(self.kept)
        n = self.joints
        slips = memory.room(self.slips)
        steps = memory.room(self.steps)
        found = 0
        same = self.begun
        for i in range(n):
            value = q[i]
            if math.fabs(value) >= _TURNED or (self.begun and math.fabs(value - kept[i]) >= _FAST):
                return 1
            if value != kept[i]:
                same = False
        self.joints_same = self.joints_same + 1 if same else 0
        spin = 0.0
        shock = 0.0
        same = self.begun
        for i in range(3):
            spin += w[i] * w[i]
            shock += a[i] * a[i]
            if w[i] != kept[n + i] or a[i] != kept[n + 3 + i]:
                same = False
            kept[n + i] = w[i]
            kept[n + 3 + i] = a[i]
        if spin >= _SPIN * _SPIN or shock >= _SHOCK * _SHOCK or (spin == 0.0 and shock == 0.0):
            return 2
        self.imu_same = self.imu_same + 1 if same else 0
        jumped = -1
        jump = 0.0
        for i in range(n):
            value = q[i] - kept[i] if self.begun else 0.0
            # A joint that was stuck catches up; several that jump together moved, as at an impact.
            if math.fabs(value - steps[i]) > self.slip and steps[i] != 0.0:
                jumped, jump = (i, value - steps[i]) if jumped == -1 else (n, 0.0)
            steps[i] = value
            kept[i] = q[i]
        if 0 <= jumped < n:
            self.slipped = True
            slips[jumped] += jump
            steps[jumped] -= jump
        self.begun = True
        if self.imu_same >= self.frozen:
            found = 3
        elif self.joints_same >= self.frozen:
            found = 4
        return found


class SoleCheck:
    """Plausibility of forces on the soles of a robot of a weight in N, tick by tick.

    `left`: force in N on left sole, of taxels that report one; `right` likewise; `left_same`: ticks without a change of
    `left`; `right_same` likewise; `swapped`: whether soles have exchanged their reports.
    """

    def __init__(self, weight):
        self.weight = weight
        self.left = -1.0
        self.right = -1.0
        self.left_same = 0
        self.right_same = 0
        self.steady = False
        self.swapped = False

    def update(self, left, left_count, right, right_count):
        """Take a tick's forces: `left_count` on the `left` sole, `right_count` on the `right`, as wired; Returns 0."""
        new_left = _total(memory.values(left), left_count)
        new_right = _total(memory.values(right), right_count)
        if self.swapped:
            new_left, new_right = new_right, new_left
        old_left = self.left
        old_right = self.right
        near = 0.06 * self.weight
        # Soles that are connected the wrong way jump from steady loads; loads that change in every tick are a shock.
        if (
            self.steady
            and math.fabs(old_left - old_right) > 0.25 * self.weight
            and math.fabs(new_left - old_right) < near
            and math.fabs(new_right - old_left) < near
        ):
            self.swapped = not self.swapped
            new_left, new_right = new_right, new_left
        self.left_same = self.left_same + 1 if new_left == old_left else 0
        self.right_same = self.right_same + 1 if new_right == old_right else 0
        self.steady = (
            old_left >= 0.0 and math.fabs(new_left - old_left) < near and math.fabs(new_right - old_right) < near
        )
        self.left = new_left
        self.right = new_right
        return 0


def farthest(before, now, count):
    """Largest change of the first `count` numbers from `before` to `now`; returns NaN if any is."""
    a = memory.values(before)
    b = memory.values(now)
    largest = 0.0
    for i in range(count):
        change = math.fabs(a[i] - b[i])
        if not change <= largest:
            largest = change
    return largest


def _total(force, count):
    total = 0.0
    for i in range(count):
        value = force[i]
        if value == value:
            total += value
    return total
