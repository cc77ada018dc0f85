"""The one place that decides which change of the plan is applied.

One change a tick, so that everybody who proposes knows the plan that the change is made of. The proposer with the first
`Priority` has its way; of two with the same the one that is asked first.
"""

from __future__ import annotations

from collections.abc import Sequence

from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Proposer, Tick

__all__ = ["decide"]


def decide(proposers: Sequence[Proposer], tick: Tick) -> PlanChange | None:
    """Ask every proposer, and choose.

    Args:
        proposers: Who is asked, in this order.
        tick: What there is to know.

    Returns:
        The change to apply, or None where nobody wants one.
    """
    wanted = [(proposer.priority, change) for proposer in proposers if (change := proposer.propose(tick)) is not None]
    return min(wanted, key=lambda pair: pair[0])[1] if wanted else None
