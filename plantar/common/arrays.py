"""Checks of a caller's arrays, and read-only copies.

Real numbers of any type, order and stride are allowed; text, objects, complex numbers, dates, ragged rows and masked
values are refused.
"""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import LARGEST
from plantar.errors import InputError, PlantarError
from plantar.kernels.base.limits import points_within, values_within
from plantar.kernels.base.member import close_all

_FLOAT = np.dtype(np.float64)
_BOOL = np.dtype(np.bool_)
_MANY = 4096  # chosen: an array up to which a whole test costs less than a sampled one; a time, no value, depends on it
_KINDS = {"O": "objects", "U": "text", "S": "bytes", "c": "complex numbers", "m": "durations", "M": "dates"}
_Value = TypeVar("_Value")


def numbers(value: object, name: str, error: type[PlantarError] = InputError) -> NDArray[np.float64]:
    """Real numbers as float64, any shape.

    `name`: name in errors; a plural ends in s. Returns array itself if float64, else a converted one.

    Example:
        >>> numbers([1, 2.5], "forces").tolist()
        [1.0, 2.5]
        >>> numbers(["1", "2"], "forces")
        Traceback (most recent call last):
        plantar.errors.InputError: forces: not numeric (text); expected real numbers
    """
    if type(value) is np.ndarray and value.dtype is _FLOAT:
        return value
    given = held_numbers(value, name, error)
    with np.errstate(over="ignore"):  # a longer float than float64 holds is inf
        return np.asarray(given, dtype=_FLOAT)


def held_numbers(value: object, name: str, error: type[PlantarError] = InputError) -> NDArray[Any]:
    """Real numbers in their own type, too many to convert. Returns array itself, or one of value.

    Example:
        >>> held_numbers(np.zeros(2, dtype=np.float32), "forces").dtype
        dtype('float32')
    """
    given = _given(value, name, error)
    if given.dtype.kind not in "fiub":
        what = "None" if value is None else _KINDS.get(given.dtype.kind, str(given.dtype))
        raise error(f"{name}: not numeric ({what}); expected real numbers")
    return given


def array(
    value: object,
    name: str,
    shape: tuple[object, ...],
    error: type[PlantarError] = InputError,
    *,
    finite: bool = False,
) -> NDArray[np.float64]:
    """Real numbers of a given shape.

    `shape`: length of each axis; text for any, `...` in front for any number of axes; `finite`: refuse NaN, inf, and
    what is beyond `LARGEST`. Returns array itself if float64, else a converted one.

    Example:
        >>> array([[1, 2], [3, 4]], "points", (..., 2)).shape
        (2, 2)
    """
    given = numbers(value, name, error)
    if not _fits(given.shape, shape):
        raise error(f"{name}: shape {given.shape}; expected {_shape_text(shape)}")
    if finite and not is_finite(given):
        raise not_finite(given, name, error)
    return given


def own(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Read-only copy.

    Example:
        >>> own(np.zeros(2)).flags.writeable
        False
    """
    copy = values.copy()
    copy.setflags(False)  # type: ignore[call-arg]  # by name it takes twice as long
    return copy


def integers(
    value: object, name: str, shape: tuple[object, ...], error: type[PlantarError] = InputError
) -> NDArray[np.int64]:
    """Whole numbers of a given shape. Returns array as int64; an empty list is one without rows.

    Example:
        >>> integers([[0, 1]], "cells", ("m", 2)).dtype
        dtype('int64')
    """
    given = _given(value, name, error)
    if given.shape == (0,) and len(shape) > 1:
        given = np.empty([0 if isinstance(s, str) or s is ... else s for s in shape], dtype=np.int64)  # type: ignore[misc]
    if given.dtype.kind not in "iu" or (given.dtype.kind == "u" and given.size and int(given.max()) >= 2**63):
        raise error(f"{name}: not whole numbers of up to 64 bits")
    if not _fits(given.shape, shape):
        raise error(f"{name}: shape {given.shape}; expected {_shape_text(shape)}")
    return np.asarray(given, dtype=np.int64)


def mask(
    value: object, name: str, shape: tuple[object, ...], error: type[PlantarError] = InputError
) -> NDArray[np.bool_]:
    """Truth values of a given shape.

    `value`: bools, or whole numbers 0 or 1. Returns array itself if bool, else a converted one.

    Example:
        >>> mask([1, 0], "mask", ("n",)).tolist()
        [True, False]
    """
    given = value if type(value) is np.ndarray else _given(value, name, error)
    if given.dtype is not _BOOL:
        if given.size and (given.dtype.kind not in "iub" or not ((given == 0) | (given == 1)).all()):
            raise error(f"{name}: holds values that are neither true nor false")
        given = given.astype(bool)
    if not _fits(given.shape, shape):
        raise error(f"{name}: shape {given.shape}; expected {_shape_text(shape)}")
    return given


def is_finite(values: NDArray[np.float64]) -> bool:
    """Whether all numbers are finite and not beyond `LARGEST`. Returns True where it is empty.

    Example:
        >>> is_finite(np.array([1.0, np.nan])), is_finite(np.empty(0))
        (False, True)
    """
    if values.size > _MANY:
        return bool(values.min() >= -LARGEST and values.max() <= LARGEST)
    if values.ndim == 2:
        return bool(points_within(values, LARGEST))
    return bool(values_within(values if values.ndim == 1 else values.reshape(-1), LARGEST))


def read_only(value: _Value) -> _Value:
    """Close an object's arrays to writing. `value`: array, or nested tuples of some; else unchanged.

    Example:
        >>> read_only(np.zeros(2)).flags.writeable
        False
    """
    close_all(value)
    return value


def not_finite(values: NDArray[np.float64], name: str, error: type[PlantarError] = InputError) -> PlantarError:
    """Error for numbers not all finite.

    Example:
        >>> not_finite(np.array([np.nan]), "positions")
        InputError('positions: holds a value that is not finite')
    """
    if np.isfinite(values).all():
        return error(f"{name}: as large as {np.abs(values).max():.3g}; allowed: up to {LARGEST:g}")
    return error(f"{name}: holds a value that is not finite")


def _given(value: object, name: str, error: type[PlantarError]) -> NDArray[Any]:
    parts = value if isinstance(value, list | tuple) else (value,)
    if any(isinstance(part, np.ma.MaskedArray) and np.ma.is_masked(part) for part in parts):
        raise error(f"{name}: holds masked values; fill them first, with NaN where nothing was measured")
    try:
        return np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        raise error(f"{name}: not an array: rows differ in length, or numpy does not know what it is") from None


def _fits(shape: tuple[int, ...], wanted: tuple[object, ...]) -> bool:
    """Whether a shape is wanted (see `array`), without a slow generator."""
    if wanted and wanted[0] is ...:
        wanted = wanted[1:]
        shape = shape[max(0, len(shape) - len(wanted)) :]
    if len(shape) != len(wanted):
        return False
    for length, right in zip(shape, wanted, strict=True):  # noqa: SIM110
        if length != right and type(right) is not str:
            return False
    return True


def _shape_text(shape: tuple[object, ...]) -> str:
    parts = ["..." if s is ... else str(s) for s in shape]
    return f"({', '.join(parts)}{',' if len(parts) == 1 else ''})"
