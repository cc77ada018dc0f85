"""Checks of a caller's arguments: numbers, objects, lists."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from typing import TypeVar

import numpy as np

from plantar.errors import InputError, PlantarError

__all__ = ["LARGEST", "does", "instance", "integer", "items", "number"]

LARGEST = 1e100
"""Largest absolute value of a number that has to be finite: products of a few of them are finite too."""

_SINGULAR = {"are": "is", "have": "has", "hold": "holds"}
_Kind = TypeVar("_Kind")
_Value = TypeVar("_Value")


def number(
    value: object, name: str, error: type[PlantarError] = InputError, *, finite: bool = False, nan: bool = False
) -> float:
    """Returns `value` as a float, or raises `error` with its `name`: inf and what is beyond `LARGEST` unless not
    `finite`, NaN unless `nan`.

    Example:
        >>> number(np.float32(0.5), "threshold"), number(np.array(2), "threshold")
        (0.5, 2.0)
    """
    kind = type(value)
    plain: float = value if kind is float or kind is np.float64 else _float(value, name, error)  # type: ignore[assignment]
    if not -LARGEST <= plain <= LARGEST:
        if plain != plain and not nan:
            raise error(f"{does(name, 'are')} NaN; expected a number")
        if finite:
            raise error(f"{does(name, 'are')} {plain}; expected a finite number")
    return plain


def integer(value: object, name: str, low: int, high: int | None = None, error: type[PlantarError] = InputError) -> int:
    """Returns whole number `value` from `low` to `high` (None: no limit), or raises `error` with its `name`.

    Example:
        >>> integer(np.int64(3), "frame", 0, 9)
        3
    """
    try:
        whole = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        whole = low - 1
    if isinstance(value, bool | np.bool_) or whole < low or (high is not None and whole > high):
        span = f"{low} or more" if high is None else f"{low} to {high}"
        raise error(f"{does(name, 'are')} {_short(value)}; allowed: a whole number, {span}")
    return whole


def instance(value: _Kind, kind: type, name: str, error: type[PlantarError] = InputError) -> _Kind:
    """Returns `value` of class `kind`, or raises `error` with its `name`.

    Example:
        >>> instance(3, str, "name")
        Traceback (most recent call last):
        plantar.errors.InputError: name is 3; expected a str
    """
    if not isinstance(value, kind):
        raise error(f"{does(name, 'are')} {_short(value)}; expected a {kind.__name__}")
    return value


def items(value: Iterable[_Value], name: str, error: type[PlantarError] = InputError) -> tuple[_Value, ...]:
    """Returns several objects, `value`, as a tuple, or raises `error` with its `name`.

    Example:
        >>> items(range(2), "poses")
        (0, 1)
    """
    try:
        return tuple(value)
    except TypeError:
        raise error(f"{does(name, 'are')} {_short(value)}; expected a list") from None


def does(name: str, verb: str) -> str:
    """Returns `name` and `verb` ("are", "have" or "hold") in agreement: plural if it, or what precedes "of", ends in s.

    Example:
        >>> does("forces", "are"), does("polygon", "have"), does("mask of taxels", "hold")
        ('forces are', 'polygon has', 'mask of taxels holds')
    """
    return f"{name} {verb if name.partition(' of ')[0].endswith('s') else _SINGULAR[verb]}"


def _float(value: object, name: str, error: type[PlantarError]) -> float:
    try:
        if isinstance(value, int):
            return float(value)
        held = np.asarray(value)
        if held.ndim == 0 and held.dtype.kind in "fiub" and not np.ma.is_masked(value):
            return float(held)
    except (TypeError, ValueError, OverflowError):
        pass
    raise error(f"{does(name, 'are')} {_short(value)}; expected a number")


def _short(value: object) -> str:
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    if value is None or isinstance(value, str | int | float | complex | np.generic):
        text = repr(value)
        if len(text) <= 40 and text.isprintable():
            return text
    return f"a {type(value).__name__}"
