"""Is stepping on what the foot met safe? (T 4.3.2, Fig. 44-46)

The foot presses on unexpected ground with part of the weight, and one of two rules decides:

    a) force_torque: a flat foot on flat ground makes no moment;   |eta_s| >= epsilon_t refuses the foothold
    b) skin: a foothold has to support most of the sole;           A_p / A_s <= epsilon_A refuses it

A refused foothold moves sideways, back or forward, clear of the obstacle's box (Fig. 45).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import choice, fixed, number, share, whole
from plantar.geometry.polygon import area
from plantar.layouts.layout import Side, SoleLayout
from plantar.sensing.proximity import cells_polygon


class FeasibilityRules(
    Part,
    table="feasibility",
    needs={"control.pfc": (True,), "control.feasibility": ("skin", "force_torque")},
    given_by={"rule": "control.feasibility"},
):
    """Step feasibility.

    Attributes:
        rule: "skin" or "force_torque".
        at: "sight" refuses what a foot over its place sees under too little of the sole, before it touches, and presses
            on the rest; "probe" always presses before deciding; "impact" decides by the touch's first readings (T Table
            3). What is seen is the height contour of the nearest ground (T 4.2.7).
        area_ratio: epsilon_A: no larger share is taken; above 1 none.
        hold: Single support's extension in s for that.
        active_force: Mean force in N of a carrying taxel, above noise.
        near: Taxel's distance in m at touchdown that counts as supported.
        clearance: Between sole and obstacle in m.
        swing_time: Of the swing around it in s.
        outward: Largest move in m.
        forward: Largest move forward.
        sideways_cost: Length factor of sideways moves, which load the stance hip.
        backward: Largest move backward.
        attempts: Tries of a step before a stop.
    """

    rule: str = choice("skin", "force_torque")
    at: str = choice("sight", "probe", "impact")
    # chosen: epsilon_A of T 4.3.2 is not printed; half a sole and what gains of taxels leave
    area_ratio: float = number(0.6, "1", 0, 2)
    # epsilon_t in N m: a foothold that makes this moment at the ankle is refused
    ankle_moment: float = fixed(0.0379, "weight sole")  # chosen: epsilon_t of T 4.3.2 is not printed; 8 N m on h1
    # Height in m above expected ground from which it is checked; chosen: 20 mm on h1, the lowest obstacle
    surprise: float = fixed(1 / 30, "leg")
    hold: float = share(2.83, "beat", 0.01, 10)  # chosen: 0.7 s on h1
    probe_force: float = fixed(0.154, "weight")  # Pressing force in N; chosen: 130 N on h1
    # nature: Force in N that is an impact: 70 N on a robot of 86 kg (T 4.4.5)
    impact_force: float = fixed(0.083, "weight")
    # For how long in s it is probed, once it is there; chosen: 0.12 s on h1, thirty readings
    probe_time: float = fixed(0.485, "beat")
    # For how long in s the touch is read at an impact: taxels' noise averages out
    impact_time: float = fixed(0.2, "beat")  # chosen: 50 ms, twelve readings
    # For how long in s it may take to come; chosen: 0.25 s on h1, twice `probe_time`
    probe_limit: float = fixed(1.01, "beat")
    reserve: float = fixed(2.02, "beat")  # Least single support in s after the check; chosen: 0.5 s on h1
    active_force: float = share(0.00154, "weight", 0, 10000)  # chosen: 1.3 N on h1
    near: float = share(0.005, "leg", 0, 0.05)  # chosen: 3 mm on h1, 1.5 of a reading's noise
    # Depth in m below the nearest ground from which a taxel has none to stand on; chosen: as `contact.step_down`
    step_down: float = fixed(0.02, "leg")
    clearance: float = share(1 / 24, "leg", 0, 0.2)  # chosen: 25 mm on h1
    swing_time: float = share(5.66, "beat", 0.2, 10)  # nature: T 4.4.5's tss of HRP-2, 1.4 s
    # Duration in s of the swing back next to the other foot; chosen: 2.2 s on h1
    return_time: float = fixed(8.9, "beat")
    outward: float = share(1 / 3, "leg", 0, 1)  # chosen: 0.2 m on h1
    inward: float = fixed(0.025, "leg")  # Largest move inwards in m; chosen: 15 mm: beyond, feet collide
    forward: float = share(2 / 15, "leg", 0, 1)  # chosen: 80 mm on h1
    sideways_cost: float = number(2.0, "1", 0.01, 100)  # chosen: at least 1
    backward: float = share(0.4, "leg", 0, 1)  # chosen: 0.24 m on h1, a step and a fifth
    attempts: int = whole(2, "attempts", 0, 100)  # chosen: at least one


@dataclass(frozen=True)
class Foothold:
    """What a probe found.

    `moment` at the ankle in N m while pressing; None without sensor; `polygon_in_sole`: support (k, 2), sole frame, in
    m.
    """

    feasible: bool
    area_ratio: float
    moment: float | None
    polygon_in_sole: NDArray[np.float64]


class FootholdProbe:
    """Measurements of a foot on unexpected ground."""

    def __init__(self, layout: SoleLayout, rules: FeasibilityRules) -> None:
        self.layout = layout
        self.rules = rules
        self._force = np.zeros(len(layout))
        self._near = np.zeros(len(layout), dtype=bool)
        self._moment = np.zeros(2)
        self._count = 0
        self._moments = 0

    def update_view(self, distance: NDArray[np.float64]) -> None:
        """Store taxels' distances (n,) in m at touchdown; inf or NaN: unseen."""
        with np.errstate(invalid="ignore"):
            self._near = distance < self.rules.near

    def update_load(self, force: NDArray[np.float64], moment: NDArray[np.float64] | None) -> None:
        """Add a reading. `force`: taxels' (n,) in N; NaN if dead; `moment` at the ankle (2,) in N m, or None."""
        self._count += 1
        self._force += np.nan_to_num(force)
        if moment is not None:
            self._moments += 1
            self._moment += moment

    def verdict(self) -> Foothold:
        """The rule's decision on all readings."""
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


