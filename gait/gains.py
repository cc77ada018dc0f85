"""What gains have in common: frozen dataclasses of numbers that check themselves and come from a robot's table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, ClassVar, Self

from plantar.errors import InputError

__all__ = ["Gains"]


@dataclass(frozen=True)
class Gains:
    """Base of a dataclass whose fields with a default are numbers, finite and 0 or more.

    Raises:
        InputError: If a number is not allowed; the message names it.

    Example:
        >>> from gait.balance import BalanceGains
        >>> BalanceGains.from_table({"dcm_gain": 2.0, "law": "com_admittance"}).dcm_gain
        2.0
    """

    CALLED: ClassVar[str] = "balance gain"
    """What one of its numbers is called in messages."""

    BELOW: ClassVar[float] = math.inf
    """Bound that no number may reach."""

    def __post_init__(self) -> None:
        for name in self._numbers():
            value = getattr(self, name)
            if not (isinstance(value, int | float) and 0.0 <= value < self.BELOW):
                raise InputError(f"{self.CALLED} '{name}' is {value!r}; allowed: a finite number, 0 or more")

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Take the keys of a table that name a number of the class; other keys are left alone.

        Args:
            table: Values by name.

        Returns:
            The gains.
        """
        return cls(**{k: v for k, v in table.items() if k in cls._numbers()})

    @classmethod
    def names(cls) -> list[str]:
        """Names of the numbers that a table may give."""
        return cls._numbers()

    @classmethod
    def _numbers(cls) -> list[str]:
        return [item.name for item in fields(cls) if item.default is not MISSING]
