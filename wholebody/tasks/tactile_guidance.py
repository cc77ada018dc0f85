"""The hand is guided by touches on the arm (A 11-12)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import BodySkin, SkinReading, link_wrenches
from plantar.settings.schema import Settings, number
from wholebody.dynamics import RobotDynamics
from wholebody.tasks.task import Demand, Task

__all__ = ["GuidanceGains", "TactileGuidance"]


class GuidanceGains(Settings):
    """How the hand follows (A 12).

    Attributes:
        inertia: Lambda_3: mass that the hand shall seem to have.
        damping: D_3.
        gain: K_3 on the forces on the arm.
    """

    inertia: float = number(5.0, "kg", 1e-3, 1e3)
    damping: float = number(60.0, "N s/m", 0, 1e5)
    gain: float = number(1.0, "1", 0, 1e3)


class TactileGuidance(Task):
    """x''* = (K F_arm - D x') / Lambda of the hand, F_arm the sum of what is felt on the arm (A 11, A 12 corrected).

    Args:
        skin: The skin.
        patches: Names of the patches on the arm.
        link: The hand.
        point: Point (3,) in its frame in m.
        gains: Gains.

    Raises:
        InputError: If there is no patch of a name.
    """

    def __init__(
        self,
        skin: BodySkin,
        patches: Sequence[str],
        link: str,
        point: NDArray[np.float64],
        gains: GuidanceGains | None = None,
    ) -> None:
        self.gains = gains or GuidanceGains()
        self._skin, self._link, self._point = skin, link, np.asarray(point, dtype=float)
        self._thresholds = np.where(skin.taxels_of(patches), skin.thresholds, np.inf)

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if skin is None:
            return None
        gains = self.gains
        force = np.zeros(3)
        for link, wrench, _ in link_wrenches(self._skin, skin.force, skin.force >= self._thresholds):
            force += robot.pose(link)[1] @ wrench[:3]
        jacobian = robot.jacobian(self._link, self._point)[:3]
        wanted = (gains.gain * force - gains.damping * (jacobian @ robot.velocity)) / gains.inertia
        return Demand(jacobian, acceleration=wanted, drift=robot.drift(self._link, self._point)[:3])
