"""Safety shell: plausibility of sensors, and largest change of commands per tick."""

import math

import numpy as np

from ..base import memory

__all__ = ["BodyCheck", "SoleCheck", "TargetMoves", "are_finite", "away_from_feet"]

_INFINITE = float("inf")
_NONE = float("nan")
# rad that a joint's angle may change by in a tick: 50 rad/s at 200 Hz; chosen: ten times the speed limits of h1
_FAST = 0.25
# rad: beyond, no joint of a leg has an angle; chosen: almost two turns; an encoder in degrees or counts is beyond at
# once
_TURNED = 12.0
# rad/s: faster, no robot turns that is on its feet; chosen: a falling pole of a leg's length turns by 6 rad/s as it
# hits the ground
_SPIN = 20.0
_SHOCK = 400.0  # m/s^2; chosen: 40 g; IMUs of robots end at 16 or 30 g
_FEW = 10  # chosen: one taxel of so many has a fault of its own; where more repeat, they are at the end of their range


def are_finite(joints, gyro, accelerometer):
    """Whether every number of joint angles (k,), angular velocity (3,) and specific force (3,) is finite."""
    return _finite(joints) and _finite(gyro) and _finite(accelerometer)


def _finite(array):
    given = memory.values(array)
    for i in range(len(array)):  # noqa: SIM110  compiled, a loop is what is quick
        if not math.fabs(given[i]) < _INFINITE:
            return False
    return True


class BodyCheck:
    """Plausibility of joint angles and IMU, tick by tick.

    `frozen`: ticks of same bits after which sensors are stuck; `slip`: difference in rad of joint's last two steps by
    which encoders jump.

    Attributes:
        imu_same: Ticks without a change of gyro or of accelerometer.
        joints_same: Ticks without a change of any joint.
        missing: Whether a number of the last reading is NaN.
        slipped: Whether an encoder has jumped, by `slips` (k,) in rad.
        jumps: Number of jumps so far, the last one of the joint `last_slip`.
    """

    def __init__(self, joints, frozen, slip=0.02):  # derived: `_SLIP` of the shell
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
        self.last_slip = -1
        self.jumps = 0
        self.missing = False
        self.gyro_same = 0
        self.force_same = 0
        self.far = -1
        self.far_angle = 0.0
        self.mirrored = False
        self.passed = 0

    def check(self, joints, gyro, accelerometer, ticks=1):
        """Check a reading, some `ticks` after the last one: joint angles (k,) in rad, gyro (3,) in rad/s and
        accelerometer (3,) in m/s^2.

        Returns 0 for no fault, 1 impossible joint angle or a reading of other sizes, 2 impossible IMU, 3 stuck IMU, 4
        stuck joints. NaN is marked as `missing` alone.
        """
        n = self.joints
        if len(joints) != n or len(gyro) != 3 or len(accelerometer) != 3:
            return 1
        q = memory.values(joints)
        w = memory.values(gyro)
        a = memory.values(accelerometer)
        kept = memory.room(self.kept)
        slips = memory.room(self.slips)
        steps = memory.room(self.steps)
        self.passed += ticks
        passed = self.passed  # since the angles that are kept
        found = 0
        same = self.begun
        far = -1
        missing = False
        for i in range(n):
            value = q[i]
            if value != value:
                missing = True
            if math.fabs(value) >= _TURNED:
                return 1
            if self.begun and math.fabs(value - kept[i]) >= _FAST * ticks:
                if far != -1:  # several encoders never jump at once
                    return 1
                far = i
            if value != kept[i]:
                same = False
        if far != -1 and not self._has_jumped(far, q[far], kept[far]):
            return 1
        self.joints_same = self.joints_same + 1 if same else 0
        spin = 0.0
        shock = 0.0
        same = self.begun
        still = self.begun
        for i in range(3):
            spin += w[i] * w[i]
            shock += a[i] * a[i]
            if w[i] != w[i] or a[i] != a[i]:
                missing = True
            if w[i] != kept[n + i]:
                same = False
            if a[i] != kept[n + 3 + i]:
                still = False
            kept[n + i] = w[i]
            kept[n + 3 + i] = a[i]
        self.missing = missing
        if spin >= _SPIN * _SPIN or shock >= _SHOCK * _SHOCK or (spin == 0.0 and shock == 0.0):
            return 2
        self.gyro_same = self.gyro_same + 1 if same else 0
        self.force_same = self.force_same + 1 if still else 0
        self.imu_same = max(self.gyro_same, self.force_same)
        jumped = -1
        jump = 0.0
        for i in range(n):
            value = q[i] - kept[i] if self.begun else 0.0
            # A joint that was stuck catches up; several that jump together moved, as at an impact.
            change = value - steps[i] * passed
            caught_up = False
            if math.fabs(change) > self.slip * passed and value != 0.0:  # one that gets stuck stays where it is
                if steps[i] != 0.0:
                    jumped, jump = (i, change) if jumped == -1 else (n, 0.0)
                else:
                    caught_up = True
            # What a joint catches up in a tick is no speed to compare the next one with.
            steps[i] = 0.0 if caught_up else value / passed
            kept[i] = q[i]
        if 0 <= jumped < n:
            self.slipped = True
            self.last_slip = jumped
            self.jumps += 1
            slips[jumped] += jump
            steps[jumped] -= jump / passed
        self.begun = True
        self.passed = 0
        if self.imu_same >= self.frozen:
            found = 3
        elif self.joints_same >= self.frozen:
            found = 4
        return found

    def forget(self, joint):
        """The next angle of a joint comes from elsewhere: it is not compared with the last one."""
        kept = memory.room(self.kept)
        kept[joint] = _NONE
        return 0

    def _has_jumped(self, joint, angle, before):
        """Whether the one angle that is far from `before` was there a tick ago, too, and did not turn its sign."""
        if joint != self.far:
            self.mirrored = math.fabs(angle + before) < self.slip
        confirmed = joint == self.far and math.fabs(angle - self.far_angle) < self.slip
        self.far = joint
        self.far_angle = angle
        return confirmed and not self.mirrored


