"""Which joint angles miss their targets."""

import math

import numpy as np

from ..base import memory

__all__ = ["TrackingCheck"]

_STUCK = 0.5  # chosen: of the constant: 0.015 rad are forty steps of an encoder of 14 bits, and six times a gear's play


class TrackingCheck:
    """Compares measured with commanded joint angles.

    Drives follow their targets late, by two ticks and a half where set-points are interpolated and low-passed; angles
    are compared with the targets of then. How far a drive misses beyond that depends on its stiffness and on what it
    carries, so that the check learns it: a joint is noticed where it misses by more than `share` times what it, or the
    same joint of the other leg, missed by in earlier single supports, and a constant; it is off where that holds with
    another constant. A joint whose angle stays the same to the last bit while its target moves by half of the first
    constant is noticed, too.

    Args:
        joints: Number of angles, those of the left leg first.
        confirmed: Ticks after which a joint that misses its target is off, or noticed, and ten times as many until the
            latter ends.
        most: Error in rad that is allowed in any case.
        share: Of the largest error so far.
        leasts: Constants in rad from which a joint is noticed: of a robot that stands, in the first single support, and
            later on.
        far: Constant in rad from which a joint is off after the first single support; until then that is `most`.
        settled: Ticks of a robot that stands after which its largest error so far counts.

    Attributes:
        noticed: 1 for a joint that is noticed, else 0 (k,).
        noticed_count: How many are.
        count: How many are off.
    """

    def __init__(self, joints, confirmed, most, share, leasts, far, settled):
        self.joints = joints
        self.pairs = max(1, joints // 2) if joints % 2 == 0 else joints
        self.confirmed = confirmed
        self.most = most
        self.share = share
        self.least_standing, self.least_first, self.least = leasts
        self.far = far
        self.settled = settled
        self.count = 0
        self.noticed_count = 0
        self.ticks = 0
        self.walks = 0
        self.noticed = np.zeros(joints)
        self.before = np.zeros(2 * joints)
        self.angles = np.zeros(2 * joints)
        self.over = np.zeros(joints)
        self.beyond = np.zeros(joints)
        self.calm = np.zeros(joints)
        self.largest = np.zeros(self.pairs)
        self.recent = np.zeros(self.pairs)

    def begin_support(self):
        """The first single support begins."""
        if self.walks == 0:
            self.walks = 1

    def end_support(self):
        """A single support has ended: what was missed by in it is usual from now on."""
        self.walks = 2
        self._learn()
        return 0

    def _learn(self):
        largest = memory.room(self.largest)
        recent = memory.room(self.recent)
        for i in range(self.pairs):
            largest[i] = max(largest[i], recent[i])
            recent[i] = 0.0
        return 0

    def update(self, measured, commanded):
        """Compare a tick's angles (k,) in rad with the targets (k,) in rad of the tick before.

        Returns how many joints are off. Targets that did not move since the last tick are not compared: they may not be
        what the drives get; nor are angles of which all are those of the last tick.
        """
        n = self.joints
        q = memory.values(measured)
        c = memory.values(commanded)
        before = memory.room(self.before)
        angles = memory.room(self.angles)
        noticed = memory.room(self.noticed)
        over = memory.room(self.over)
        beyond = memory.room(self.beyond)
        calm = memory.room(self.calm)
        largest = memory.room(self.largest)
        recent = memory.room(self.recent)
        self.ticks += 1
        if self.ticks == self.settled and self.walks == 0:
            self._learn()
        moves = False
        anew = n == 1
        for i in range(n):
            if c[i] != before[i]:
                moves = True
            if q[i] != angles[i]:
                anew = True
        if self.ticks <= 3 or not moves or not anew:
            for i in range(n):
                before[n + i] = before[i]
                before[i] = c[i]
                if self.ticks <= 3 or q[i] != angles[i]:
                    angles[i] = q[i]
                    angles[n + i] = c[i]
            self.count = 0
            return 0
        least = self.least
        far = self.far
        if self.walks < 2:
            far = self.most
            least = self.least_first if self.walks else self.least_standing
            if self.ticks <= self.settled:
                least = self.most
        self.count = 0
        self.noticed_count = 0
        for i in range(n):
            pair = i % self.pairs
            usual = self.share * largest[pair]
            allowed = min(self.most, least + usual)
            limit = min(self.most, far + usual)
            error = math.fabs(q[i] - 0.5 * (before[i] + before[n + i]))
            before[n + i] = before[i]
            before[i] = c[i]
            if q[i] != angles[i]:
                angles[i] = q[i]
                angles[n + i] = c[i]
            # nature: a target that moved away from an angle that did not
            stuck = math.fabs(c[i] - angles[n + i]) > _STUCK * least
            if error <= allowed and not stuck:
                recent[pair] = max(recent[pair], error)
                over[i] = 0.0
                calm[i] += 1.0
            else:  # also where the angle is no number
                over[i] += 1.0
                calm[i] = 0.0
            beyond[i] = beyond[i] + 1.0 if error > limit else 0.0
            if beyond[i] >= self.confirmed:
                self.count += 1
            if over[i] >= self.confirmed:
                noticed[i] = 1.0
            if calm[i] >= 10 * self.confirmed:
                noticed[i] = 0.0
            if noticed[i] != 0.0:
                self.noticed_count += 1
        return self.count
