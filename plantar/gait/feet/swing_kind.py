"""What a kind of swing has to offer; a kind of your own is one new file, an entry point of the group
"plantar.swings".
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.record import Record
from plantar.settings.part import Part

__all__ = ["Swing", "SwingKind", "SwingStart"]


class SwingStart(Record, frozen=True):
    """How a swing begins, command frame.

    Attributes:
        position: Sole position (3,) in m at lift-off.
        yaw: Heading in rad at lift-off.
        end: Planned sole position (3,) in m at touchdown.
        yaw_end: Heading in rad at touchdown.
        height: Clearance in m of the highest point above the higher end.
        duration: Time in s from lift-off to touchdown.
        period: Control period in s.
        least_time: Time in s before touchdown from which the foot cannot reach another place.
        sees_ground: Whether the sole sees the ground before it touches it, and should be near to it early.
        approach_height: Height in m above the end from which it goes down slowly; 0 for one move.
        approach_speed: Speed of that in m/s.
        rises_first: Whether an obstacle is next to the foot, which therefore rises before it moves horizontally.
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
    approach_speed: float = 0.06
    rises_first: bool = False


class Swing(Protocol):
    """Path of one swing; times are in s since lift-off.

    Attributes:
        end: Planned sole position (3,) in m at touchdown.
        yaw_end: Heading in rad at touchdown.
        duration: Time in s from lift-off to touchdown.
    """

    @property
    def end(self) -> NDArray[np.float64]: ...

    @property
    def yaw_end(self) -> float: ...

    @property
    def duration(self) -> float: ...

    def at(self, time: float) -> tuple[NDArray[np.float64], float]:
        """Sole position (3,) in m and heading in rad; asked for once a tick."""
        ...

    def falling(self, time: float, height: float) -> float:
        """Returns the speed downwards in m/s at a time for which `at` has returned a height in m."""
        ...

    def risen(self, time: float) -> float:
        """Share 0..1 of the rise that is over."""
        ...

    def comes_down(self, time: float) -> bool:
        """Whether more than half of the swing is over."""
        ...

    def aimed(self, time: float, place: NDArray[np.float64], yaw: float, duration: float) -> Swing:
        """Returns the swing that goes at a time to another place (2,) in m, yaw and duration."""
        ...


class SwingKind(Part):
    """Settings of a kind of swing, which begin one; `control.swing_shape` names the kind."""

    def begin(self, start: SwingStart) -> Swing:
        """The swing from lift-off on."""
        raise NotImplementedError
