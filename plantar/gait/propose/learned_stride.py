"""Learned strides (beyond K 6.1): a partner's repeated pushes lengthen planned strides.

Each pushed step changes two factors, along and across the walk, by a share of its excess.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, number
from plantar.common.sides import Side
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import PlanView
from plantar.gait.propose.proposer import Priority, Tick, was_applied


class LearnedStrideRules(
    Part, table="learned_stride", needs={"control.step_adjustment": (True,), "control.learn_strides": (True,)}
):
    """How fast strides learn.

    Attributes:
        rate: Share of a step's excess that later ones take over.
        largest: Largest factor.
    """

    rate: float = number(0.3, "1", 0, 1)  # chosen: three pushed steps make 2/3 of the way
    # Stride in m below which a direction has no stride that could become longer
    least_stride: float = fixed(1 / 30, "leg")  # chosen: 20 mm on h1
    # Change in m of a stride below which the plan stays; chosen: 5 mm on h1
    least_change: float = fixed(1 / 120, "leg")
    largest: float = number(2.0, "1", 1, 5)  # chosen: twice its stride


class LearnedStride:
    """Proposes footsteps with learned strides."""

    priority = Priority.COMMAND

    def __init__(self, rules: LearnedStrideRules) -> None:
        self._rules = rules
        self._strides: dict[int, NDArray[np.float64]] | None = None
        self._factor = np.ones(2)
        self._planned_with = np.ones(2)
        self._step = -1
        self._aimed = np.zeros(2)
        self._learned = False
        self._asked: tuple[PlanChange, NDArray[np.float64]] | None = None

    def propose(self, tick: Tick) -> PlanChange | None:
        """Footsteps from the next on, if factors changed."""
        plan = tick.plan
        swings = tick.phase.swing is not None
        if self._strides is None:
            self._strides = _strides(plan)
        if self._asked is not None and was_applied(self._asked[0], tick):
            self._planned_with = self._asked[1]
            self._asked = None
        step = tick.phase.step if swings else self._step  # the one that was taken last
        if step not in self._strides:
            return None
        if step != self._step:
            self._step = step
            self._aimed = plan.foothold(step).position[:2]
            self._learned = False
        if swings and not tick.feet.landed:
            return None
        if not self._learned:
            self._learned = True
            self._learn(plan.foothold(step).position[:2] - self._aimed, self._strides[step])
        following = self._following(plan)
        if not following:
            return None
        self._asked = (PlanChange("strides learned", step, following=following), self._factor.copy())
        return self._asked[0]

    def _learn(self, moved: NDArray[np.float64], stride: NDArray[np.float64]) -> None:
        for axis in range(2):
            if abs(stride[axis]) >= self._rules.least_stride:
                more = self._rules.rate * moved[axis] / stride[axis]
                self._factor[axis] = min(self._rules.largest, max(1.0, self._factor[axis] + more))

    def _following(self, plan: PlanView) -> tuple[Footstep, ...]:
        """Later footsteps with learned strides; none if unchanged."""
        assert self._strides is not None
        later = [k for k in range(self._step + 1, plan.count) if k in self._strides]
        change = self._factor - self._planned_with
        longest = max((float(np.abs(change * self._strides[k]).max()) for k in later), default=0.0)
        if longest < self._rules.least_change:
            return ()
        # The foot that this step stands on has a foothold of its own since it took a step: only those have strides.
        stands = {plan.foothold(k).side: plan.foothold(k).position[:2] for k in range(plan.first, self._step + 1)}
        found = []
        for k in later:
            step = plan.foothold(k)
            place = stands[step.side] + self._factor * self._strides[k]
            stands[step.side] = place
            found.append(replace(step, x=float(place[0]), y=float(place[1])))
        return tuple(found)


def _strides(plan: PlanView) -> dict[int, NDArray[np.float64]]:
    """Way (2,) in m from a foot's foothold to its next, of each step with one before."""
    last: dict[Side, NDArray[np.float64]] = {}
    found: dict[int, NDArray[np.float64]] = {}
    for k in range(plan.first, plan.count):
        step = plan.foothold(k)
        if step.side in last:
            found[k] = step.position[:2] - last[step.side]
        last[step.side] = step.position[:2]
    return found
