"""Swing: minimum-jerk path from lift-off to touchdown (T 4.1.3, Fig. 33), with slow final approach."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.lazy import lazy
from plantar.kernels.gait.swing_path import SwingPath


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
    lift_share: float = 0.45  # derived: `_LIFT`
    lateral_hold: float = 0.06  # derived: `_END`
    lateral_end: float = 0.06  # derived: `_END`
    spare: float = 0.0
    approach_height: float = 0.0
    approach_speed: float = 0.06  # derived: of `landing`, on a leg of 0.6 m
    rises_first: bool = False

    @lazy
    def kernel(self) -> SwingPath:
        """What computes it."""
        return SwingPath(
            (*self.start.tolist(), self.yaw_start),
            (*self.end.tolist(), self.yaw_end),
            self.height,
            self.duration,
            (self.lift_share, self.lateral_hold, self.lateral_end, self.spare),
            (self.approach_height, self.approach_speed),
            self.rises_first,
        )

    @property
    def lifted(self) -> float:
        """Time in s since lift-off of descent."""
        return float(self.kernel.lifted)

    @property
    def arrived(self) -> float:
        """Time in s since lift-off at which the foot only descends."""
        return float(self.kernel.arrived)

    def at(self, time: float) -> tuple[NDArray[np.float64], float]:
        """Sole position (3,) in m and heading in rad at a time in s since lift-off; held outside."""
        found: tuple[NDArray[np.float64], float] = self.kernel.at(time)
        return found
