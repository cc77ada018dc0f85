"""Pressure-driven interaction: a force on a small area moves the robot more than one on a large area (T 3.26-3.28)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wholebody.dynamics import RobotDynamics
from wholebody.skin.patch import BodySkin
from wholebody.skin.reading import LinkWrench, SkinReading, link_wrenches
from wholebody.tasks.task import Demand, Task, wrench_demand

__all__ = ["PressureInteraction"]


class PressureInteraction(Task):
    """Yields to w_P = xi / (sum of active areas) w_f on each link (T 3.27).

    Args:
        skin: The skin.
        sensitivity: xi in m^2: the area over which a force counts as it is.
        patches: Names of the patches that count; all where None.

    Raises:
        InputError: If there is no patch of a name.
    """

    def __init__(self, skin: BodySkin, sensitivity: float, patches: Sequence[str] | None = None) -> None:
        self.sensitivity = sensitivity
        self._skin = skin
        self._thresholds = np.where(skin.taxels_of(patches), skin.thresholds, np.inf)

    def wrenches(self, skin: SkinReading) -> list[LinkWrench]:
        """The amplified wrench w_P of each link that is touched, in the link's frame (T 3.26-3.27)."""
        found = link_wrenches(self._skin, skin.force, skin.force >= self._thresholds)
        areas = [float(self._skin.areas[w.taxels].sum()) for w in found]
        return [w._replace(wrench=self.sensitivity / a * w.wrench) for w, a in zip(found, areas, strict=True)]

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        return None if skin is None else wrench_demand(robot, self.wrenches(skin))
