"""Checks of a caller's arguments: numbers, objects, lists."""

import operator
from collections.abc import Iterable
from types import UnionType
from typing import TypeVar

import numpy as np

from plantar.errors import InputError, PlantarError

LARGEST = 1e100
"""Largest absolute value of a number that has to be finite: products of a few of them are finite too. Nature: floating
point, whose largest number is 1.8e308: the third power is finite."""

_Kind = TypeVar("_Kind")
_Value = TypeVar("_Value")


def number(
    value: object, name: str, error: type[PlantarError] = InputError, *, finite: bool = False, nan: bool = False
) -> float:
    """One real number as a float. `finite`: refuse inf, and what is beyond `LARGEST`; `nan`: allow NaN.

    Example:
        >>> number(np.float32(0.5), "threshold"), number(np.array(2), "threshold")
        (0.5, 2.0)
    """
    kind = type(value)
    plain: float = value if kind is float or kind is np.float64 else _float(value, name, error)  # type: ignore[assignment]
    if not -LARGEST <= plain <= LARGEST:
        if plain != plain and not nan:
            raise error(f"{name} is NaN; expected a number")
        if finite:
            raise error(f"{name} is {plain}; expected a finite number")
    return plain


def positive(value: object, name: str, unit: str = "") -> float:
    """One finite number above 0. `unit`: its unit.

    Example:
        >>> positive(-2.0, "CoM height", "m")
        Traceback (most recent call last):
        plantar.errors.InputError: CoM height is -2.0 m; allowed: a finite value above 0
    """
    given = number(value, name, nan=True)
    if not 0.0 < given <= LARGEST:
        raise InputError(f"{name} is {f'{value} {unit}'.rstrip()}; allowed: a finite value above 0")
    return given


def integer(value: object, name: str, low: int, high: int | None = None, error: type[PlantarError] = InputError) -> int:
    """One whole number in a range. `high`: largest allowed; None: no limit.

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
        raise error(f"{name} is {_short(value)}; allowed: a whole number, {span}")
    return whole


def instance(value: _Kind, kind: type | UnionType, name: str, error: type[PlantarError] = InputError) -> _Kind:
    """Object of a class.

    Example:
        >>> instance(3, str, "name")
        Traceback (most recent call last):
        plantar.errors.InputError: name is 3; expected a str
    """
    if not isinstance(value, kind):
        raise error(f"{name} is {_short(value)}; expected a {getattr(kind, '__name__', 'path')}")
    return value


def items(value: Iterable[_Value], name: str, error: type[PlantarError] = InputError) -> tuple[_Value, ...]:
    """Several objects as a tuple.

    Example:
        >>> items(range(2), "poses")
        (0, 1)
    """
    try:
        return tuple(value)
    except TypeError:
        raise error(f"{name} is {_short(value)}; expected a list") from None


def _float(value: object, name: str, error: type[PlantarError]) -> float:
    try:
        if isinstance(value, int):
            return float(value)
        held = np.asarray(value)
        if held.ndim == 0 and held.dtype.kind in "fiub" and not np.ma.is_masked(value):
            return float(held)
    except (TypeError, ValueError, OverflowError):
        pass
    raise error(f"{name} is {_short(value)}; expected a number")


def _short(value: object) -> str:
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    if value is None or isinstance(value, str | int | float | complex | np.generic):
        text = repr(value)
        if len(text) <= 40 and text.isprintable():
            return text
    return f"a {type(value).__name__}"
