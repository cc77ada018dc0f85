"""Slope of one sole against the other from the legs' angles, which is more precise than the attitude.

It shows on which side of a foot that rests on an edge the ground is; the ground is expected to be level under both.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.sides import SIDES, Side, other_side

__all__ = ["SoleSlope"]


class SoleSlope:
    """Slope of each sole against the ground of the other one.

    Slopes in the opening stand, by encoder offsets, are subtracted. While the other foot is in the air, a sole's slope
    follows its attitude in the world.

    Args:
        least_load: Vertical force in N from which a foot shows the ground.
        smoothing: Share of a new tick in the mean over the opening stand.
    """

    def __init__(self, least_load: float, smoothing: float = 0.02) -> None:
        self._least_load = least_load
        self._smoothing = smoothing
        self._standing: dict[Side, NDArray[np.float64]] = {}
        self._slopes: dict[Side, NDArray[np.float64]] = {side: np.zeros(2) for side in SIDES}
        self._known: dict[Side, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}

    def update(
        self, rotations: Mapping[str, NDArray[np.float64]], loads: Mapping[str, float], standing: bool = False
    ) -> None:
        """Add a tick.

        Args:
            rotations: Rotation (3, 3) from each sole to the world.
            loads: Vertical force on each foot in N.
            standing: Whether this is the opening stand, with both soles flat.
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
        """Rise of a sole (2,) along its x and y axes in m/m; zero before the first tick."""
        return self._slopes[side]
