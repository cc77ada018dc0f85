"""Balance laws by name; their modules load at first use."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

from plantar.errors import InputError
from plantar.gait.balance.dcm_balance import BalanceGains, DcmBalance
from plantar.gait.balance.law import BalanceLaw

if TYPE_CHECKING:
    from plantar.gait.balance.wrench_balance import WrenchBalanceGains

    LawGains: TypeAlias = BalanceGains | WrenchBalanceGains

LAWS = ("com_admittance", "wrench_distribution")
"""Names of the balance laws."""


def balance_gains(table: Mapping[str, Any]) -> LawGains:
    """Gains of the law that a `[balance]` table names.

    Example:
        >>> balance_gains({"law": "com_admittance", "dcm_gain": 3.0}).dcm_gain
        3.0
    """
    law = table.get("law", LAWS[0])
    if law not in LAWS:
        raise InputError(f"[balance] law is {law!r}; allowed: {', '.join(LAWS)}")
    kind: type[BalanceGains] | type[WrenchBalanceGains] = BalanceGains
    if law == "wrench_distribution":
        from plantar.gait.balance.wrench_balance import WrenchBalanceGains

        kind = WrenchBalanceGains
    gains = {k: v for k, v in table.items() if k != "law"}
    return kind.from_table(gains, "[balance]", note=f" with law '{law}'")


def balance_law(gains: LawGains, omega: float, mass: float, period: float) -> BalanceLaw:
    """The law of these gains. `omega`: pendulum's in rad/s; `mass`: robot's in kg; `period` of control in s."""
    if isinstance(gains, BalanceGains):
        return DcmBalance(gains, omega, mass, period)
    from plantar.gait.balance.wrench_balance import WrenchBalance

    return WrenchBalance(gains, omega, mass, period)
