"""Load transfer by the plan: the pendulum's force, shared between the feet by where the desired ZMP lies."""

from __future__ import annotations

import numpy as np

from gait.balance.law import BalanceState, Feet, FootAction, FootState
from plantar.mechanics.lip import GRAVITY
from plantar.sides import Side

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
    # Plain numbers: on two of them an array costs ten times as much, and this runs at every tick.
    x, y = feet.frame.to_command(balanced.zmp_desired).tolist()
    ax, ay = balanced.com_acceleration.tolist()
    (lx, ly), (rx, ry) = _center(feet.states["left"]), _center(feet.states["right"])
    if feet.stance is not None:
        share = 1.0 if feet.stance == "left" else 0.0
    else:
        dx, dy = lx - rx, ly - ry
        share = min(1.0, max(0.0, ((x - rx) * dx + (y - ry) * dy) / (dx * dx + dy * dy)))
    other = 1.0 - share
    fx, fy, fz = mass * ax, mass * ay, mass * GRAVITY
    x, y = x - (share * lx + other * rx), y - (share * ly + other * ry)
    return {
        "left": FootAction(np.array((share * fx, share * fy, share * fz)), np.array((lx + x, ly + y))),
        "right": FootAction(np.array((other * fx, other * fy, other * fz)), np.array((rx + x, ry + y))),
    }


def _center(foot: FootState) -> tuple[float, float]:
    """Point (x, y) of the command frame in m at which a foot is to be loaded."""
    (x, y, _), (cx, cy) = foot.position.tolist(), foot.center.tolist()
    (xx, xy, _), (yx, yy, _), _ = foot.rotation.tolist()
    return x + (xx * cx + xy * cy), y + (yx * cx + yy * cy)
