"""Direct interaction: the robot yields to what touches it, wherever it has skin (T 3.16-3.24)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import BodySkin, SkinReading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.skin_interaction import SkinInteraction
from plantar.wholebody.tasks.task import Demand

__all__ = ["DirectInteraction"]


class DirectInteraction(SkinInteraction):
    """Yields to gain times the force on every taxel that measures its threshold or more (T 3.23).

    Args:
        gain: Factor on what is measured; 1 lets it act as it would on a robot without friction or gears.
        patches: Names of the patches that count; all where None.
    """

    def __init__(self, skin: BodySkin, gain: float = 1.0, patches: Sequence[str] | None = None) -> None:
        super().__init__(skin, patches)
        self.gain = gain
        self._thresholds = np.where(self.counted, skin.thresholds, np.inf)
        own = np.flatnonzero(self.counted)
        self._span = slice(own[0], own[-1] + 1) if len(own) else slice(0)

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if skin is None or not (skin.force[self._span] >= self._thresholds[self._span]).any():
            return None  # before anything else: most of a body is not touched
        return super().demand(robot, skin)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        return self.gain * skin.force, skin.force >= self._thresholds
