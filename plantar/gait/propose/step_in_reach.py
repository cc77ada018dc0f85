"""A shorter step from a foothold that carries the body far behind its ankle.

A foot whose heel alone stands on ground has the body behind it, and the other one has the farther to go: at the end of
its swing the leg is straight, its foot hangs in the air, and the body falls onto it. A step is in reach that the foot
can end while the body rests over the stance foot's load, whenever it does:

    d <= sqrt((0.985 (thigh + shank))^2 - (h + r)^2 - a^2)

with d from that load ahead to the ankle's new place, a from its hip to the side, h the hip over the ankle and r what
the robot has risen for its knee (`plantar.gait.contact.standing_leg`). What is beyond is taken off this step, as far as
the next one, which is longer by as much, is in reach, too.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.foot_contacts import FootholdFound
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority, Tick, was_applied

# chosen: of the leg that a step is taken shorter at most: the next one, longer by as much, has to stay about its place
_MOST = 1 / 20


class StepInReach:
    """Shortens the step after a partial foothold, once, as its swing begins.

    `limits`: of each ankle, with its leg; `middles`: point (2,) of each sole in m that a whole one is loaded at;
    `least`: least change in m; `leg` in m.
    """

    priority = Priority.FOOTHOLD

    def __init__(
        self,
        limits: Mapping[Side, AnkleLimits],
        middles: Mapping[Side, NDArray[np.float64]],
        least: float,
        leg: float,
    ) -> None:
        self._limits = limits
        self._middles = middles
        self._most = _MOST * leg
        self._least = least
        self._found: FootholdFound | None = None
        self._step = -1
        self._proposed: PlanChange | None = None

    def propose(self, tick: Tick) -> PlanChange | None:
        """The step that begins, in reach, if it is not."""
        for found in tick.found:
            self._found = found
        if self._proposed is not None:
            done = was_applied(self._proposed, tick) or tick.phase.step != self._step
            self._proposed = None if done else self._proposed
        else:
            self._proposed = self._in_reach(tick)
        return self._proposed

    def _in_reach(self, tick: Tick) -> PlanChange | None:
        phase = tick.phase
        stands = self._found
        if phase.kind != PhaseKind.SINGLE_SUPPORT or phase.step == self._step or stands is None or stands.whole:
            return None
        if stands.step != phase.step - 1 or stands.step < tick.plan.first:
            return None
        self._step = phase.step
        planned = tick.plan.foothold(phase.step)
        here = self._limits.get(stands.side)
        there = self._limits.get(planned.side)
        if here is None or there is None:
            return None
        foot = tick.plan.foothold(stands.step)
        into_sole = foot.rotation_sole_to_world[:2, :2].T
        step = into_sole @ (planned.position[:2] - foot.position[:2])
        less = -here.spare_reach(into_sole @ (stands.vrp - foot.position[:2]), step, stands.rise)
        less = min(less, self._most, step.item(0))  # a step to the side, or back, is not shortened ahead
        if phase.step + 1 < tick.plan.count:
            later = into_sole @ (tick.plan.foothold(phase.step + 1).position[:2] - planned.position[:2])
            less = min(less, there.spare_reach(self._middles[planned.side], later))
        if less < self._least:
            return None
        x, y = (planned.position[:2] - less * foot.rotation_sole_to_world[:2, 0]).tolist()
        return PlanChange("a step within reach", phase.step, foothold=replace(planned, x=x, y=y))
