"""Many results at once: the numbers in them, and which of them differ."""

from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["differing", "not_finite", "numbers"]

Array = NDArray[np.float64]


def numbers(value: Any) -> Array:
    """The floating point numbers in a result, flat; other members say nothing.

    Args:
        value: An array, a float, what has `points`, or a tuple or list of results.

    Returns:
        The numbers (k,).

    Example:
        >>> numbers([np.eye(2), (1.5, None), np.array([True])]).tolist()
        [1.0, 0.0, 0.0, 1.0, 1.5]
    """
    found: list[Array] = []
    _gather([value], found)
    return np.concatenate(found, axis=None) if found else np.empty(0)


def _gather(values: Sequence[Any], found: list[Array]) -> None:
    """Gather kind by kind, not value by value: of many results, as a rule of one kind, none is looked at alone."""
    kinds: list[Any] = list(dict.fromkeys(map(type, values)))
    for kind in kinds:
        mine: Sequence[Any] = values if len(kinds) == 1 else [v for v in values if type(v) is kind]
        if issubclass(kind, np.ndarray):
            found.extend([v for v in mine if v.dtype.kind == "f"])
        elif issubclass(kind, float):
            found.append(np.array(mine))
        elif issubclass(kind, (tuple, list)):
            _gather(mine[0] if len(mine) == 1 else list(chain.from_iterable(mine)), found)
        elif hasattr(mine[0], "points"):
            found.extend([v.points for v in mine])


def not_finite(values: Sequence[Any]) -> list[bool]:
    """Of which results a number is not finite; result by result only where one of all is not.

    Args:
        values: Results, each as `numbers` takes it.

    Returns:
        A flag a result.

    Example:
        >>> not_finite([np.zeros(2), None, (1.0, np.array([np.nan]))])
        [False, False, True]
    """
    if np.isfinite(numbers(values)).all():
        return [False] * len(values)
    return [not np.isfinite(numbers(v)).all() for v in values]


def differing(
    one: Sequence[NDArray[Any] | None], other: Sequence[NDArray[Any] | None], equal_nan: bool = False
) -> list[bool]:
    """Which of two lists' arrays differ to the last bit; array by array only where the whole does.

    Args:
        one: Arrays; None where there is none.
        other: As many.
        equal_nan: Whether NaN is NaN.

    Returns:
        A flag a pair: another shape, another number, or only one of them None.

    Example:
        >>> differing([np.zeros(2), None, np.zeros(1)], [np.zeros(2), None, np.zeros((1, 1))])
        [False, False, True]
    """
    shapes = [[None if v is None else v.shape for v in values] for values in (one, other)]
    if shapes[0] == shapes[1]:
        a, b = (
            np.concatenate([np.empty(0), *[v for v in values if v is not None]], axis=None) for values in (one, other)
        )
        if np.array_equal(a, b, equal_nan=equal_nan):
            return [False] * len(shapes[0])
    return [not _same(a, b, equal_nan) for a, b in zip(one, other, strict=True)]


def _same(one: NDArray[Any] | None, other: NDArray[Any] | None, equal_nan: bool) -> bool:
    if one is None or other is None:
        return one is None and other is None
    return np.array_equal(one, other, equal_nan=equal_nan)
