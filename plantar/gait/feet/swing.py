"""Swing: minimum-jerk path from lift-off to touchdown (T 4.1.3, Fig. 33), with slow final approach."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.base.vectors import vector
from plantar.mechanics.easing import minimum_jerk

# Shares of a swing with slow approach:
_APPROACH_SHARE = 0.44  # that it takes at the end
_ARRIVED_SHARE = 0.61  # after which the foot moves only downwards
_RISE_SHARE = 0.28  # spent rising at most: the next stone may be 30 mm higher, and the toe is soon above it
_HIGH_SHARE = 0.34  # after which it comes down: what moves under the foot meanwhile has to pass below it
_FIRST_SHARE = 0.14  # after which one that rises first moves horizontally: half of its height
_SKEW = 0.8  # Exponent below 1 that moves its horizontal motion forward, so that it brakes gently


@dataclass(frozen=True)
class SwingTrajectory:
    """Path of a swing foot.

    Attributes:
        start: Sole (3,) at lift-off in m.
        end: Planned sole (3,) at touchdown in m.
        yaw_start: Heading at lift-off in rad.
        yaw_end: Heading at touchdown in rad.
        height: Clearance in m above the higher end.
        duration: Single support in s.
        lift_share: Share of rising, 0..1.
        lateral_hold: First share of the duration, upwards only.
        lateral_end: Last share, downwards only.
        spare: Share left when the foot is down.
        approach_height: Height in m above the end of a slow approach; 0 is one move.
        approach_speed: Its speed in m/s; raised if it would not reach the end.
        rises_first: Whether the foot rises before it moves horizontally, for an obstacle.
    """

    start: NDArray[np.float64]
    end: NDArray[np.float64]
    yaw_start: float
    yaw_end: float
    height: float
    duration: float
    lift_share: float = 0.45
    lateral_hold: float = 0.06
    lateral_end: float = 0.06
    spare: float = 0.0
    approach_height: float = 0.0
    approach_speed: float = 0.06
    rises_first: bool = False

    @property
    def lifted(self) -> float:
        """Time in s since lift-off of descent."""
        return self.duration * (self.lift_share if self.approach_height == 0.0 else min(self.lift_share, _HIGH_SHARE))

    @property
    def arrived(self) -> float:
        """Time in s since lift-off at which the foot only descends."""
        if self.approach_height == 0.0:
            return self.duration * (1.0 - self.lateral_end)
        return self.duration * _ARRIVED_SHARE

    def at(self, time: float) -> tuple[NDArray[np.float64], float]:
        """Sole position (3,) in m and heading in rad at a time in s since lift-off; held outside."""
        time = min(self.duration, max(0.0, time))
        slow = self.approach_height > 0.0
        first = self.duration * (_FIRST_SHARE if self.rises_first else 0.0 if slow else self.lateral_hold)
        share = (time - first) / (self.arrived - first)
        blend, _ = minimum_jerk(max(0.0, share) ** _SKEW if slow else share)
        x, y, _ = self.start.tolist()
        to_x, to_y, _ = self.end.tolist()
        position = vector(x + blend * (to_x - x), y + blend * (to_y - y), self._height(time))
        turn = math.remainder(self.yaw_end - self.yaw_start, 2.0 * math.pi)
        return position, self.yaw_start + blend * turn

    def _height(self, time: float) -> float:
        start = self.start.item(2)
        end = self.end.item(2)
        top = max(start, end) + self.height
        lifted = self.lifted
        if time < lifted:
            rising = lifted if self.approach_height == 0.0 else min(lifted, _RISE_SHARE * self.duration)
            rise, _ = minimum_jerk(time / rising)
            return start + rise * (top - start)
        if self.approach_height == 0.0:
            fall, _ = minimum_jerk((time - lifted) / ((1.0 - self.spare) * self.duration - lifted))
            return top + fall * (end - top)
        lasting = _APPROACH_SHARE * self.duration
        speed = max(self.approach_speed, self.approach_height / lasting)
        since = time - (self.duration - lasting)
        low = end + min(self.approach_height, 0.8 * (top - end))
        if since >= 0.0:
            return low - speed * since
        # Quintic from rest at the top to the approach's height and speed, with no acceleration at either end.
        length = self.duration - lasting - lifted
        s = 1.0 + since / length
        drop = low - top
        pull = -speed * length
        s3 = s * s * s
        return top + s3 * (
            (10.0 * drop - 4.0 * pull) + s * ((7.0 * pull - 15.0 * drop) + s * (6.0 * drop - 3.0 * pull))
        )