class SoleCheck:
    """Plausibility of forces on the soles of a robot of a weight in N, tick by tick.

    A taxel repeats itself that reports the same bits of a load while half of its sole's loaded taxels, or more, report
    others, in so many readings as `frozen`: coarse steps, in which all repeat themselves, show nothing. One pulls that
    reports less than nothing by more than its zero can be off. Where more than a tenth of a sole's taxels do, it is no
    single taxel's fault.

    `carried`: force in N on both that a robot on its feet does not lack; `most`: force in N up to which a taxel may
    repeat itself, or pull; `dead`: taxels of both without a number; `left`: force in N on left sole, of taxels that
    report one; `right` likewise; `left_same`: ticks without a change of `left`; `right_same` likewise; `swapped`:
    whether soles have exchanged their reports; `left_stuck`: a taxel that repeats itself, -1 for none; `left_pulls`:
    the one that pulls most; `right_stuck` and `right_pulls` likewise.
    """

    def __init__(self, weight, carried=0.0, most=0.0, frozen=24):
        self.weight = weight
        self.carried = carried
        self.most = most
        self.frozen = frozen
        self.left = -1.0
        self.right = -1.0
        self.left_same = 0
        self.right_same = 0
        self.dead = 0
        self.left_pulls = -1
        self.right_pulls = -1
        self.left_stuck = -1
        self.right_stuck = -1
        self.left_readings = 0
        self.right_readings = 0
        self.left_kept = np.zeros(0)
        self.right_kept = np.zeros(0)
        self.stuck = -1
        self.pulls = -1
        self.fresh = 0
        self.steady = False
        self.swapped = False

    def look(self, left, left_count, right, right_count):
        """`update` with arrays of these sizes whose first number is one; returns -1, and takes nothing, for others."""
        if memory.size(left) != left_count or memory.size(right) != right_count or left_count == 0 or right_count == 0:
            return -1
        one = memory.values(left)[0]
        other = memory.values(right)[0]
        if one != one or other != other:
            return -1
        return self.update(left, left_count, right, right_count)

    def skip(self):
        """Ticks were missed: loads may have changed in any way."""
        self.steady = False

    def update(self, left, left_count, right, right_count):
        """Take a tick's forces: `left_count` on the `left` sole, `right_count` on the `right`, as wired.

        Returns 1 where the soles are wired right, both report anew and they carry the robot, else 0.
        """
        self.dead = 0
        if len(self.left_kept) != 2 * left_count or len(self.right_kept) != 2 * right_count:
            self.left_kept = np.zeros(2 * left_count)
            self.right_kept = np.zeros(2 * right_count)
        new_left = self._total(memory.values(left), left_count, memory.room(self.left_kept), self.left_readings)
        self.left_stuck = self.stuck
        self.left_pulls = self.pulls
        self.left_readings += self.fresh
        new_right = self._total(memory.values(right), right_count, memory.room(self.right_kept), self.right_readings)
        self.right_stuck = self.stuck
        self.right_pulls = self.pulls
        self.right_readings += self.fresh
        if self.swapped:
            new_left, new_right = new_right, new_left
        old_left = self.left
        old_right = self.right
        near = 0.06 * self.weight  # chosen: five times the noise of the sum of 42 taxels, a quarter of the jump below
        # Soles that are connected the wrong way jump from steady loads; loads that change in every tick are a shock.
        if (
            self.steady
            # chosen: in standing, soles nearer to each other than a quarter of the weight may exchange loads by a sway
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
        anew = self.left_same == 0 and self.right_same == 0 and not self.swapped
        return 1 if anew and new_left + new_right > self.carried else 0

    def _total(self, force, count, kept, readings):
        """Sum of the forces that are numbers; the others are dead.

        `kept`: forces (count,) of the reading before, and in which of the sole's `readings` each of them changed.
        """
        total = 0.0
        loaded = 0
        changed = 0
        stuck = 0
        which = -1
        pulling = 0
        lowest = -1
        least = -self.most
        for i in range(count):
            value = force[i]
            if value == value:
                total += value
                if value < -self.most:
                    pulling += 1
                    if value <= least:
                        least = value
                        lowest = i
                if value > 0.0:
                    loaded += 1
                if value != kept[i]:
                    kept[i] = value
                    kept[count + i] = readings
                    if value > 0.0:
                        changed += 1
                elif value > self.most and readings - kept[count + i] >= self.frozen:
                    stuck += 1
                    which = i
            else:
                self.dead += 1
        self.fresh = 1 if 2 * changed > loaded else 0
        self.stuck = which if stuck * _FEW <= max(count, _FEW) else -1
        self.pulls = lowest if pulling * _FEW <= max(count, _FEW) else -1
        return total


class TargetMoves:
    """Compares a command's targets with the last one's.

    `com`: largest way of the CoM in a tick in m; `foot`: of a sole; `turn`: largest change of an entry of a rotation;
    `force`: of a foot's force in N; `least`: cosine of the trunk's tilt below which a robot has fallen.

    `height`: of the estimated CoM in m above the lower sole, by the last command; -inf where the trunk has fallen, inf
    before the first command.
    """

    def __init__(self, com, foot, turn, force, least=0.0):
        self.com = com
        self.foot = foot
        self.turn = turn
        self.force = force
        self.least = least
        self.height = _INFINITE
        self.kept = np.zeros(42)

    def within(self, command):
        """Whether a command's targets are within the limits from the last call's, and keep them; one that is NaN is
        not: CoM and rotation of the torso; of each sole position, rotation and force.
        """
        kept = memory.room(self.kept)
        feet = command.feet
        near = self._goes(kept, 0, memory.values(command.com), self.com)
        near &= self._near(kept, 3, memory.values(command.rotation_torso), 9, self.turn)
        foot = feet["left"]
        near &= self._goes(kept, 12, memory.values(foot.position), self.foot)
        near &= self._near(kept, 15, memory.values(foot.rotation), 9, self.turn)
        near &= self._near(kept, 24, memory.values(foot.force), 3, self.force)
        foot = feet["right"]
        near &= self._goes(kept, 27, memory.values(foot.position), self.foot)
        near &= self._near(kept, 30, memory.values(foot.rotation), 9, self.turn)
        near &= self._near(kept, 39, memory.values(foot.force), 3, self.force)
        self._rise(command.state)
        return near

    def _rise(self, state):
        """The height of an estimated state."""
        soles = state.positions_sole
        if memory.values(state.rotation_base_to_world)[8] < self.least:
            self.height = -_INFINITE
        else:
            lower = min(memory.values(soles["left"])[2], memory.values(soles["right"])[2])
            self.height = memory.values(state.com)[2] - lower
        return 0

    def _near(self, kept, begin, now, count, most):
        """Whether numbers are within a limit from the kept ones, which they become."""
        near = True
        for i in range(count):
            if not math.fabs(kept[begin + i] - now[i]) <= most:
                near = False
            kept[begin + i] = now[i]
        return near

    def _goes(self, kept, begin, now, most):
        """Whether a vector is within a limit from the kept one, which it becomes."""
        way = 0.0
        for i in range(3):
            change = now[i] - kept[begin + i]
            way += change * change
            kept[begin + i] = now[i]
        return way <= most * most


def away_from_feet(com, left, right):
    """Horizontal distance in m of a CoM (3,) in m from the middle of two soles (3,) in m."""
    c = memory.values(com)
    p = memory.values(left)
    q = memory.values(right)
    return math.hypot(c[0] - 0.5 * (p[0] + q[0]), c[1] - 0.5 * (p[1] + q[1]))
