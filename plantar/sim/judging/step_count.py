"""Count the steps of a walk: by side, order and place, from where the feet truly stood."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from plantar.gait.plan.footsteps import Footstep
from plantar.kernels.judging.stand_watch import StandWatch
from plantar.layouts.layout import Side
from plantar.sides import SIDES
from plantar.sim.judging.walk_goal import NEAR_YAW, WalkGoal

__all__ = ["Stand", "StepCount"]

_CARRIES = 0.25
"""Share of the weight that makes a touch a stand: probes, taps and bounces carry less, or are followed by one."""


@dataclass(frozen=True)
class Stand:
    """One stand of a foot.

    Attributes:
        side: Which foot.
        touchdown: When it touched the ground in s.
        place: Its sole's origin (x, y) in m and heading in rad when it last carried a quarter of the weight.
    """

    side: Side
    touchdown: float
    place: tuple[float, float, float]


class StepCount:
    """Follows both feet through a walk.

    A step is taken when the foot of its side, after all steps before it, stands at its place: not where it touched
    first, but where it stood last before the other foot touched down. A foot that taps, probes or is put down anew
    therefore takes one step.

    Args:
        goal: The footsteps.
        weight: Weight of the robot in N.
        time_of: When a physics step began in s, by its number.

    Attributes:
        watch: Takes in where the feet are and what they carry after each physics step.
    """

    def __init__(self, goal: WalkGoal, weight: float, time_of: Callable[[int], float]) -> None:
        self.goal = goal
        self.watch = StandWatch(_CARRIES * weight)
        self._time_of = time_of

    @property
    def slip(self) -> float:
        """Largest slip in m of a foot while it carried a quarter of the weight."""
        return float(self.watch.slip)

    def last_stands(self) -> list[Stand]:
        """The stands that could be steps: of each foot the last one before the other foot touches down."""
        rows = [list(group)[-1] for _, group in groupby(self.watch.stands(), key=lambda row: row[1])]
        return [Stand(SIDES[foot], self._time_of(step), (x, y, yaw)) for step, foot, x, y, yaw in rows]

    def taken(self) -> tuple[int, str]:
        """How many steps were taken one after the other, and what became of the first that was not."""
        steps = self.goal.steps
        stands = self.last_stands()
        taken, missed = 0, ""
        for stand in stands:
            if taken == len(steps):
                break
            off = self._off(stand, taken)
            if off is None:
                taken, missed = taken + 1, ""
            elif not missed:
                missed = off
        if taken == len(steps):  # whatever they did since, both feet have to stand there in the end
            for side, k in self._last_steps().items():
                last = next((s for s in reversed(stands) if s.side == side), None)
                off = None if last is None else self._off(last, k)
                if off is not None and k < taken:
                    taken, missed = k, off
        if taken < len(steps) and not missed:
            missed = f"the {steps[taken].side} foot did not land for it"
        return taken, missed

    def _last_steps(self) -> Mapping[Side, int]:
        return {step.side: k for k, step in enumerate(self.goal.steps)}

    def _off(self, stand: Stand, k: int) -> str | None:
        """What keeps a stand from being step k; None where nothing does."""
        step = self.goal.steps[k]
        if stand.side != step.side:
            return f"the {stand.side} foot landed in its stead"
        return _far_from(self.goal.places(k, stand.touchdown), stand.place, step.side, self.goal.near)


def _far_from(places: Sequence[Footstep], place: tuple[float, float, float], side: Side, near: float) -> str | None:
    x, y, yaw = place
    offs = []
    for wanted in places:
        off = math.hypot(x - wanted.x, y - wanted.y)
        turn = abs(math.remainder(yaw - wanted.yaw, 2.0 * math.pi))
        if off <= near and turn <= NEAR_YAW:
            return None
        offs.append((off, turn))
    off, turn = min(offs)
    return f"the {side} foot stood {1e3 * off:.0f} mm and {np.degrees(turn):.1f} deg from its place"
