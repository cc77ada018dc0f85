"""Checked settings: a frozen dataclass whose fields give default, unit, range or choices.

A class derives from `Settings`, makes its fields with the functions below and explains them under "Attributes". Numbers
are in SI. `share`, or a text such as "0.5 sole", is a share of the robot's body, the reference body until `for_body`.
"""

import copy
import inspect
import math
import re
from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields
from numbers import Real
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, Self, dataclass_transform

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale, Quantity, si_unit
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import InputError, PlantarError


def number(default: float, unit: str, low: float = 0.0, high: float = math.inf, words: tuple[str, ...] = ()) -> Any:
    """Returns the dataclass field of a number from `low` to `high` in a `unit`, "1" for none, or one of `words`, such
    as "random".

    An infinite `high` allows every finite one; `default` is one of them.
    """
    return field(default=float(default), metadata={"unit": unit, "low": low, "high": high, "words": words})


def share(default: float, unit: str, low: float = 0.0, high: float = math.inf) -> Any:
    """Returns the field of a number that grows with the robot: `default` in a `unit` of its body, such as "weight",
    "leg" or "leg/beat", from `low` to `high` in SI.
    """
    quantity = Quantity(float(default), unit)
    return field(default=quantity, metadata={"unit": si_unit(unit), "low": low, "high": high})


def fixed(value: float, unit: str) -> Any:
    """A field that grows with the robot, `value` times `unit`; returns it. No file sets it."""
    return field(default=Quantity(float(value), unit), init=False, repr=False, metadata={"fixed": True})


def whole(default: int, unit: str, low: int = 0, high: float = math.inf) -> Any:
    """Returns the field of a whole number from `low` to `high` with a `default`; `unit` is what is counted."""
    return field(default=int(default), metadata={"unit": unit, "low": low, "high": high})


def choice(default: str, *others: str) -> Any:
    """A field for one word, the `default` or `others`; returns it."""
    return field(default=default, metadata={"unit": "", "choices": (default, *others)})


def switch(default: bool) -> Any:
    """A field that is true or false."""
    return field(default=default, metadata={"unit": ""})


def tables(allowed: str = "a list of tables", words: tuple[str, ...] = ()) -> Any:
    """Returns the field of a list that its class checks, `allowed` in words, or one of `words`, such as "random"."""
    return field(default=(), metadata={"unit": "", "allowed": allowed, "words": words})


def text(default: str) -> Any:
    """A field for any text."""
    return field(default=default, metadata={"unit": ""})


