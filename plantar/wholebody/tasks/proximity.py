"""Virtual interaction with what is near: it repels the robot before it touches (T 3.29-3.33)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.sensing.link_skin import BodySkin, SkinReading
from plantar.wholebody.tasks.skin_interaction import SkinInteraction

__all__ = ["ProximityInteraction"]


class ProximityInteraction(SkinInteraction):
    """Yields to f_i = k (d_range - d_i) of every taxel that sees something (T 3.30 corrected: along +z, into the body).

    Args:
        stiffness: k_prox of one taxel in N/m.
        sensing_range: d_range in m, at most the patches' own; theirs where None. May be changed at any time.
        patches: Names of the patches that count; all where None.

    Raises:
        InputError: If there is no patch of a name, or the range is not above 0.
    """

    def __init__(
        self,
        skin: BodySkin,
        stiffness: float,
        sensing_range: float | None = None,
        patches: Sequence[str] | None = None,
    ) -> None:
        if sensing_range is not None and not sensing_range > 0.0:
            raise InputError(f"sensing range is {sensing_range} m; allowed: above 0")
        super().__init__(skin, patches)
        self.stiffness = stiffness
        self.sensing_range = np.inf if sensing_range is None else sensing_range
        self._ranges = np.where(self.counted, skin.ranges, 0.0)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        depth = np.minimum(self._ranges, self.sensing_range) - np.maximum(skin.distance, 0.0)
        return self.stiffness * depth, depth > 0.0
