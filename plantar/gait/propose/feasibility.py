"""Is it safe to step on what the foot has met? (T 4.3.2, Fig. 44-46)

A swing that meets ground where none is expected does not trust it. The single support is made longer, the foot presses
with a part of the weight that the stance foot can spare, and one of two rules decides from what it feels:

    a) force_torque: a flat foot on flat ground makes no moment;   |eta_s| >= epsilon_t refuses the foothold
    b) skin: a foothold has to support most of the sole;           A_p / A_s <= epsilon_A refuses it

A refused foothold is walked around: the sole's outline is moved sideways, back or forward, whichever is easiest, until
it clears the box around the obstacle that the taxels show (Fig. 45), and the foot is put down there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.geometry.polygon import area
from plantar.layouts.layout import Side, SoleLayout
from plantar.sensing.proximity import cells_polygon
from plantar.settings.part import Part
from plantar.settings.schema import choice, fixed, number, share, whole

__all__ = ["FeasibilityRules", "Foothold", "FootholdProbe", "room_ahead", "way_around"]


class FeasibilityRules(
    Part,
    table="feasibility",
    needs={"control.pfc": (True,), "control.feasibility": ("skin", "force_torque")},
    given_by={"rule": "control.feasibility"},
):
    """Rules of step feasibility.

    Attributes:
        rule: "skin" or "force_torque".
        area_ratio: epsilon_A: a foothold that supports no more than this share of the sole is refused; above 1 none is
            accepted.
        surprise: How much higher than expected in m ground has to be to be checked.
        hold: By how much the single support is made longer for that, in s.
        probe_force: Force in N that the foot presses with.
        reserve: How long in s the single support goes on after that at least.
        active_force: Mean force in N of a taxel that carries, above what its noise adds up to.
        near: Distance in m of a taxel from the ground, seen at touchdown, that counts as supported.
        clearance: Distance in m that the sole keeps from an obstacle.
        swing_time: Duration in s of the swing around it.
        outward: How far outwards a foothold may be moved in m.
        inward: How far inwards.
        forward: How far forward.
        sideways_cost: How many times its length a move sideways counts: it asks the most of the stance hip.
        backward: How far back.
        attempts: How often one step is planned anew; then the robot stops.
    """

    rule: str = choice("skin", "force_torque")
    area_ratio: float = number(0.8, "1", 0, 2)
    # epsilon_t in N m: a foothold that makes this moment at the ankle is refused
    ankle_moment: float = fixed(0.0411, "weight sole")
    surprise: float = share(1 / 30, "leg", 0.001, 0.1)
    hold: float = share(2.83, "beat", 0.01, 10)
    probe_force: float = share(0.154, "weight", 1, 10000)
    probe_time: float = fixed(0.485, "beat")  # For how long in s it is probed, once it is there
    probe_limit: float = fixed(1.01, "beat")  # For how long in s it may take to come
    reserve: float = share(2.02, "beat", 0, 5)
    active_force: float = share(0.00154, "weight", 0, 10000)
    near: float = share(0.005, "leg", 0, 0.05)
    clearance: float = share(1 / 24, "leg", 0, 0.2)
    swing_time: float = share(5.66, "beat", 0.2, 10)
    return_time: float = fixed(8.9, "beat")  # Duration in s of the swing back beside the other foot
    outward: float = share(1 / 3, "leg", 0, 1)
    inward: float = share(0.025, "leg", 0, 1)
    forward: float = share(2 / 15, "leg", 0, 1)
    sideways_cost: float = number(2.0, "1", 0.01, 100)
    backward: float = share(0.4, "leg", 0, 1)
    attempts: int = whole(2, "attempts", 0, 100)


@dataclass(frozen=True)
class Foothold:
    """What a probe found.

    Attributes:
        feasible: Whether the rule lets the robot step on it.
        area_ratio: A_p / A_s.
        moment: Size of the moment at the ankle in N m while it pressed; None without a sensor.
        polygon_in_sole: Supporting polygon (k, 2) in the sole frame in m.
    """

    feasible: bool
    area_ratio: float
    moment: float | None
    polygon_in_sole: NDArray[np.float64]


class FootholdProbe:
    """Gathers what a foot senses that presses on something unexpected.

    Args:
        layout: Its sole, n taxels.
        rules: Rules.
    """

    def __init__(self, layout: SoleLayout, rules: FeasibilityRules) -> None:
        self.layout = layout
        self.rules = rules
        self._force = np.zeros(len(layout))
        self._near = np.zeros(len(layout), dtype=bool)
        self._moment = np.zeros(2)
        self._count = self._moments = 0

    def update_view(self, distance: NDArray[np.float64]) -> None:
        """Take in how far the taxels were from the ground when the foot touched it.

        Args:
            distance: Distances (n,) in m, less their bias; inf or NaN where nothing is seen.
        """
        with np.errstate(invalid="ignore"):
            self._near = distance < self.rules.near

    def update_load(self, force: NDArray[np.float64], moment: NDArray[np.float64] | None) -> None:
        """Take in one reading.

        Args:
            force: Forces (n,) of the taxels in N; NaN for a dead one.
            moment: Moment (2,) at the ankle in N m, from its force-torque sensor, or None.
        """
        self._count += 1
        self._force += np.nan_to_num(force)
        if moment is not None:
            self._moments += 1
            self._moment += moment

    def verdict(self) -> Foothold:
        """What the rule says of all that was sensed."""
        count = max(1, self._count)
        active = (self._force / count > self.rules.active_force) | self._near
        polygon = cells_polygon(self.layout, active)
        ratio = area(polygon) / self.layout.sole_area
        size = math.hypot(*(self._moment / self._moments).tolist()) if self._moments else None
        if self.rules.rule == "skin":
            feasible = ratio > self.rules.area_ratio
        else:
            feasible = size is not None and size < self.rules.ankle_moment
        return Foothold(feasible, ratio, size, polygon)


def way_around(
    obstacle: NDArray[np.float64], outline: NDArray[np.float64], side: Side, rules: FeasibilityRules
) -> NDArray[np.float64] | None:
    """The easiest move of a foothold that clears an obstacle (T Fig. 45: obstacle width and clearance).

    Args:
        obstacle: Points (k, 2) of the obstacle in the sole frame in m.
        outline: Outline (m, 2) of the sole in the sole frame in m.
        side: Which foot.
        rules: How far a foothold may be moved which way.

    Returns:
        Move (2,) along the sole frame's axes in m; None where no move is allowed or nothing is known of the obstacle.

    Example:
        >>> sole = np.array([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
        >>> rules = FeasibilityRules(clearance=0.02)
        >>> way_around(np.array([[-0.09, -0.03], [0.09, 0.03]]), sole, "left", rules).round(3).tolist()
        [-0.21, 0.0]
    """
    if not len(obstacle):
        return None
    low, high = obstacle.min(axis=0), obstacle.max(axis=0)
    first, last = outline.min(axis=0), outline.max(axis=0)
    gap = rules.clearance
    left, right = float(high[1] - first[1] + gap), float(low[1] - last[1] - gap)
    out, into = (rules.outward, rules.inward) if side == "left" else (rules.inward, rules.outward)
    moves = [
        (0.0, left, out),
        (0.0, right, into),
        (float(high[0] - first[0] + gap), 0.0, rules.forward),
        (float(low[0] - last[0] - gap), 0.0, rules.backward),
    ]
    cost = rules.sideways_cost
    allowed = [(abs(x) + cost * abs(y), x, y) for x, y, most in moves if abs(x + y) <= most]
    if not allowed:
        return None
    _, x, y = min(allowed)
    return np.array([x, y])


def room_ahead(
    obstacle: NDArray[np.float64], outline: NDArray[np.float64], ahead: ArrayLike, rules: FeasibilityRules
) -> float:
    """How much further ahead a later foothold of the same foot has to be to clear an obstacle that stays behind it.

    Args:
        obstacle: Points (k, 2) of the obstacle in the sole frame of the foothold that was refused, in m.
        outline: Outline (m, 2) of the sole in its frame in m.
        ahead: Where (2,) the later foothold is planned, in the same frame in m.
        rules: Clearance, and how far forward a foothold may be moved.

    Returns:
        Distance in m along the sole's x axis; 0 where the sole clears the obstacle, or would have to go too far.

    Example:
        >>> sole = np.array([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
        >>> rules = FeasibilityRules(clearance=0.02)
        >>> round(room_ahead(np.array([[-0.09, -0.03], [0.09, 0.03]]), sole, [0.18, 0.0], rules), 3)
        0.03
    """
    moved = outline + np.asarray(ahead, dtype=float)
    low, high = obstacle.min(axis=0), obstacle.max(axis=0)
    first, last = moved.min(axis=0), moved.max(axis=0)
    gap = rules.clearance
    if first[1] >= high[1] + gap or last[1] <= low[1] - gap or last[0] <= low[0] - gap:
        return 0.0
    missing = float(high[0] + gap - first[0])
    return missing if 0.0 < missing <= rules.forward else 0.0
