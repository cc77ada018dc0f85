"""Virtual interaction with what is hot: heat repels the robot (T 3.34-3.38)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wholebody.dynamics import RobotDynamics
from wholebody.skin.patch import BodySkin
from wholebody.skin.reading import SkinReading, link_wrenches
from wholebody.tasks.task import Demand, Task, wrench_demand

__all__ = ["TemperatureInteraction"]


class TemperatureInteraction(Task):
    """Yields to kappa_i = gain (T_i - kappa_0) of every taxel that is at its threshold or above (T 3.34-3.35).

    Args:
        skin: The skin.
        gain: Force of one taxel in N a kelvin above the threshold.
        threshold: kappa_0 in degC.
        patches: Names of the patches that count; all where None.

    Raises:
        InputError: If there is no patch of a name.
    """

    def __init__(
        self, skin: BodySkin, gain: float, threshold: float = 31.0, patches: Sequence[str] | None = None
    ) -> None:
        self.gain = gain
        self._skin = skin
        self._thresholds = np.where(skin.taxels_of(patches), threshold, np.inf)

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if skin is None or skin.temperature is None:
            return None
        above = skin.temperature - self._thresholds
        return wrench_demand(robot, link_wrenches(self._skin, self.gain * above, above >= 0.0))
