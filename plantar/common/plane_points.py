"""Checks of a caller's points of the plane."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import LARGEST
from plantar.common.arrays import not_finite, numbers
from plantar.errors import InputError
from plantar.kernels.base.limits import are_plane_points, pair_of, points_within

_FLOAT = np.dtype(np.float64)


def plane_points(value: object, name: str = "polygon", *, finite: bool = True) -> NDArray[np.float64]:
    """Points of the plane; an empty list is none.

    `finite`: refuse NaN, inf, and what is beyond `LARGEST`. Returns points (k, 2), not copied if float64.

    Example:
        >>> plane_points([]).shape
        (0, 2)
    """
    if are_plane_points(value, LARGEST):
        return value  # type: ignore[return-value]  # which an array it is; `cast` costs half of what the check does
    points = value if type(value) is np.ndarray and value.dtype is _FLOAT else numbers(value, name)
    if points.ndim != 2 or points.shape[1] != 2:
        if points.shape == (0,):
            return points.reshape(0, 2)
        raise InputError(f"{name}: shape {points.shape}; expected (k, 2)")
    if finite and not points_within(points, LARGEST):
        raise not_finite(points, name)
    return points


def plane_point(value: object, name: str = "point") -> tuple[float, float]:
    """One point of the plane, NaN or not.

    Example:
        >>> plane_point([1, 2])
        (1.0, 2.0)
    """
    if type(value) is tuple and len(value) == 2 and type(value[0]) is float and type(value[1]) is float:
        return value
    pair: tuple[float, float] | None = pair_of(value)
    if pair is not None:
        return pair
    given = numbers(value, name)
    if given.shape != (2,):
        raise InputError(f"{name}: shape {given.shape}; expected (2,)")
    x, y = given.tolist()
    return x, y
