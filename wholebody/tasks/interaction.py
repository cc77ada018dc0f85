"""Direct interaction: the robot yields to what touches it, wherever it has skin (T 3.16-3.24)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wholebody.dynamics import RobotDynamics
from wholebody.skin.patch import BodySkin
from wholebody.skin.reading import SkinReading, link_wrenches
from wholebody.tasks.task import Demand, Task, wrench_demand

__all__ = ["DirectInteraction"]


class DirectInteraction(Task):
    """Yields to contact forces: tau = gain sum J^T E w over the links that are touched (T 3.22, 3.23-3.24).

    Args:
        skin: The skin.
        gain: Factor on what is felt; 1 lets it act as it would on a robot without friction or gears.
        patches: Names of the patches that count; all where None.

    Raises:
        InputError: If there is no patch of a name.
    """

    def __init__(self, skin: BodySkin, gain: float = 1.0, patches: Sequence[str] | None = None) -> None:
        self.gain = gain
        self._skin = skin
        self._thresholds = np.where(skin.taxels_of(patches), skin.thresholds, np.inf)

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if skin is None:
            return None
        active = skin.force >= self._thresholds
        return wrench_demand(robot, link_wrenches(self._skin, skin.force, active), self.gain)
