"""Balance laws: built in, and entry points `plantar.balance_laws`."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from plantar.common.extensions import extensions
from plantar.errors import InputError
from plantar.gait.balance.dcm_balance import BalanceGains
from plantar.gait.balance.law import LawGains
from plantar.gait.balance.wrench_balance import WrenchBalanceGains


@cache
def balance_laws() -> dict[str, type[LawGains]]:
    """Laws' gains by the names that `law` in `[balance]` can have; the first is the default.

    Example:
        >>> list(balance_laws())[:2]
        ['com_admittance', 'wrench_distribution']
    """
    own: dict[str, type[LawGains]] = {"com_admittance": BalanceGains, "wrench_distribution": WrenchBalanceGains}
    return {**own, **extensions("plantar.balance_laws", LawGains, tuple(own))}


def law_of(table: Mapping[str, Any]) -> str:
    """Name of the law that a `[balance]` table names, or the default's."""
    law: str = table.get("law", next(iter(balance_laws())))
    return law


def balance_gains(table: Mapping[str, Any]) -> LawGains:
    """Gains of the law that a `[balance]` table names.

    Example:
        >>> balance_gains({"law": "com_admittance", "dcm_gain": 3.0}).dcm_gain
        3.0
    """
    laws = balance_laws()
    law = law_of(table)
    if law not in laws:
        raise InputError(f"[balance] law is {law!r}; allowed: {', '.join(laws)}")
    gains = {k: v for k, v in table.items() if k != "law"}
    return laws[law].from_table(gains, "[balance]", note=f" with law '{law}'")
