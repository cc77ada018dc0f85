"""The goal of a walk: footsteps planned at the start, and moves.

A move needs a report before landing, a reason, and a place that a detour explains.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.sides import SIDES, other_side
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.plan_change import MovedStep
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.layouts.layout import Side

Way = tuple[float, float, float]
"""From one foothold to the next: forward and left in m, in the frame of the first, and the turn in rad."""

_NEAR = 1 / 12  # Distance in leg lengths within which a foot has reached a place: 50 mm for H1

NEAR_YAW = math.radians(5.0)
"""Angle in rad within which it has the place's heading."""

# Distance in leg lengths by which a footstep may be moved against the one before it: twice around an obstacle (0.4
# each)
_DETOUR = 5 / 6

_DETOUR_YAW = math.radians(30.0)
_AWAY = 0.5
_DRIFT = 0.25
"""Distance in leg lengths by which it may be moved in all, and share of the way walked so far by which further: a
detour of 0.4 legs early in a walk, two of them later, a strip that turns away by 10 degrees; no walk that ends where it
began."""


@dataclass(frozen=True)
class _Move:
    time: float
    place: Footstep
    reason: str


class WalkGoal:
    """Where feet must be put down, in order.

    `leg`: leg length in m; `led`: how far in m the robot is led; moves may add that. Attributes `near`: distance in m
    that counts as reached; `refused`: moves without reason, not finite, or too far.
    """

    def __init__(
        self,
        feet: Mapping[Side, Footstep],
        steps: Sequence[Footstep],
        leg: float = REFERENCE_BODY.leg,
        led: float = 0.0,
    ) -> None:
        self.steps = tuple(steps)
        self.near = _NEAR * leg
        self.leg = leg
        self._led = led
        self.refused = 0
        self._feet = dict(feet)
        self._moves: dict[int, list[_Move]] = {}
        self._now = list(self.steps)
        self._way = self._ways()

    def _ways(self) -> list[float]:
        standing = dict(self._feet)
        ways = []
        way = 0.0
        for step in self.steps:
            before = standing[step.side]
            way += 0.5 * math.hypot(step.x - before.x, step.y - before.y)
            standing[step.side] = step
            ways.append(way)
        return ways

    def move(self, time: float, moved: Sequence[MovedStep]) -> None:
        """Take footsteps `moved` by the controller at `time` in s (judge's clock)."""
        wanted = list(self._now)
        known = [m for m in moved if 0 <= m.step < len(wanted) and m.reason.strip()]
        known = [m for m in known if math.isfinite(m.x) and math.isfinite(m.y) and math.isfinite(m.yaw)]
        self.refused += len(moved) - len(known)
        last = {m.step: m for m in known}
        for m in last.values():
            wanted[m.step] = replace(wanted[m.step], x=float(m.x), y=float(m.y), yaw=float(m.yaw))
        for k, m in sorted(last.items()):
            if self._explained(k, wanted):
                self._moves.setdefault(k, []).append(_Move(time, wanted[k], m.reason))
                self._now[k] = wanted[k]
            else:
                wanted[k] = self._now[k]
                self.refused += 1

    def _explained(self, k: int, places: Sequence[Footstep]) -> bool:
        def from_the_one_before(steps: Sequence[Footstep]) -> tuple[float, float]:
            before = steps[k - 1] if k else self._before(0)
            return steps[k].x - before.x, steps[k].y - before.y

        there = from_the_one_before(places)
        planned = from_the_one_before(self.steps)
        step = places[k]
        original = self.steps[k]
        away = math.hypot(step.x - original.x, step.y - original.y)
        turned = abs(math.remainder(step.yaw - original.yaw, 2.0 * math.pi))
        detour = _DETOUR * self.leg
        most = _AWAY * self.leg + _DRIFT * self._way[k] + self._led
        return math.dist(there, planned) <= detour and away <= most and turned <= _DETOUR_YAW

    def ways(self, step: int, time: float, before: float) -> tuple[Way, Way | None]:
        """Returns a `step` from the foothold before: as planned at the start, and as moved last or None.

        Moves after its touchdown `time` in s do not count, nor the step before's after `before`.
        """
        planned = _way(self._before(step), self.steps[step])
        if self._last_move(step, time) is None:
            return planned, None
        begin = self._before(step) if step == 0 else self._place(step - 1, before)
        return planned, _way(begin, self._place(step, time))

    def _before(self, step: int) -> Footstep:
        return self.steps[step - 1] if step else self._feet[other_side(self.steps[0].side)]

    def _last_move(self, step: int, time: float) -> _Move | None:
        reported = [m for m in self._moves.get(step, ()) if m.time <= time]
        return reported[-1] if reported else None

    def _place(self, step: int, time: float) -> Footstep:
        move = self._last_move(step, time)
        return self.steps[step] if move is None else move.place

    def reason(self, step: int, time: float) -> str:
        """Returns why a `step` was moved last until `time` in s, or ""."""
        move = self._last_move(step, time)
        return "" if move is None else move.reason

    def start(self) -> Footstep:
        """The stance foot of the first step."""
        return self._before(0)

    def way_to(self, step: int) -> float:
        """Planned way in m of the feet's middle with a step."""
        return self._way[step]

    def end(
        self, centers: Mapping[Side, NDArray[np.float64]], *, at_start: bool = False
    ) -> tuple[NDArray[np.float64], float]:
        """Returns point (2,) in m between soles' `centers` (2,) and heading in rad, as planned last or `at_start`."""
        last = dict(self._feet)
        steps = self.steps if at_start else self._now
        for step in steps:
            last[step.side] = step
        middle = 0.5 * sum(vrp_of_step(last[side], centers[side]) for side in SIDES)
        return np.asarray(middle), steps[-1].yaw if steps else self._feet["left"].yaw

    def summary(self) -> list[dict[str, object]]:
        """Moved footsteps: how far in m, when last, why."""
        rows: list[dict[str, object]] = []
        for k, moves in sorted(self._moves.items()):
            move = moves[-1]
            planned = self.steps[k]
            moved = math.hypot(move.place.x - planned.x, move.place.y - planned.y)
            rows.append({"step": k, "moved_m": round(moved, 4), "time_s": round(move.time, 3), "reason": move.reason})
        return rows


def _way(before: Footstep, step: Footstep) -> Way:
    c = math.cos(before.yaw)
    s = math.sin(before.yaw)
    dx = step.x - before.x
    dy = step.y - before.y
    return c * dx + s * dy, c * dy - s * dx, math.remainder(step.yaw - before.yaw, 2.0 * math.pi)
