"""Footstep plans: where and in which order the soles are put down (T 4.1.3, step 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.layouts.layout import Side
from plantar.mechanics.rotation import level_rotation

__all__ = ["Footstep", "other_side", "straight_plan"]


@dataclass(frozen=True)
class Footstep:
    """A planned pose of one sole in the world frame.

    Attributes:
        side: Which foot.
        x: Sole frame origin, forward, in m.
        y: Sole frame origin, left, in m.
        yaw: Heading in rad.
        z: Height of the ground that the plan expects in m.
    """

    side: Side
    x: float
    y: float
    yaw: float = 0.0
    z: float = 0.0

    @property
    def position(self) -> NDArray[np.float64]:
        """Sole frame origin (3,) in m."""
        return np.array([self.x, self.y, self.z])

    @property
    def rotation_sole_to_world(self) -> NDArray[np.float64]:
        """Rotation (3, 3) of a level sole with this heading."""
        return level_rotation(self.yaw)


def other_side(side: Side) -> Side:
    """The other foot."""
    return "right" if side == "left" else "left"


def straight_plan(
    steps: int,
    *,
    length: float = 0.2,
    sideways: float = 0.0,
    width: float = 0.17,
    first: Side = "left",
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    height: float = 0.0,
) -> tuple[dict[Side, Footstep], tuple[Footstep, ...]]:
    """A straight walk: forward, backward, sideways or in place; the last step closes the feet.

    Args:
        steps: Number of steps, 0 or more.
        length: Distance in m by which a step leads the other foot, negative for backward.
        sideways: Lateral distance in m by which each opening step leads, positive to the left.
        width: Distance in m of the sole frames' origins when the feet stand side by side.
        first: The foot that moves first; a sideways walk starts with the foot it moves towards.
        start: Pose (x, y, yaw) in m, m, rad of the midpoint between the feet at the start.
        height: Height of the ground in m.

    Returns:
        The standing feet at the start, and the steps in order.

    Raises:
        InputError: If a number is not finite or outside what is allowed.

    Example:
        >>> feet, plan = straight_plan(3, length=0.2)
        >>> [(s.side, round(s.x, 3), round(s.y, 3)) for s in plan]
        [('left', 0.2, 0.085), ('right', 0.4, -0.085), ('left', 0.4, 0.085)]
    """
    if steps < 0:
        raise InputError(f"steps is {steps}; allowed: 0 or more")
    if not all(math.isfinite(v) for v in (length, sideways, width, height, *start)) or width <= 0.0:
        raise InputError("a footstep plan needs finite numbers and a width above 0")
    x0, y0, yaw = start
    c, s = math.cos(yaw), math.sin(yaw)

    def place(side: Side, forward: float, left: float) -> Footstep:
        lateral = left + (0.5 if side == "left" else -0.5) * width
        return Footstep(side, x0 + c * forward - s * lateral, y0 + s * forward + c * lateral, yaw, height)

    feet: dict[Side, Footstep] = {"left": place("left", 0.0, 0.0), "right": place("right", 0.0, 0.0)}
    if sideways != 0.0:
        first = "left" if sideways > 0.0 else "right"
    plan: list[Footstep] = []
    side: Side = first
    forward = 0.0
    shift = {"left": 0.0, "right": 0.0}
    for k in range(steps):
        if k < steps - 1:
            forward += length
        leads = side == first
        # Sideways: the leading foot opens by one step, the other one closes up to it.
        shift[side] = shift[other_side(side)] + (sideways if leads and k < steps - 1 else 0.0)
        plan.append(place(side, forward, shift[side]))
        side = other_side(side)
    return feet, tuple(plan)
