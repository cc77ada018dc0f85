"""Colours of the true ground: what is darker than a proximity sensor was calibrated on seems farther away to it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.sim.plant.draw import TruePlant, stream

__all__ = ["PATCH", "GroundColours"]

PATCH = 0.05
"""Size in m of a patch of one colour."""

_TILES = 64  # patches after which the colours repeat: 3.2 m


class GroundColours:
    """Square patches of the world's plane, each as light as chance has it.

    An optical sensor gets back an intensity in proportion to the reflectance rho, and to 1 / d^2 by the inverse-square
    law; one that takes it for that of reflectance 1 finds d / sqrt(rho).

    Args:
        plant: The true plant.
    """

    def __init__(self, plant: TruePlant) -> None:
        lightness = 1.0 + plant.reflectance * stream(plant.seed, "colours").uniform(-1.0, 1.0, (_TILES, _TILES))
        self._stretch = 1.0 / np.sqrt(lightness)

    def stretch(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """How many times as far away the ground seems.

        Args:
            points: Where it is seen (n, 3) in the world in m.

        Returns:
            Measured distance over the true one (n,).
        """
        tiles = np.floor(points[:, :2] / PATCH).astype(np.int64) % _TILES
        return np.asarray(self._stretch[tiles[:, 0], tiles[:, 1]])
