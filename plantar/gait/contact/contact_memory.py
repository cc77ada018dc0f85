"""Touching cells of a standing sole: carrying, or carrying until its turn lifted them.

    rise_i = (s - s_i) . (r_i - p)

with s the sole's rise along its axes now, s_i when the cell last carried, p the center of pressure.
"""

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.polygon import convex_hull, signed_margin
from plantar.layouts.layout import SoleLayout
from plantar.sensing.reading import Reading


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
        smoothing: float = 0.3,
    ) -> None:
        self._places = layout.positions[:, :2]
        self._least_force = least_force
        self._least_share = least_share / len(self._places)
        self._smoothing = smoothing
        self._gap = gap
        self.lift()

    def lift(self) -> None:
        """Clear the contacts of a foot in the air."""
        count = len(self._places)
        self._mean = np.zeros(count)
        self._touches = np.zeros(count, dtype=bool)
        self._slope = np.zeros((count, 2))
        self._time = -np.inf

    def update(self, reading: Reading, rotation: NDArray[np.float64], center_of_pressure: NDArray[np.float64]) -> None:
        """Add a sole's `reading`, dead taxels unloaded, at its estimated `rotation` to world (3, 3), with
        `center_of_pressure` (2,), sole frame, in m.
        """
        slope = rotation[2, :2]
        if reading.time > self._time:
            self._time = reading.time
            self._mean += self._smoothing * (np.where(np.isfinite(reading.force), reading.force, 0.0) - self._mean)
            carries = self._mean > max(self._least_force, self._least_share * float(self._mean.sum()))
            self._touches |= carries
            # A cell that carries has not lifted off, as the sole did before or not: rises count from here.
            self._slope[carries] = slope
        # The sole turns about the point that carries: to first order a cell rises by slope times its distance from
        # there.
        rise = (slope - self._slope) * (self._places - center_of_pressure)
        self._touches &= rise[:, 0] + rise[:, 1] < self._gap

    @property
    def polygon(self) -> NDArray[np.float64]:
        """Hull (k, 2) of touching cells' centers, sole frame, in m, counter-clockwise; empty below three."""
        touching = self._places[self._touches]
        return convex_hull(touching) if len(touching) >= 3 else np.empty((0, 2))

    def encloses(self, point: NDArray[np.float64]) -> bool:
        """Whether a point (2,), sole frame, in m, lies between the contacts."""
        polygon = self.polygon
        return len(polygon) >= 3 and signed_margin(polygon, point) >= 0.0
