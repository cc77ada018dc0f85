"""Slope between the soles by leg angles, more precise than attitude.

It shows the ground's side under a foot on an edge; level ground is expected under both.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side


class SoleSlope:
    """Slope of each sole against the other's ground.

    Opening stand slopes, from encoder offsets, are subtracted. With the other foot in the air, a sole's slope follows
    its attitude in the world.

    `least_load`: vertical force in N of a foot that shows the ground; `smoothing`: new tick's share in the opening
    stand's mean.
    """

    # chosen: fifty ticks, a quarter of a second
    def __init__(self, least_load: float, smoothing: float = 0.02) -> None:
        self._least_load = least_load
        self._smoothing = smoothing
        self._standing: dict[Side, NDArray[np.float64]] = {}
        self._slopes: dict[Side, NDArray[np.float64]] = {side: np.zeros(2) for side in SIDES}
        self._known: dict[Side, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}

    def update(
        self, rotations: Mapping[str, NDArray[np.float64]], loads: Mapping[str, float], standing: bool = False
    ) -> None:
        """Add a tick: `rotations` of each sole to world (3, 3), vertical `loads` on each foot in N, and whether in the
        opening stand, both soles flat, `standing`.
        """
        between = rotations["right"].T @ rotations["left"]
        against = {"left": between[2, :2], "right": between[:2, 2]}
        for side in SIDES if standing else ():
            zero = self._standing.setdefault(side, against[side])
            self._standing[side] = zero + self._smoothing * (against[side] - zero)
        against = {side: against[side] - self._standing.get(side, 0.0) for side in SIDES}
        for side in SIDES:
            world = rotations[side][2, :2]
            if loads[other_side(side)] > self._least_load or side not in self._known:
                self._known[side] = (against[side], world)
            slope, then = self._known[side]
            self._slopes[side] = slope + (world - then)

    def slope(self, side: Side) -> NDArray[np.float64]:
        """Sole's rise (2,) along x, y in m/m; zero before the first tick."""
        return self._slopes[side]
