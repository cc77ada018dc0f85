"""Load transfer by the plan: the pendulum's force, shared between the feet by the desired ZMP."""

from __future__ import annotations

from plantar.gait.balance.law import BalanceState, Feet, FootAction
from plantar.kernels.gait.dcm_feedback import shared_load
from plantar.mechanics.lip import GRAVITY
from plantar.sides import Side

__all__ = ["transferred"]


def transferred(balanced: BalanceState, mass: float, feet: Feet) -> dict[Side, FootAction]:
    """Share the force of the pendulum, m (a_x, a_y, g), between the feet.

    In double support the desired ZMP on the line between the feet's centres gives the shares; its distance from that
    line moves each foot's centre of pressure.

    Args:
        balanced: Desired ZMP and CoM acceleration.
        mass: Robot mass in kg.
        feet: The feet.

    Returns:
        Action of each foot.
    """
    left, right, zmp = feet.states["left"], feet.states["right"], feet.frame.to_command(balanced.zmp_desired)
    stance = 0 if feet.stance is None else 1 if feet.stance == "left" else 2
    force, place, other_force, other_place = shared_load(
        zmp, balanced.com_acceleration, mass, GRAVITY, left, right, stance
    )
    return {"left": FootAction(force, place), "right": FootAction(other_force, other_place)}
