"""Count the steps of a walk: by side, order and place, from where the feet truly stood."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
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


@dataclass
class Stand:
    """One stand of a foot.

    Attributes:
        side: Which foot.
        touchdown: When it touched the ground in s.
        place: Its sole's origin (x, y) in m and heading in rad when it last carried a quarter of the weight; None
            where it never did.
        slip: Largest distance in m of the origin from where it was when it first did.
    """

    side: Side
    touchdown: float
    place: tuple[float, float, float] | None = None
    slip: float = 0.0


class StepCount:
    """Follows both feet through a walk.

    A step is taken when the foot of its side, after all steps before it, stands at its place: not where it touched
    first, but where it stood last before the other foot touched down. A foot that taps, probes or is put down anew
    therefore takes one step.

    Args:
        goal: The footsteps.
        weight: Weight of the robot in N.

    Attributes:
        watch: Takes in where the feet are and what they carry at each control tick.
    """

    def __init__(self, goal: WalkGoal, weight: float) -> None:
        self.goal = goal
        self.watch = StandWatch(_CARRIES * weight)
        self.stands: list[Stand] = []
        self._standing: dict[Side, Stand] = {side: Stand(side, -math.inf) for side in SIDES}

    def touch(self, side: Side, time: float) -> None:
        """A foot touches the ground after it was in the air.

        Args:
            side: Which foot.
            time: When, in s.
        """
        self._hand_over(side)
        self.watch.begin(SIDES.index(side))
        self._standing[side] = Stand(side, time)
        self.stands.append(self._standing[side])

    def _hand_over(self, side: Side) -> None:
        """Let the stand of a foot know what was found of it so far."""
        stand, foot = self._standing[side], SIDES.index(side)
        if self.watch.stood[foot]:
            x, y, yaw = np.asarray(self.watch.place)[foot].tolist()
            stand.place, stand.slip = (x, y, yaw), float(self.watch.slip[foot])

    @property
    def slip(self) -> float:
        """Largest slip in m of a foot while it carried a quarter of the weight."""
        for side in SIDES:
            self._hand_over(side)
        stands = [*self.stands, *self._standing.values()]
        return max((s.slip for s in stands), default=0.0)

    def last_stands(self) -> list[Stand]:
        """The stands that could be steps: of each foot the last one before the other foot touches down."""
        for side in SIDES:
            self._hand_over(side)
        carrying = [s for s in self.stands if s.place is not None]
        return [list(group)[-1] for _, group in groupby(carrying, key=lambda s: s.side)]

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
        assert stand.place is not None
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
