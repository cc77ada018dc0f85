from dataclasses import dataclass

import pytest

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.decide import decide
from plantar.gait.propose.proposer import Priority, Tick, was_applied


@dataclass
class Says:
    """A proposer that always says the same."""

    priority: Priority
    change: PlanChange | None
    asked: int = 0

    def propose(self, tick: Tick) -> PlanChange | None:
        self.asked += 1
        return self.change


REFUSED, FOUND, OTHER, COMMAND = (PlanChange(r, 2) for r in ("refused", "found", "other", "command"))


def test_nobody_wants_anything(plan_of, tick_at):
    assert decide([], tick_at(plan_of(), 2.5)) is None
    assert decide([Says(Priority.SAFETY, None)], tick_at(plan_of(), 2.5)) is None


@pytest.mark.parametrize(
    ("proposed", "chosen"),
    [
        ([(Priority.COMMAND, COMMAND), (Priority.FOOTHOLD, FOUND), (Priority.SAFETY, REFUSED)], REFUSED),
        ([(Priority.COMMAND, COMMAND), (Priority.FOOTHOLD, FOUND), (Priority.SAFETY, None)], FOUND),
        ([(Priority.FOOTHOLD, OTHER), (Priority.FOOTHOLD, FOUND)], OTHER),
        ([(Priority.COMMAND, COMMAND)], COMMAND),
    ],
)
def test_safety_comes_before_footholds_and_those_before_commands(proposed, chosen, plan_of, tick_at):
    proposers = [Says(*p) for p in proposed]
    assert decide(proposers, tick_at(plan_of(), 2.5)) is chosen
    assert [p.asked for p in proposers] == [1] * len(proposers)  # all of them: they keep an account of what they see


def test_a_proposer_sees_at_the_next_tick_whether_its_change_was_applied(plan_of, tick_at):
    plan = plan_of()
    mine, other = PlanChange("mine", 3, vrp=(0.6, 0.0)), PlanChange("mine", 3, vrp=(0.6, 0.0))
    assert not was_applied(mine, tick_at(plan, 2.5))
    plan.apply(mine, 2.5, plan.view.vrp(0)[None, :][:0])
    assert was_applied(mine, tick_at(plan, 2.505))
    assert not was_applied(other, tick_at(plan, 2.505))  # the same words of somebody else
