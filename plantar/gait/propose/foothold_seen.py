"""Plan with a foothold seen before touchdown, when the stance foot has most room."""

import math

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.foothold_rules import FootholdRules
from plantar.gait.propose.proposer import Priority, Tick


class FootholdSeenAhead:
    """Proposes the VRP over a descending foot's foothold. `rules`: least distance off the plan."""

    priority = Priority.FOOTHOLD

    def __init__(self, rules: FootholdRules) -> None:
        self._rules = rules

    def propose(self, tick: Tick) -> PlanChange | None:
        """VRP over what is seen, if not as planned."""
        seen = tick.seen
        if seen is None or not self._rules.move_vrp:
            return None
        if math.dist(seen.vrp, tick.plan.vrp(seen.step)) < self._rules.least_move:
            return None
        x, y = seen.vrp.tolist()
        return PlanChange("foothold seen", seen.step, vrp=(x, y))
