"""Dimensions that state their unit and range: the fields of a frozen dataclass, checked when it is made."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import field, fields
from typing import Any

from plantar.errors import InputError

__all__ = ["check_dimensions", "checked", "choice", "length", "number", "text"]


def length(default: float, low: float, high: float, meaning: str) -> Any:
    """Gives a dataclass field for a length in mm: default, low and high limits, meaning."""
    return number(default, low, high, "mm", meaning)


def number(default: float, low: float, high: float, unit: str, meaning: str) -> Any:
    """Gives a dataclass field for a number: default, low and high limits, unit ("-" for none), meaning."""
    return field(default=default, metadata={"low": low, "high": high, "unit": unit, "text": meaning})


def choice(default: str, choices: tuple[str, ...], meaning: str) -> Any:
    """Gives a dataclass field for one of several choices: default, choices, meaning."""
    return field(default=default, metadata={"choices": choices, "text": meaning})


def text(default: str, meaning: str) -> Any:
    """Gives a dataclass field for a text of one line: default, meaning."""
    return field(default=default, metadata={"text": meaning})


def checked(record: Any, name: str, value: Any, what: str) -> Any:
    """Gives a value for the field of a name of a dataclass (record), numbers as floats; what is the word for its fields
    in messages.

    Raises:
        InputError: If the value is not allowed; the message names field, value, unit and range.
    """
    metadata = record.__dataclass_fields__[name].metadata
    if "choices" in metadata:
        if value not in metadata["choices"]:
            raise InputError(f"{what} {name} is {value!r}; allowed: {', '.join(metadata['choices'])}")
    elif "unit" in metadata:
        low, high, unit = (metadata[key] for key in ("low", "high", "unit"))
        good = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not (good and math.isfinite(value) and low <= value <= high):
            raise InputError(f"{what} {name} is {value!r} {unit}; allowed: {low:g} to {high:g} {unit}")
        return float(value)
    elif not isinstance(value, str) or not value.isprintable():
        raise InputError(f"{what} {name} is {value!r}; allowed: a text of one line")
    return value


def check_dimensions(record: Any, what: str, names: Iterable[str] | None = None) -> None:
    """Check fields, by names or all, of a frozen dataclass (record) as it is being made, and keep its numbers as
    floats; what is the word for its fields.
    """
    for name in [f.name for f in fields(record)] if names is None else names:
        object.__setattr__(record, name, checked(record, name, getattr(record, name), what))
