"""No feedback, for open-loop walks and before the estimate settles."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.gait.balance.law import BalanceState, Feet, FootAction
from plantar.gait.balance.load_transfer import transferred
from plantar.gait.plan.vrp_plan import LipReference
from plantar.sides import Side

__all__ = ["OpenLoop"]


class OpenLoop:
    """Follows the plan (`plantar.gait.balance.law.BalanceLaw`).

    Args:
        mass: Robot's in kg.
    """

    wants_contacts = False

    def __init__(self, mass: float) -> None:
        self.mass = mass
        self.states: Counter[str] = Counter()

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
    ) -> BalanceState:
        """The plan; its VRP is the desired ZMP.

        Args:
            reference: Plan now.
            dcm: Unused.
            zmp: Unused.
            region: Unused.

        Returns:
            The decision.
        """
        return BalanceState(reference.vrp, reference.com, reference.com_velocity, reference.com_acceleration)

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Load transfer by the plan.

        Args:
            balanced: From `update`.
            feet: Both.

        Returns:
            For each foot.
        """
        return transferred(balanced, self.mass, feet)
