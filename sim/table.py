"""Checked tables: a frozen dataclass of numbers, texts and switches from the table of a TOML file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import Field, fields
from typing import Any, TypeVar

from plantar.errors import SceneError
from plantar.unknown_keys import refuse_unknown_keys

__all__ = ["from_table", "limits"]

T = TypeVar("T")


def limits(low: float, high: float) -> dict[str, Any]:
    """Metadata of a numeric field: the allowed range, both ends included.

    Args:
        low: Smallest allowed value.
        high: Largest allowed value.

    Returns:
        The metadata for `dataclasses.field`.
    """
    return {"low": low, "high": high}


def from_table(kind: type[T], table: Any, where: str) -> T:
    """Make a dataclass from a table, checking names, types, ranges and choices.

    A field's type is that of its default; a tuple stands for a list that the dataclass checks itself. Metadata may hold
    `low` and `high` (numbers) or `choices` (texts).

    Args:
        kind: The dataclass; every field has a default.
        table: Values by name.
        where: Name of the table, for error messages.

    Returns:
        The instance.

    Raises:
        SceneError: If the table has an unknown key or a value that is not allowed; the message names both.
    """
    if not isinstance(table, Mapping):
        raise SceneError(f"{where} is not a table")
    known: dict[str, Field[Any]] = {f.name: f for f in fields(kind)}  # type: ignore[arg-type]
    refuse_unknown_keys(table, known, where, SceneError)
    return kind(**{key: _checked(known[key], value, where) for key, value in table.items()})


def _checked(item: Field[Any], value: Any, where: str) -> Any:
    default, meta = item.default, item.metadata
    name = f"{where} {item.name}"
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise SceneError(f"{name} is {value!r}; allowed: true, false")
        return value
    if isinstance(default, tuple):
        if not isinstance(value, list):
            raise SceneError(f"{name} is {value!r}; allowed: a list")
        return tuple(value)
    if isinstance(default, str):
        choices = meta.get("choices")
        if not isinstance(value, str) or (choices and value not in choices):
            raise SceneError(f"{name} is {value!r}; allowed: {', '.join(choices) if choices else 'a text'}")
        return value
    low, high = meta.get("low", -math.inf), meta.get("high", math.inf)
    whole = isinstance(default, int)
    numeric = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not numeric or not low <= value <= high or (whole and value != int(value)):
        raise SceneError(
            f"{name} is {value!r}; allowed: {'a whole number' if whole else 'a number'} {low:g} to {high:g}"
        )
    return int(value) if whole else float(value)
