"""Virtual interaction with what is near: it repels the robot before it touches (T 3.29-3.33)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.errors import InputError
from wholebody.dynamics import RobotDynamics
from wholebody.skin.patch import BodySkin
from wholebody.skin.reading import SkinReading, link_wrenches
from wholebody.tasks.task import Demand, Task, wrench_demand

__all__ = ["ProximityInteraction"]


class ProximityInteraction(Task):
    """Yields to f_i = k (d_range - d_i) of every taxel that sees something (T 3.30 corrected: along +z, into the body).

    Args:
        skin: The skin.
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
        self.stiffness = stiffness
        self.sensing_range = np.inf if sensing_range is None else sensing_range
        self._skin = skin
        self._ranges = np.where(skin.taxels_of(patches), skin.ranges, 0.0)

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if skin is None:
            return None
        depth = np.minimum(self._ranges, self.sensing_range) - np.maximum(skin.distance, 0.0)
        active = depth > 0.0
        return wrench_demand(robot, link_wrenches(self._skin, self.stiffness * depth, active))
