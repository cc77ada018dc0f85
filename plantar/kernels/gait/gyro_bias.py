"""Kernel of `plantar.gait.estimate.gyro_bias`, and which feet are still; feet as `plantar.common.sides.SIDES`."""

__all__ = ["GyroBias", "SteadyLoad"]

_INFINITE = float("inf")


class SteadyLoad:
    """Compares each foot's load with the total and its own running mean.

    Landing and lifting feet always turn the same way, which would add up in heading.

    `band`: largest difference in N of load and mean of still foot. Attributes `left`: load of left foot in N, 0 where
    it may turn.
    """

    def __init__(self, share, follow, band):
        self.share = share
        self.follow = follow
        self.band = band
        self.begun = False
        self.mean_left = 0.0
        self.mean_right = 0.0
        self.left = 0.0
        self.right = 0.0

    def update(self, left, right):
        """Advance by a tick with both feet's loads in N, 0 if unloaded."""
        if not self.begun:
            self.begun = True
            self.mean_left = left
            self.mean_right = right
        total = left + right
        nearly_all = self.share * total
        hardly = (1.0 - self.share) * total
        self.mean_left += self.follow * (left - self.mean_left)
        self.mean_right += self.follow * (right - self.mean_right)
        self.left = left if self._is_still(left, self.mean_left, nearly_all, hardly) else 0.0
        self.right = right if self._is_still(right, self.mean_right, nearly_all, hardly) else 0.0

    def _is_still(self, load, mean, nearly_all, hardly):
        return load >= nearly_all or (load > hardly and abs(load - mean) < self.band)


class GyroBias:
    """Mean difference of gyro and legs' turn, piece by piece.

    Attributes `concluded`: whether piece ended at the last tick.

    Args:
        period: Control period in s.
        largest: Largest bias of axis in rad/s.
        slip: Largest angle in rad about z by which noise differs in a piece.
        one_foot: Weight of one still foot, relative to two.
        known: Weight from which a slip differs from bias.
        value: Receives bias (3,) in base frame in rad/s.
        missed: Receives turn (3,) of legs beyond corrected gyro in last piece, in base frame in rad.
    """

    def __init__(self, period, least, largest, most_ticks, slip, one_foot, known, value, missed):
        self.period = period
        self.least = least
        self.largest = largest
        self.most_ticks = most_ticks
        self.slip = slip
        self.one_foot = one_foot
        self.known = known
        self.value = value
        self.missed = missed
        self.concluded = False
        self.gathered = 0.0
        self._begin()

    def _begin(self):
        # how far the gyro turned beyond the legs in rad
        self.x = 0.0
        self.y = 0.0
        self.z = 0.0
        self.worth = 0.0
        self.ticks = 0

    def update(self, gyro_x, gyro_y, gyro_z, stands, turn_x, turn_y, turn_z, both):
        """Advance by one control tick.

        `gyro_x`: angular velocity about base's x in rad/s; `gyro_y` and `gyro_z` likewise; `stands`: whether foot is
        still; `both` whether both are; `turn_x`: turn about base's x in rad by still feet; `turn_y` and `turn_z`
        likewise.
        """
        self.concluded = False
        if stands:
            self.x += self.period * (gyro_x - self.value[0]) - turn_x
            self.y += self.period * (gyro_y - self.value[1]) - turn_y
            self.z += self.period * (gyro_z - self.value[2]) - turn_z
            self.ticks += 1
            self.worth += 1.0 if both else self.one_foot
        if self.ticks > 0 and (not stands or self.ticks >= self.most_ticks):
            self._conclude()

    def _conclude(self):
        duration = self.ticks * self.period
        first = self.gathered < self.known
        self.gathered += self.worth
        share = self.ticks * self.least
        if self.worth / self.gathered > share:
            share = self.worth / self.gathered
        if share > 1.0:
            share = 1.0
        for i in range(3):
            beyond = self.x if i == 0 else self.y if i == 1 else self.z
            allowed = self.slip if i == 2 else _INFINITE  # flat soles slip about the vertical
            if first and abs(beyond) > allowed:
                allowed = abs(beyond)  # what is beyond is the bias, which is not known yet
            self.value[i] = _limited(self.value[i] + share / duration * _limited(beyond, allowed), self.largest)
            self.missed[i] = -beyond if abs(beyond) <= allowed else 0.0
        self.concluded = True
        self._begin()


def _limited(number, largest):
    return -largest if number < -largest else largest if number > largest else number
