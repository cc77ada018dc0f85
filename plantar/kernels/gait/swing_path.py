"""Minimum-jerk path of a swing foot, which `plantar.gait.feet.swing` describes."""

import math

from ..base import vectors

__all__ = ["SwingPath"]

# Shares of a swing with slow approach:
_APPROACH_SHARE = 0.44  # chosen: that it takes at the end; more leaves the knee less time for the rest
# chosen: after which the foot moves only downwards; above `1 - _APPROACH_SHARE`, so that the descent begins over the
# foothold
_ARRIVED_SHARE = 0.61
_RISE_SHARE = 0.28  # chosen: spent rising at most: the next stone may be 30 mm higher, and the toe is soon above it
_HIGH_SHARE = 0.34  # chosen: after which it comes down: what moves under the foot meanwhile has to pass below it
# derived: after which one that rises first moves horizontally: half of its height; half of `_RISE_SHARE`
_FIRST_SHARE = 0.14
_SKEW = 0.8  # chosen: Exponent below 1 that moves its horizontal motion forward, so that it brakes gently


class SwingPath:
    """Path from lift-off to touchdown.

    Attributes `lifted`: time in s since lift-off of descent; `arrived`: at which the foot only descends.

    Args:
        start: Sole's x, y, z in m and heading in rad at lift-off.
        end: The same at touchdown.
        height: Clearance in m above the higher end.
        duration: In s; the path is held outside.
        shares: Shares of the duration: rising, upwards only, downwards only, and left when the foot is down.
        approach: Height in m above the end of a slow approach, 0 for one move, and its speed in m/s.
        rises_first: Whether the foot rises before it moves horizontally.
    """

    def __init__(self, start, end, height, duration, shares, approach, rises_first):
        self.x, self.y, self.z, self.yaw = start
        self.to_x, self.to_y, self.to_z, yaw = end
        self.turn = math.remainder(yaw - self.yaw, 2.0 * math.pi)
        self.top = max(self.z, self.to_z) + height
        self.duration = duration
        lift, hold, last, self.spare = shares
        self.approach, self.speed = approach
        self.slow = self.approach > 0.0
        if self.slow:
            self.lifted = duration * min(lift, _HIGH_SHARE)
            self.arrived = duration * _ARRIVED_SHARE
            self.first = 0.0
        else:
            self.lifted = duration * lift
            self.arrived = duration * (1.0 - last)
            self.first = duration * hold
        if rises_first:
            self.first = duration * _FIRST_SHARE

    def at(self, time):
        """Sole's position (3,) in m and heading in rad at a time in s since lift-off."""
        time = min(self.duration, max(0.0, time))
        share = (time - self.first) / (self.arrived - self.first)
        blend = _eased(math.pow(max(0.0, share), _SKEW) if self.slow else share)
        place = vectors.vector(
            self.x + blend * (self.to_x - self.x), self.y + blend * (self.to_y - self.y), self._height(time)
        )
        return place, self.yaw + blend * self.turn

    def _height(self, time):
        """Height in m at a time in s within the duration."""
        top = self.top
        end = self.to_z
        lifted = self.lifted
        if time < lifted:
            rising = min(lifted, _RISE_SHARE * self.duration) if self.slow else lifted
            return self.z + _eased(time / rising) * (top - self.z)
        if not self.slow:
            return top + _eased((time - lifted) / ((1.0 - self.spare) * self.duration - lifted)) * (end - top)
        lasting = _APPROACH_SHARE * self.duration
        speed = max(self.speed, self.approach / lasting)
        since = time - (self.duration - lasting)
        # chosen: a fifth of the height is left to the fast part, else a low swing would crawl from its top
        low = end + min(self.approach, 0.8 * (top - end))
        if since >= 0.0:
            return low - speed * since
        # Quintic from rest at the top to the approach's height and speed, with no acceleration at either end.
        length = self.duration - lasting - lifted
        s = 1.0 + since / length
        drop = low - top
        pull = -speed * length
        s3 = s * s * s
        return top + s3 * (
            # nature: the quintic that ends at rest and begins with a speed: coefficients 10, -15, 6 and 4, -7, 3
            (10.0 * drop - 4.0 * pull) + s * ((7.0 * pull - 15.0 * drop) + s * (6.0 * drop - 3.0 * pull))
        )


def _eased(phase):
    """Minimum-jerk blend, as `plantar.mechanics.easing.minimum_jerk`."""
    if phase <= 0.0:
        return 0.0
    if phase >= 1.0:
        return 1.0
    # nature: the minimum jerk polynomial 10 s^3 - 15 s^4 + 6 s^5
    return phase * phase * phase * (10.0 + phase * (6.0 * phase - 15.0))
