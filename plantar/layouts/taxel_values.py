"""Checks of callers' readings and masks; NaN or inf is a dead taxel, left out of sums."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import LARGEST, instance
from plantar.common.arrays import is_finite, mask, numbers
from plantar.errors import PlantarError, ReadingError
from plantar.layouts.layout import SoleLayout

_FLOAT = np.dtype(np.float64)
_BOOL = np.dtype(np.bool_)


def taxel_values(layout: SoleLayout, values: object, name: str = "forces") -> NDArray[np.float64]:
    """Returns one reading `values` (n,) of a `layout`'s taxels, NaN where dead, not copied if float64.

    A ReadingError or InputError with its `name` for others.
    """
    if not isinstance(layout, SoleLayout):
        instance(layout, SoleLayout, "layout")
    given = values if type(values) is np.ndarray and values.dtype is _FLOAT else numbers(values, name, ReadingError)
    if given.shape != (len(layout.corners),):
        raise _misfit(layout, given.shape, name)
    return given


def taxel_frames(layout: SoleLayout, values: object, name: str = "forces") -> NDArray[np.float64]:
    """Returns `values` (n,) or (frames, n) of a `layout`'s taxels, as `taxel_values`, with their `name` in errors."""
    instance(layout, SoleLayout, "layout")
    given = numbers(values, name, ReadingError)
    if given.ndim not in (1, 2) or given.shape[-1] != len(layout):
        raise _misfit(layout, given.shape, name)
    return given


def taxel_mask(layout: SoleLayout, values: object, name: str = "mask") -> NDArray[np.bool_]:
    """Returns mask `values` (n,) of a `layout`'s taxels; a ReadingError with its `name` unless n truth values."""
    if not isinstance(layout, SoleLayout):
        instance(layout, SoleLayout, "layout")
    given = values if type(values) is np.ndarray and values.dtype is _BOOL else mask(values, name, (...,), ReadingError)
    if given.shape != (len(layout.corners),):
        raise _misfit(layout, given.shape, name)
    return given


def without_dead(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Readings of any shape with 0 where dead; not copied if none is."""
    return values if is_finite(values) else np.where(np.abs(values) <= LARGEST, values, 0.0)


def _misfit(layout: SoleLayout, shape: tuple[int, ...], name: str) -> PlantarError:
    return ReadingError(f"{name}: shape {shape}; layout '{layout.name}' has {len(layout)} taxels")
