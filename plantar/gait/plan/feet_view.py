"""Where the feet are commanded to be at one tick: what foot motion tells the others, as a value."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.record import Record
from plantar.sides import Side

__all__ = ["FeetView"]

_THERE = np.zeros(2)
_THERE.flags.writeable = False


class FeetView(Record, frozen=True):
    """Commanded feet at one tick.

    Attributes:
        footholds: Position (3,) in m and heading in rad of each sole in the command frame, read-only.
        side: The foot that swings or swung last; None before the first step.
        landed: Whether that foot has touched the ground.
        lift_off: Whether its swing begins at this tick.
        touchdown: Whether it touches the ground at this tick.
        ahead: How far (2,) in m it still has to go horizontally, command frame.
        surprise: How much higher in m than expected the ground is that it sees where it will land, or has met.
        distance: Distance (n,) in m of its taxels from the ground as seen when it touched it; None where it does not
            look.
    """

    footholds: Mapping[Side, tuple[NDArray[np.float64], float]]
    side: Side | None = None
    landed: bool = True
    lift_off: bool = False
    touchdown: bool = False
    ahead: NDArray[np.float64] = _THERE
    surprise: float = 0.0
    distance: NDArray[np.float64] | None = None
