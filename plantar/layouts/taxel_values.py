"""Checks of readings and masks from callers for the taxels of one layout.

A taxel that reads NaN or inf is dead: left out of every sum, no error.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.arguments import LARGEST, does, instance
from plantar.arrays import is_finite, mask, numbers
from plantar.errors import PlantarError, ReadingError
from plantar.layouts.layout import SoleLayout

__all__ = ["taxel_frames", "taxel_mask", "taxel_values", "without_dead"]

_FLOAT, _BOOL = np.dtype(np.float64), np.dtype(np.bool_)


def taxel_values(layout: SoleLayout, values: object, name: str = "forces") -> NDArray[np.float64]:
    """One reading of a sole's taxels.

    Args:
        layout: The sole, n taxels.
        values: The argument.
        name: Its name in an error.

    Returns:
        Values (n,), NaN where a taxel is dead; not copied if float64.

    Raises:
        ReadingError, InputError: If these are not n real numbers, or it is not a layout.
    """
    if not isinstance(layout, SoleLayout):
        instance(layout, SoleLayout, "layout")
    given = values if type(values) is np.ndarray and values.dtype is _FLOAT else numbers(values, name, ReadingError)
    if given.shape != (len(layout.corners),):
        raise _misfit(layout, given.shape, name)
    return given


def taxel_frames(layout: SoleLayout, values: object, name: str = "forces") -> NDArray[np.float64]:
    """One reading of a sole's taxels, (n,), or several, (frames, n), as `taxel_values`.

    Args:
        layout: The sole, n taxels.
        values: The argument.
        name: Its name in an error.

    Returns:
        The values.
    """
    instance(layout, SoleLayout, "layout")
    given = numbers(values, name, ReadingError)
    if given.ndim not in (1, 2) or given.shape[-1] != len(layout):
        raise _misfit(layout, given.shape, name)
    return given


def taxel_mask(layout: SoleLayout, values: object, name: str = "mask") -> NDArray[np.bool_]:
    """Some of a sole's taxels as a mask (n,), not copied if bool; a ReadingError unless n truth values.

    Args:
        layout: The sole, n taxels.
        values: The argument.
        name: Its name in an error.

    Returns:
        The mask.
    """
    if not isinstance(layout, SoleLayout):
        instance(layout, SoleLayout, "layout")
    given = values if type(values) is np.ndarray and values.dtype is _BOOL else mask(values, name, (...,), ReadingError)
    if given.shape != (len(layout.corners),):
        raise _misfit(layout, given.shape, name)
    return given


def without_dead(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Readings with 0 where a taxel is dead; the array itself if none is.

    Args:
        values: Readings of any shape.
    """
    return values if is_finite(values) else np.where(np.abs(values) <= LARGEST, values, 0.0)


def _misfit(layout: SoleLayout, shape: tuple[int, ...], name: str) -> PlantarError:
    return ReadingError(f"{does(name, 'have')} shape {shape}; layout '{layout.name}' has {len(layout)} taxels")
