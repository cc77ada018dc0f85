"""Plan with a foothold that is seen before the foot is on it, while the stance foot has most room."""

from __future__ import annotations

import math

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.proposer import Priority, Tick

__all__ = ["FootholdSeenAhead"]


class FootholdSeenAhead:
    """Proposes the VRP over the foothold that a swing foot is coming down on.

    Args:
        rules: How far a foothold has to lie off the plan.
    """

    priority = Priority.FOOTHOLD

    def __init__(self, rules: FootholdRules) -> None:
        self._rules = rules

    def propose(self, tick: Tick) -> PlanChange | None:
        """The VRP over what is seen, where that is not what was planned."""
        seen = tick.seen
        if seen is None or math.dist(seen.vrp, tick.plan.vrp(seen.step)) < self._rules.least_move:
            return None
        x, y = seen.vrp.tolist()
        return PlanChange("foothold seen", seen.step, vrp=(x, y))
