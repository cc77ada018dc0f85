"""Load transfer by the plan: the pendulum's force, shared between the feet by where the desired ZMP lies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gait.balance.law import BalanceState, Feet, FootAction
from plantar.mechanics.lip import GRAVITY
from plantar.sides import SIDES, Side, other_side

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
    centers: dict[Side, NDArray[np.float64]] = {}
    for side in SIDES:
        foot = feet.states[side]
        centers[side] = foot.position[:2] + foot.rotation[:2, :2].dot(foot.center)
    if feet.stance is not None:
        share = {feet.stance: 1.0, other_side(feet.stance): 0.0}
    else:
        line = centers["left"] - centers["right"]
        left = float((zmp - centers["right"]) @ line / (line @ line))
        left = min(1.0, max(0.0, left))
        share = {"left": left, "right": 1.0 - left}
    rest = zmp - (share["left"] * centers["left"] + share["right"] * centers["right"])
    return {side: FootAction(share[side] * force, centers[side] + rest) for side in SIDES}
