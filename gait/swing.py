"""Swing foot trajectory: a minimum-jerk path from lift-off to touchdown (T 4.1.3, Fig. 33)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["SwingTrajectory", "minimum_jerk"]


def minimum_jerk(phase: float) -> tuple[float, float]:
    """Minimum-jerk blend 10 s^3 - 15 s^4 + 6 s^5 and its rate at phase s, held at 0 and 1 outside.

    Example:
        >>> minimum_jerk(0.5)
        (0.5, 1.875)
    """
    if phase <= 0.0:
        return 0.0, 0.0
    if phase >= 1.0:
        return 1.0, 0.0
    s2 = phase * phase
    return s2 * phase * (10.0 + phase * (6.0 * phase - 15.0)), 30.0 * s2 * (1.0 - phase) ** 2


@dataclass(frozen=True)
class SwingTrajectory:
    """Path of one swing foot.

    Attributes:
        start: Sole position (3,) at lift-off in m.
        end: Planned sole position (3,) at touchdown in m.
        yaw_start: Heading at lift-off in rad.
        yaw_end: Heading at touchdown in rad.
        height: Clearance in m of the highest point above the higher end.
        duration: Single support time in s.
        lift_share: Share of the duration spent rising, 0..1.
        lateral_hold: Share of the duration at both ends in which the foot moves only up or down.
    """

    start: NDArray[np.float64]
    end: NDArray[np.float64]
    yaw_start: float
    yaw_end: float
    height: float
    duration: float
    lift_share: float = 0.45
    lateral_hold: float = 0.06

    def at(self, time: float) -> tuple[NDArray[np.float64], float]:
        """Sole position (3,) in m and heading in rad at a time in s since lift-off; held outside 0..duration."""
        s = min(1.0, max(0.0, time / self.duration))
        blend, _ = minimum_jerk((s - self.lateral_hold) / (1.0 - 2.0 * self.lateral_hold))
        position = self.start + blend * (self.end - self.start)
        top = max(float(self.start[2]), float(self.end[2])) + self.height
        if s < self.lift_share:
            rise, _ = minimum_jerk(s / self.lift_share)
            position[2] = self.start[2] + rise * (top - self.start[2])
        else:
            fall, _ = minimum_jerk((s - self.lift_share) / (1.0 - self.lift_share))
            position[2] = top + fall * (self.end[2] - top)
        turn = math.remainder(self.yaw_end - self.yaw_start, 2.0 * math.pi)
        return position, self.yaw_start + blend * turn
