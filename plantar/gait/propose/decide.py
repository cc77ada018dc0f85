"""Decide which plan change is applied."""

from collections.abc import Sequence

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Proposer, Tick


def decide(proposers: Sequence[Proposer], tick: Tick) -> PlanChange | None:
    """The change to apply, or None: one a tick, of the first `Priority`; among equals, of the first proposer."""
    wanted = [(proposer.priority, change) for proposer in proposers if (change := proposer.propose(tick)) is not None]
    return min(wanted, key=lambda pair: pair[0])[1] if wanted else None