def seen_foothold(layout: SoleLayout, distance: NDArray[np.float64], rules: FeasibilityRules) -> Foothold | None:
    """Returns the foothold that a sole's taxels see at distances (n,) in m, by its share of the sole: the contour of
    what is nearest (T 4.2.7 corrected); dead taxels (NaN) count as ground. None if fewer than three see any.
    """
    nearest = np.sort(distance)[:3].mean()  # NaN comes last; three: one reading may be wrong
    if not math.isfinite(nearest):
        return None
    polygon = cells_polygon(layout, ~(distance > nearest + rules.step_down))
    ratio = area(polygon) / layout.sole_area
    return Foothold(ratio > rules.area_ratio, ratio, None, polygon)


def way_around(
    obstacle: NDArray[np.float64], outline: NDArray[np.float64], side: Side, rules: FeasibilityRules
) -> NDArray[np.float64] | None:
    """Returns the easiest foothold move (2,) in m clear of an obstacle (T Fig. 45), or None.

    `obstacle`: points (k, 2), sole frame, in m; `outline`: sole's (m, 2), own frame, in m.

    Example:
        >>> sole = np.array([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
        >>> rules = FeasibilityRules(clearance=0.02)
        >>> way_around(np.array([[-0.09, -0.03], [0.09, 0.03]]), sole, "left", rules).round(3).tolist()
        [-0.21, 0.0]
    """
    if not len(obstacle):
        return None
    low = obstacle.min(axis=0)
    high = obstacle.max(axis=0)
    first = outline.min(axis=0)
    last = outline.max(axis=0)
    gap = rules.clearance
    left = float(high[1] - first[1] + gap)
    right = float(low[1] - last[1] - gap)
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
    """Returns a later foothold's forward move in m clear of an obstacle; 0 if too far.

    `obstacle`: points (k, 2), frame of the refused sole, in m; `outline`: sole's (m, 2), own frame, in m; `ahead`:
    later foothold (2,), same frame, in m.

    Example:
        >>> sole = np.array([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
        >>> rules = FeasibilityRules(clearance=0.02)
        >>> round(room_ahead(np.array([[-0.09, -0.03], [0.09, 0.03]]), sole, [0.18, 0.0], rules), 3)
        0.03
    """
    moved = outline + np.asarray(ahead, dtype=float)
    low = obstacle.min(axis=0)
    high = obstacle.max(axis=0)
    first = moved.min(axis=0)
    last = moved.max(axis=0)
    gap = rules.clearance
    if first[1] >= high[1] + gap or last[1] <= low[1] - gap or last[0] <= low[0] - gap:
        return 0.0
    missing = float(high[0] + gap - first[0])
    return missing if 0.0 < missing <= rules.forward else 0.0
