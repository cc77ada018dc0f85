"""The schema of settings: a frozen dataclass whose fields say their default, unit, range or choices, and are checked.

A class of settings derives from `Settings`, which makes it a frozen dataclass, and makes its fields with `number`,
`whole`, `choice`, `switch`, `text` or `tables`; what each means stands under "Attributes" in its docstring. An instance
checks itself when it is made, so a wrong value is refused wherever it comes from: code, a robot file, a scene, `--set`
or a sweep.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields
from typing import Any, NamedTuple, Self, dataclass_transform

from plantar.errors import InputError, PlantarError
from plantar.settings.unknown_keys import refuse_unknown_keys

__all__ = ["Setting", "Settings", "choice", "number", "switch", "tables", "text", "whole"]


def number(default: float, unit: str, low: float = 0.0, high: float = math.inf) -> Any:
    """A field for a number.

    Args:
        default: Its default.
        unit: Its unit, "1" where it has none.
        low: Smallest allowed value.
        high: Largest allowed value; infinity allows every finite one.

    Returns:
        The field of a dataclass.
    """
    return field(default=float(default), metadata={"unit": unit, "low": low, "high": high})


def whole(default: int, unit: str, low: int = 0, high: float = math.inf) -> Any:
    """A field for a whole number.

    Args:
        default: Its default.
        unit: What is counted.
        low: Smallest allowed value.
        high: Largest allowed value.

    Returns:
        The field of a dataclass.
    """
    return field(default=int(default), metadata={"unit": unit, "low": low, "high": high})


def choice(default: str, *others: str) -> Any:
    """A field for one of several words.

    Args:
        default: Its default.
        others: The other words.

    Returns:
        The field of a dataclass.
    """
    return field(default=default, metadata={"unit": "", "choices": (default, *others)})


def switch(default: bool) -> Any:
    """A field that is true or false, with its default."""
    return field(default=default, metadata={"unit": ""})


def tables(allowed: str = "a list of tables") -> Any:
    """A field for a list of tables, or of what else `allowed` says, which its class checks itself; empty by default."""
    return field(default=(), metadata={"unit": "", "allowed": allowed})


def text(default: str) -> Any:
    """A field for any text, with its default."""
    return field(default=default, metadata={"unit": ""})


class Setting(NamedTuple):
    """What there is to say of one setting.

    Attributes:
        name: Name of the field.
        default: Default, as TOML writes it.
        unit: Unit; empty for words and switches.
        allowed: Range or choices.
        meaning: What it does.
    """

    name: str
    default: str
    unit: str
    allowed: str
    meaning: str


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
@dataclass(frozen=True)
class Settings:
    """Base of a class of settings; fields made by the functions of this module are checked when it is made.

    Deriving from it makes a frozen dataclass, so that no class of settings can forget to be frozen, or to be checked. A
    decorator of its own, which could undo that, is a TypeError.

    Raises:
        InputError: If a value is not allowed; the message names it and says what is.

    Example:
        >>> class Spring(Settings):
        ...     stiffness: float = number(100.0, "N/m", 1.0, 1e6)
        >>> Spring(stiffness=50).stiffness
        50.0
        >>> Spring(stiffness=-3)
        Traceback (most recent call last):
        plantar.errors.InputError: setting 'stiffness' is -3; allowed: a number 1 to 1e+06
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        dataclass(frozen=True)(cls)

    def __post_init__(self) -> None:
        for item in _settings(type(self)):
            object.__setattr__(self, item.name, _checked(item, getattr(self, item.name)))

    @classmethod
    def from_table(cls, table: Any, where: str, error: type[PlantarError] = InputError, note: str = "") -> Self:
        """Make the settings from a table of a TOML file; what it leaves out has its default.

        Args:
            table: Values by name.
            where: Name of the table, for messages.
            error: What is raised.
            note: On what it depends which keys are allowed, for messages.

        Returns:
            The settings.

        Raises:
            PlantarError: Of the class `error`: a key is unknown or a value not allowed; the message names it.
        """
        if not isinstance(table, Mapping):
            raise error(f"{where} is not a table")
        refuse_unknown_keys(table, cls.names(), where, error, note)
        try:
            return cls(**table)
        except InputError as problem:
            words = str(problem).removeprefix("setting ")
            raise error(f"{where} {words}") from None

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Names of the settings, in their order."""
        return tuple(f.name for f in _settings(cls))

    @classmethod
    def described(cls) -> tuple[Setting, ...]:
        """What there is to say of each setting, in their order."""
        meanings = _meanings(cls)
        return tuple(
            Setting(f.name, _as_toml(f.default), f.metadata["unit"], _allowed(f), meanings.get(f.name, ""))
            for f in _settings(cls)
        )


def _settings(kind: type[Settings]) -> tuple[Field[Any], ...]:
    return tuple(f for f in fields(kind) if "unit" in f.metadata)


def _checked(item: Field[Any], value: Any) -> Any:
    """A value as its field's type, or an error that names both."""
    default: Any = item.default
    good = False
    if isinstance(default, bool):
        good = isinstance(value, bool)
    elif isinstance(default, tuple):
        good = isinstance(value, list | tuple)
        value = tuple(value) if good else value
    elif isinstance(default, str):
        choices = item.metadata.get("choices")
        good = isinstance(value, str) and (not choices or value in choices)
    elif isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        kind = type(default)
        good = item.metadata["low"] <= value <= item.metadata["high"] and value == kind(value)
        value = kind(value) if good else value
    if not good:
        raise InputError(f"setting '{item.name}' is {value!r}; allowed: {_allowed(item)}")
    return value


def _allowed(item: Field[Any]) -> str:
    """Range or choices of a field in words."""
    if isinstance(item.default, bool):
        return "true, false"
    if isinstance(item.default, tuple):
        return str(item.metadata["allowed"])
    if isinstance(item.default, str):
        choices = item.metadata.get("choices")
        return ", ".join(choices) if choices else "a text"
    low, high = item.metadata["low"], item.metadata["high"]
    kind = "a whole number" if isinstance(item.default, int) else "a number"
    return f"{kind} {low:g} to {high:g}" if math.isfinite(high) else f"a finite {kind[2:]}, {low:g} or more"


def _as_toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return "[]"
    return f'"{value}"' if isinstance(value, str) else f"{value:g}"


def _meanings(kind: type[Settings]) -> dict[str, str]:
    """Meaning of each field: its entry under "Attributes" in the docstring of the class that has it."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        entries = (inspect.cleandoc(base.__doc__ or "")).partition("Attributes:\n")[2]
        for name, words in re.findall(r"^    (\w+): (.*(?:\n {8}.*)*)", entries, re.MULTILINE):
            found[name] = " ".join(words.split())
    return found
