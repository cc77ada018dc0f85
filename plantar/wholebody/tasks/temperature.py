"""Virtual interaction with what is hot: heat repels the robot (T 3.34-3.38)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import BodySkin, SkinReading
from plantar.wholebody.tasks.skin_interaction import SkinInteraction

__all__ = ["TemperatureInteraction"]


class TemperatureInteraction(SkinInteraction):
    """Yields to kappa_i = gain (T_i - kappa_0) of every taxel that is at its threshold or above (T 3.34-3.35).

    Args:
        gain: Force of one taxel in N a kelvin above the threshold.
        threshold: kappa_0 in degC.
        patches: Names of the patches that count; all where None.
    """

    def __init__(
        self, skin: BodySkin, gain: float, threshold: float = 31.0, patches: Sequence[str] | None = None
    ) -> None:
        super().__init__(skin, patches)
        self.gain = gain
        self._thresholds = np.where(self.counted, threshold, np.inf)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        if skin.temperature is None:
            return self._thresholds, np.zeros(len(self.skin), dtype=bool)
        above = skin.temperature - self._thresholds
        return self.gain * above, above >= 0.0
