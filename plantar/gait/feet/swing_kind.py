"""Kinds of swing: interface; own kinds use the entry points "plantar.swings"."""

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record
from plantar.common.settings.part import Part
from plantar.gait.plan.leg_momentum import haste

# derived: of its first duration, below which a swing is hurried; times alone shorten it by a tenth at most
_HURRIED = 0.88


def hurried(duration: float, first: float) -> bool:
    """Returns whether a swing has to catch the body: its `duration` is much shorter than the `first`, both in s."""
    return duration < _HURRIED * first


class SwingStart(Record, frozen=True):
    """Start of a swing, command frame.

    Attributes:
        position: Sole (3,) in m at lift-off.
        yaw: At lift-off in rad.
        end: Planned sole (3,) in m at touchdown.
        yaw_end: At touchdown in rad.
        height: Clearance in m above the higher end.
        duration: From lift-off to touchdown in s.
        period: Of control in s.
        least_time: Time in s before touchdown from which the place is fixed.
        sees_ground: Whether the sole sees the ground, and should be near it early.
        approach_height: As in `SwingTrajectory`; so are `approach_speed` and `rises_first`.
    """

    position: NDArray[np.float64]
    yaw: float
    end: NDArray[np.float64]
    yaw_end: float
    height: float
    duration: float
    period: float
    least_time: float
    sees_ground: bool = False
    approach_height: float = 0.0
    approach_speed: float = 0.06  # derived: of `landing`, on a leg of 0.6 m
    rises_first: bool = False

    @property
    def haste(self) -> float:
        """`plantar.gait.plan.leg_momentum.haste` if it sees the ground, else 0."""
        return haste(math.dist(self.position[:2], self.end[:2]), self.duration) if self.sees_ground else 0.0


class Swing(Protocol):
    """Path of a swing; times in s since lift-off.

    Attributes:
        end: Planned sole (3,) in m at touchdown.
        yaw_end: At touchdown in rad.
        duration: From lift-off to touchdown in s.
    """

    @property
    def end(self) -> NDArray[np.float64]: ...

    @property
    def yaw_end(self) -> float: ...

    @property
    def duration(self) -> float: ...

    def at(self, time: float) -> tuple[NDArray[np.float64], float]:
        """Sole position (3,) in m and heading in rad; once a tick."""
        ...

    def falling(self, time: float, height: float) -> float:
        """Returns the downward speed in m/s at a time for which `at` gave a height in m."""
        ...

    def risen(self, time: float) -> float:
        """Share 0..1 of the rise done."""
        ...

    def comes_down(self, time: float) -> bool:
        """Whether half of the swing is over."""
        ...

    def aimed(self, time: float, place: NDArray[np.float64], yaw: float, duration: float) -> "Swing":
        """Returns the swing from where the foot is at a time to another place (2,) in m and yaw in rad.

        Without a jump, by a duration in s since lift-off; the height of its end stays.
        """
        ...


class SwingKind(Part):
    """Settings of a kind of swing; `control.swing_shape` names it."""

    def begin(self, start: SwingStart) -> Swing:
        """The swing from lift-off."""
        raise NotImplementedError
