"""Commanded feet at one tick, as a value for the other parts."""

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
        ahead: Horizontal distance (2,) in m to its target, command frame.
        surprise: Height in m of the ground that it sees or has met, less the expected one.
        distance: Distance (n,) in m of its taxels from the ground at touchdown; None where none is measured.
    """

    footholds: Mapping[Side, tuple[NDArray[np.float64], float]]
    side: Side | None = None
    landed: bool = True
    lift_off: bool = False
    touchdown: bool = False
    ahead: NDArray[np.float64] = _THERE
    surprise: float = 0.0
    distance: NDArray[np.float64] | None = None
