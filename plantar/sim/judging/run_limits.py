"""Limits of every walk: how hard it lands, how long its motors are at their limits, what touches the ground."""

from collections.abc import Sequence
from typing import Any

from plantar.sim.judging.unmet import unmet

LEVEL_IMPACT = 1.0
"""Largest ground force of a landing on level ground, in weights."""

UNEVEN_IMPACT = 1.5
"""The same on steps and slopes."""

TORQUE_SHARE = 0.1
"""Largest share of the time in which a joint may be at its torque limit."""


def limit_reasons(impacts: Sequence[float], level: bool, at_torque_limit: float) -> list[dict[str, Any]]:
    """Returns failed criteria, as `plantar.sim.judging.unmet`.

    By `impacts` in weights, whether the ground is `level`, and the share of time `at_torque_limit`.
    """
    hardest = max(impacts, default=0.0)
    limit = LEVEL_IMPACT if level else UNEVEN_IMPACT
    ground = "level ground" if level else "steps and slopes"
    hard = f"a foot landed with {hardest:.2f} of the weight; allowed: {limit:g} on {ground}"
    held = f"a joint was at its torque limit in {at_torque_limit:.0%} of the time; allowed: {TORQUE_SHARE:.0%}"
    return unmet(
        (hardest <= limit, "impact", hardest, limit, hard),
        (at_torque_limit <= TORQUE_SHARE, "torque_limit", at_torque_limit, TORQUE_SHARE, held),
    )
