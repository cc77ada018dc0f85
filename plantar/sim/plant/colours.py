"""Colours of the true ground: darker ground than a proximity sensor was calibrated on appears farther away."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.sim.plant.draw import TruePlant, stream

__all__ = ["PATCH", "GroundColours"]

PATCH = 0.05
"""Size in m of a patch of one colour."""

_TILES = 64  # patches after which the colours repeat: 3.2 m


class GroundColours:
    """Square patches of random reflectance on the world's plane.

    An optical sensor calibrated at reflectance 1 measures d / sqrt(rho), its intensity being proportional to rho / d^2.
    """

    def __init__(self, plant: TruePlant) -> None:
        lightness = 1.0 + plant.reflectance * stream(plant.seed, "colours").uniform(-1.0, 1.0, (_TILES, _TILES))
        self._stretch = 1.0 / np.sqrt(lightness)

    def stretch(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Measured distance over the true one (n,) at points (n, 3) of the ground in the world in m."""
        tiles = np.floor(points[:, :2] / PATCH).astype(np.int64) % _TILES
        return np.asarray(self._stretch[tiles[:, 0], tiles[:, 1]])
