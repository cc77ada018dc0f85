"""What all interactions with skin share: a force along z of every active taxel, summed link by link (T 3.14-3.24)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import BodySkin, LinkWrench, SkinReading, link_wrenches
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task, wrench_demand

__all__ = ["SkinInteraction"]


class SkinInteraction(Task):
    """Yields to forces on taxels: tau = sum J^T E w over the links that have an active one (T 3.22-3.24).

    Args:
        patches: Names of the patches that count; all where None.

    Attributes:
        counted: Mask (N,) of the taxels that count.
        damping: Damping (2,) of each link that yields: of its origin in N s/m and of its turning in N m s/rad. What
            owns a link's motion has to damp it too; none by default.

    Raises:
        InputError: If there is no patch of a name.
    """

    def __init__(self, skin: BodySkin, patches: Sequence[str] | None = None) -> None:
        self.skin = skin
        self.counted = skin.taxels_of(patches)
        self.damping = (0.0, 0.0)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Force (N,) along each taxel's z in N, and which taxels (N,) are active; NaN is never."""
        raise NotImplementedError

    def wrenches(self, skin: SkinReading) -> list[LinkWrench]:
        """Wrench of each link that has an active taxel, about its origin in its frame (T 3.18)."""
        return link_wrenches(self.skin, *self.signal(skin))

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        found = None if skin is None else wrench_demand(robot, self.wrenches(skin))
        if found is None or found.force is None or self.damping == (0.0, 0.0):
            return found
        speeds = (found.jacobian @ robot.velocity).reshape(-1, 2, 3)
        return found._replace(force=found.force - (speeds * np.array(self.damping)[:, None]).ravel())
