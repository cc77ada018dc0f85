"""Load transfer: the desired ZMP shares the pendulum's force between the feet; without feedback, the plan's."""

from collections import Counter
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.balance.law import BalanceState, Feet, FootAction
from plantar.gait.plan.vrp_plan import LipReference
from plantar.kernels.gait.dcm_feedback import shared_load
from plantar.mechanics.lip import GRAVITY


def transferred(balanced: BalanceState, mass: float, feet: Feet) -> dict[Side, FootAction]:
    """Share the pendulum's force, m (a_x, a_y, g), between the feet.

    In double support the ZMP along the line of the feet's centers gives the shares; its distance from it moves each
    center of pressure.

    Returns it for each of the `feet` of a robot of a `mass` in kg, by the desired ZMP and CoM acceleration, `balanced`.
    """
    left = feet.states["left"]
    right = feet.states["right"]
    zmp = feet.frame.to_command(balanced.zmp_desired)
    stance = 0 if feet.stance is None else 1 if feet.stance == "left" else 2
    force, place, other_force, other_place = shared_load(
        zmp, balanced.com_acceleration, mass, GRAVITY, left, right, stance
    )
    return {"left": FootAction(force, place), "right": FootAction(other_force, other_place)}


class OpenLoop:
    """Follows the plan (`plantar.gait.balance.law.BalanceLaw`). `mass`: robot's in kg."""

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
        firm: bool = True,
    ) -> BalanceState:
        """Returns the plan at `reference`; `dcm`, `zmp`, `region` and `firm` are unused."""
        return BalanceState(reference.vrp, reference.com, reference.com_velocity, reference.com_acceleration)

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Returns loads of `feet` by `balanced`."""
        return transferred(balanced, self.mass, feet)
