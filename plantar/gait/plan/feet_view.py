"""Commanded feet at a tick, as a value."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.common.record import Record
from plantar.common.sides import Side

_THERE = read_only(np.zeros(2))


class FeetView(Record, frozen=True):
    """Commanded feet at a tick.

    `footholds`: sole's (3,) in m and heading in rad, command frame, read-only; `side`: foot of the current or last
    swing; None before; `lift_off`: whether its swing begins now; `ahead`: horizontal (2,) in m to its target, command
    frame; `surprise`: ground height seen or met, less the expected, in m; `distance`: taxels' (n,) in m from the ground
    at touchdown; None if unmeasured; `below`: those of a foot that is over its place and sees ground that is not one
    plane, before it touches; None for any other.
    """

    footholds: Mapping[Side, tuple[NDArray[np.float64], float]]
    side: Side | None = None
    landed: bool = True
    lift_off: bool = False
    touchdown: bool = False
    ahead: NDArray[np.float64] = _THERE
    surprise: float = 0.0
    distance: NDArray[np.float64] | None = None
    below: NDArray[np.float64] | None = None
