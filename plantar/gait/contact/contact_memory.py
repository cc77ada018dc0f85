"""Touching cells of a standing sole: carrying, or carrying until its turn lifted them.

    rise_i = (s - s_i) . (r_i - p)

with s the sole's rise along its axes now, s_i when the cell last carried, p the center of pressure.
"""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.geometry.polygon import convex_hull
from plantar.kernels.gait.touching_cells import TouchingCells, encloses
from plantar.layouts.layout import SoleLayout
from plantar.sensing.reading import Reading

_NO_POLYGON = read_only(np.empty((0, 2)))


class ContactMemory:
    """A foot's contacts over its stance.

    `least_force`: running mean in N of a carrying cell; `gap`: rise in m of a lifted cell; `least_share`: carrying
    cell's load over an even share; `smoothing`: new reading's weight in the running mean.
    """

    def __init__(
        self,
        layout: SoleLayout,
        least_force: float,
        gap: float,
        least_share: float = 0.5,
        smoothing: float = 0.3,  # derived: `smoothing` of the contact's settings
    ) -> None:
        self._places = layout.positions[:, :2]
        self._touches = np.zeros(len(self._places), dtype=bool)
        self._cells = TouchingCells(
            self._places,
            self._touches.view(np.uint8),
            least_force,
            least_share / len(self._places),
            smoothing,
            gap,
        )
        self._polygon: NDArray[np.float64] | None = _NO_POLYGON

    def lift(self) -> None:
        """Clear the contacts of a foot in the air."""
        if self._cells.time == -math.inf:
            return
        self._cells.lift()
        self._polygon = _NO_POLYGON

    def update(self, reading: Reading, rotation: NDArray[np.float64], center_of_pressure: NDArray[np.float64]) -> None:
        """Add a sole's `reading`, dead taxels unloaded, at its estimated `rotation` to world (3, 3), with
        `center_of_pressure` (2,), sole frame, in m.
        """
        if self._cells.follow(reading, rotation, center_of_pressure):
            self._polygon = None

    @property
    def polygon(self) -> NDArray[np.float64]:
        """Hull (k, 2) of touching cells' centers, sole frame, in m, counter-clockwise; empty below three."""
        if self._polygon is None:
            touching = self._places[self._touches]
            self._polygon = convex_hull(touching) if len(touching) >= 3 else _NO_POLYGON
        return self._polygon

    def encloses(self, point: NDArray[np.float64]) -> bool:
        """Whether a point (2,), sole frame, in m, lies between the contacts."""
        return bool(encloses(self.polygon, point))