class Setting(NamedTuple):
    """Description of one setting.

    `unit`: empty for words and switches; `share`: default as a share of body, or empty.
    """

    name: str
    default: str
    unit: str
    allowed: str
    meaning: str
    share: str = ""


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
@dataclass(frozen=True)
class Settings:
    """Base of settings; fields made by this module's functions are checked.

    Deriving makes a frozen dataclass; a decorator, which could undo that, is a TypeError.

    Raises:
        InputError: If a value is not allowed; the message shows what is.

    Example:
        >>> class Spring(Settings):
        ...     stiffness: float = number(100.0, "N/m", 1.0, 1e6)
        >>> Spring(stiffness=50).stiffness
        50.0
        >>> Spring(stiffness=-3)
        Traceback (most recent call last):
        plantar.errors.InputError: setting 'stiffness' is -3; allowed: a number 1 to 1e+06
        >>> Spring(stiffness="2 N/leg").for_body(BodyScale(30.0, 0.5, 0.1, 0.05)).stiffness
        4.0
    """

    _body: ClassVar[BodyScale] = (
        REFERENCE_BODY  # of the class; for_body gives an instance its own, as __post_init__ does
    )
    _stated: ClassVar[Mapping[str, Quantity]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        dataclass(frozen=True)(cls)

    def __post_init__(self) -> None:
        stated: dict[str, Quantity] = {}
        for item in _settings(type(self)):
            value = _quantity(item, getattr(self, item.name))
            if isinstance(value, Quantity):
                stated[item.name] = value
            object.__setattr__(self, item.name, _checked(item, value, self._body))
        for item in fields(self):
            if "fixed" in item.metadata and isinstance(item.default, Quantity):
                stated[item.name] = item.default
                object.__setattr__(self, item.name, item.default.si(self._body))
        object.__setattr__(self, "_stated", stated)

    @property
    def body(self) -> BodyScale:
        """The body of these settings."""
        return self._body

    @property
    def stated(self) -> Mapping[str, Quantity]:
        """Values given as a share or with a unit, by name."""
        return MappingProxyType(dict(self._stated))

    def for_body(self, body: BodyScale) -> Self:
        """The same settings, and those inside them, for a robot.

        Raises:
            InputError: If a share is not allowed there.
        """
        found = copy.copy(self)
        object.__setattr__(found, "_body", body)
        for item in fields(self):
            value = self._stated.get(item.name, getattr(self, item.name))
            if isinstance(value, Quantity):
                value = value.si(body) if "fixed" in item.metadata else _checked(item, value, body)
            elif isinstance(value, Settings):
                value = value.for_body(body)
            object.__setattr__(found, item.name, value)
        return found

    def in_si(self, value: Any, unit: str, owner: str = "a list") -> Any:
        """Returns a list's member `value` in SI, a number or a text with a unit such as "0.03 leg"; other values stay.

        An InputError that names the list's `owner` if it does not fit its SI `unit`.
        """
        found = Quantity.parsed(value) if isinstance(value, str) else None
        if found is None:
            return value
        if not found.is_a(unit):
            raise InputError(f"{owner} holds {value!r}; allowed: a number in {unit}")
        return found.si(self._body)

    @classmethod
    def from_table(cls, table: Any, where: str, error: type[PlantarError] = InputError, note: str = "") -> Self:
        """Returns the settings from a TOML `table`, with defaults.

        Raises `error` for an unknown key or wrong value, with `where` as the table's name and a `note` on what the
        allowed keys depend on.
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
    def described(cls, body: BodyScale = REFERENCE_BODY) -> tuple[Setting, ...]:
        """Descriptions in their order, with shares in SI for a body."""
        meanings = _meanings(cls)
        return tuple(
            Setting(
                f.name,
                f"{f.default.si(body):.4g}" if isinstance(f.default, Quantity) else _as_toml(f.default),
                f.metadata["unit"],
                _allowed(f),
                meanings.get(f.name, ""),
                str(f.default) if isinstance(f.default, Quantity) else "",
            )
            for f in _settings(cls)
        )


def _settings(kind: type[Settings]) -> tuple[Field[Any], ...]:
    return tuple(f for f in fields(kind) if "unit" in f.metadata)


def _quantity(item: Field[Any], value: Any) -> Any:
    """A text such as "0.5 sole" as a quantity; other values stay."""
    if not isinstance(value, str) or not isinstance(item.default, float | Quantity):
        return value
    try:
        found = Quantity.parsed(value)
        if found is None or found.is_a(item.metadata["unit"]):
            return value if found is None else found
        problem = f"{found.unit} is no unit of it"
    except InputError as error:
        problem = str(error)
    raise InputError(f"setting '{item.name}' is {value!r}: {problem}; allowed: {_allowed(item)}, in {_units(item)}")


def _units(item: Field[Any]) -> str:
    share = f", or in {item.default.unit}" if isinstance(item.default, Quantity) else ""
    return f"{item.metadata['unit']}{share}"


def _checked(item: Field[Any], value: Any, body: BodyScale) -> Any:
    """A value as its field's type, in SI."""
    default: Any = 0.0 if isinstance(item.default, Quantity) else item.default
    told = repr(value)
    if isinstance(value, Quantity):
        told = repr(str(value))
        value = value.si(body)
        told += f" = {value:.4g} {item.metadata['unit']}"
    good = False
    if isinstance(value, str) and value in item.metadata.get("words", ()):
        return value
    if isinstance(default, bool):
        good = isinstance(value, bool)
    elif isinstance(default, tuple):
        good = isinstance(value, list | tuple)
        value = tuple(value) if good else value
    elif isinstance(default, str):
        choices = item.metadata.get("choices")
        good = isinstance(value, str) and (not choices or value in choices)
    elif isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value):
        good = item.metadata["low"] <= value <= item.metadata["high"] and value == type(default)(value)
        value = type(default)(value) if good else value
    if not good:
        raise InputError(f"setting '{item.name}' is {told}; allowed: {_allowed(item)}")
    return value


def _allowed(item: Field[Any]) -> str:
    return " or ".join([_range_of(item), *(f'"{word}"' for word in item.metadata.get("words", ()))])


def _range_of(item: Field[Any]) -> str:
    if isinstance(item.default, Quantity):
        return _range("a number", item)
    if isinstance(item.default, bool):
        return "true, false"
    if isinstance(item.default, tuple):
        return str(item.metadata["allowed"])
    if isinstance(item.default, str):
        choices = item.metadata.get("choices")
        return ", ".join(choices) if choices else "a text"
    return _range("a whole number" if isinstance(item.default, int) else "a number", item)


def _range(kind: str, item: Field[Any]) -> str:
    low = item.metadata["low"]
    high = item.metadata["high"]
    return f"{kind} {low:g} to {high:g}" if math.isfinite(high) else f"a finite {kind[2:]}, {low:g} or more"


def _as_toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "[]" if isinstance(value, tuple) else f'"{value}"' if isinstance(value, str) else f"{value:g}"


def _meanings(kind: type[Settings]) -> dict[str, str]:
    """Each field's entry under "Attributes"."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        entries = (inspect.cleandoc(base.__doc__ or "")).partition("Attributes:\n")[2]
        for name, words in re.findall(r"^    (\w+): (.*(?:\n {8}.*)*)", entries, re.MULTILINE):
            found[name] = " ".join(words.split())
    return found
