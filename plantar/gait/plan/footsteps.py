"""Footsteps: where and in which order soles are put down (T 4.1.3, step 1)."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side, other_side
from plantar.errors import InputError
from plantar.mechanics.rotation import level_rotation


@dataclass(frozen=True)
class Footstep:
    """Planned sole pose, world frame.

    `x`: sole origin forward in m; `y`: left in m; `yaw`: heading in rad; `z`: expected ground height in m.
    """

    side: Side
    x: float
    y: float
    yaw: float = 0.0
    z: float = 0.0

    @property
    def position(self) -> NDArray[np.float64]:
        """Sole origin (3,) in m."""
        return np.array([self.x, self.y, self.z])

    @property
    def rotation_sole_to_world(self) -> NDArray[np.float64]:
        """Rotation (3, 3) of a level sole."""
        return level_rotation(self.yaw)


def straight_plan(
    steps: int,
    *,
    length: float = 0.2,  # nature: T 4.4.5
    sideways: float = 0.0,
    width: float = 0.17,  # nature: h1's, as its file states it
    first: Side = "left",
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    height: float = 0.0,
    closing: bool = False,
    climb: float = 0.0,
) -> tuple[dict[Side, Footstep], tuple[Footstep, ...]]:
    """Straight walk in any direction or in place; the last step closes the feet.

    Args:
        steps: 0 or more.
        length: Lead over the other foot in m, negative for backward.
        sideways: Lateral lead of opening steps in m, positive left.
        width: Between sole origins side by side in m.
        start: Initial midpoint (x, y, yaw) of the feet in m, m, rad.
        height: Of the ground in m.
        climb: Of each place ahead over the last in m, up to the middle of the walk, then down.

    Returns:
        Initial feet, and steps in order.

    Example:
        >>> feet, plan = straight_plan(3, length=0.2)
        >>> [(s.side, round(s.x, 3), round(s.y, 3)) for s in plan]
        [('left', 0.2, 0.085), ('right', 0.4, -0.085), ('left', 0.4, 0.085)]
    """
    if steps < 0:
        raise InputError(f"steps is {steps}; allowed: 0 or more")
    if not all(math.isfinite(v) for v in (length, sideways, width, height, climb, *start)) or width <= 0.0:
        raise InputError("a footstep plan needs finite numbers and a width above 0")
    x0, y0, yaw = start
    c = math.cos(yaw)
    s = math.sin(yaw)

    last = max(0, steps - 1)  # places ahead, of which two feet share the last
    places = (last + 1) // 2 if closing else last

    def place(side: Side, ahead: int, left: float) -> Footstep:
        forward = ahead * length
        lateral = left + (0.5 if side == "left" else -0.5) * width
        z = height + climb * min(ahead, places + places % 2 - ahead)
        return Footstep(side, x0 + c * forward - s * lateral, y0 + s * forward + c * lateral, yaw, z)

    feet: dict[Side, Footstep] = {"left": place("left", 0, 0.0), "right": place("right", 0, 0.0)}
    if sideways != 0.0:
        first = "left" if sideways > 0.0 else "right"
    plan: list[Footstep] = []
    side: Side = first
    ahead = 0
    shift = {"left": 0.0, "right": 0.0}
    for k in range(steps):
        leads = side == first
        if k < steps - 1 and (leads or not closing):
            ahead += 1
        # Sideways: the leading foot opens by one step, the other one closes up to it.
        shift[side] = shift[other_side(side)] + (sideways if leads and k < steps - 1 else 0.0)
        plan.append(place(side, ahead, shift[side]))
        side = other_side(side)
    return feet, tuple(plan)
