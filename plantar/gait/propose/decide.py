"""Decide which plan change is applied."""

from collections.abc import Sequence

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Proposer, Tick


def decide(proposers: Sequence[Proposer], tick: Tick) -> PlanChange | None:
    """The change to apply, or None: one a tick, of the first `Priority`; among equals, of the first proposer."""
    first: Proposer | None = None
    chosen: PlanChange | None = None
    for proposer in proposers:
        change = proposer.propose(tick)
        if change is not None and (first is None or proposer.priority < first.priority):
            first = proposer
            chosen = change
    return chosen
