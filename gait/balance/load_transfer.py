"""Load transfer by the plan: the pendulum's force, shared between the feet by where the desired ZMP lies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gait.balance.law import BalanceState, Feet, FootAction, FootState
from plantar.mechanics.lip import GRAVITY
from plantar.sides import SIDES, Side

__all__ = ["transferred"]


def transferred(balanced: BalanceState, mass: float, feet: Feet) -> dict[Side, FootAction]:
    """Share the force of the pendulum, m (a_x, a_y, g), between the feet.

    In single support the stance foot carries all of it. In double support the desired ZMP, projected onto the line
    between the feet's centres, gives the shares; what it lies beside that line is realised by each foot's own centre
    of pressure, so that the two together make the desired ZMP.

    Args:
        balanced: Desired ZMP and CoM acceleration.
        mass: Robot mass in kg.
        feet: The feet.

    Returns:
        What each foot shall carry.
    """
    zmp, acceleration = feet.frame.to_command(balanced.zmp_desired), balanced.com_acceleration
    force = mass * np.array([acceleration[0], acceleration[1], GRAVITY])
    left, right = (_center(feet.states[side]) for side in SIDES)
    if feet.stance is not None:
        share = 1.0 if feet.stance == "left" else 0.0
    else:
        line = left - right
        share = min(1.0, max(0.0, float((zmp - right) @ line / (line @ line))))
    other = 1.0 - share
    rest = zmp - (share * left + other * right)
    return {"left": FootAction(share * force, left + rest), "right": FootAction(other * force, right + rest)}


def _center(foot: FootState) -> NDArray[np.float64]:
    """Point (2,) of the command frame in m at which a foot is to be loaded."""
    return np.asarray(foot.position[:2] + foot.rotation[:2, :2].dot(foot.center))
