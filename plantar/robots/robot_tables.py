"""Values of a robot file's tables, checked: an error names the file, the table, the field and what is allowed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from plantar.errors import RobotError

__all__ = ["RobotTables"]


class RobotTables:
    """The tables of a robot file. Everything raises RobotError for what is missing or not allowed."""

    def __init__(self, source: Mapping[str, Any], where: str) -> None:
        self.source = source
        self.where = where

    def place(self, *tables: str) -> str:
        """Where an error is, for its message."""
        return f"{self.where}: [{'.'.join(tables)}]" if tables else self.where

    def table(self, *tables: str) -> Mapping[str, Any]:
        """A table of the file, or a table in one; the file itself for no name."""
        found = self.source
        for i, name in enumerate(tables):
            inner = found.get(name)
            if not isinstance(inner, Mapping):
                raise RobotError(f"{self.place(*tables[:i])}: table [{name}] is missing")
            found = inner
        return found

    def text(self, field: str, *tables: str, default: str | None = None) -> str:
        """A text that is not empty.

        Returns the text.

        Args:
            field: Its name.
            tables: Names of the table that holds it, and of those around it; none for the file itself.
            default: What counts where it is left out; None: it may not be left out.
        """
        value = self.table(*tables).get(field, default)
        if not isinstance(value, str) or not value:
            raise RobotError(f"{self.place(*tables)}: '{field}' is missing or not a text")
        return value

    def switch(self, field: str, table: str) -> bool:
        """A value of a table that is true or false, and false where it is left out.

        Takes `field`; returns the value.
        """
        value = self.table(table).get(field, False)
        if not isinstance(value, bool):
            raise RobotError(f"{self.place(table)}: '{field}' is {value!r}; allowed: true, false")
        return value

    def number(self, field: str, table: str, low: float, high: float, default: float | None = None) -> float:
        """A number of a table within limits.

        Returns the number.

        Args:
            field: Its name.
            table: Name of the table that holds it.
            low: Smallest allowed value.
            high: Largest allowed value.
            default: What counts where it is left out; None: it may not be left out.
        """
        return _checked_number(self.table(table).get(field, default), field, self.place(table), low, high)

    def numbers(self, field: str, table: str, count: int, low: float, high: float) -> tuple[float, ...]:
        """So many numbers of a table within limits.

        Takes `field`, `count`, `low` and `high`; returns the numbers.
        """
        value = self.table(table).get(field)
        if not isinstance(value, list) or len(value) != count:
            raise RobotError(f"{self.place(table)}: '{field}' is {value!r}; allowed: a list of {count} numbers")
        return tuple(_checked_number(v, field, self.place(table), low, high) for v in value)

    def number_each(self, field: str, table: str, count: int, low: float, high: float) -> tuple[float, ...]:
        """So many numbers of a table within limits, or one that counts for all of them.

        Takes `field`, `count`, `low` and `high`; returns the numbers.
        """
        if isinstance(self.table(table).get(field), list):
            return self.numbers(field, table, count, low, high)
        return (self.number(field, table, low, high),) * count


def _checked_number(value: Any, field: str, where: str, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise RobotError(f"{where}: '{field}' is {value!r}; allowed: a number from {low:g} to {high:g}")
    return float(value)
