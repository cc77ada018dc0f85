"""Active taxels by a threshold, with or without hysteresis."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.common.arrays import mask, numbers
from plantar.errors import InputError, ReadingError
from plantar.layouts.layout import SoleLayout


def active_taxels(force: ArrayLike, threshold: float, saturation: float = math.inf) -> NDArray[np.bool_]:
    """Mask (..., n) of taxels above the activation threshold (T 4.22: |f_iz| > epsilon_f).

    NaN, inf, negative readings and saturated taxels are not active.

    `force`: normal forces (..., n) in N; `threshold`: activation threshold epsilon_f in N; `saturation`: force in N
    from which taxel is saturated.

    Returns mask; ReadingError, InputError: forces not numeric.
    """
    given = numbers(force, "forces", ReadingError)
    low = number(threshold, "activation threshold")
    high = number(saturation, "saturation")
    return np.asarray((given > low) & (given < high))


def hysteresis(
    values: ArrayLike, high: float, low: float, initial: ArrayLike | bool = False, saturation: float = math.inf
) -> NDArray[np.bool_]:
    """Two-threshold switch: on above `high`, off at `low` or below, else as before.

    `values`: values (frames, ...) over time; `high`: switches on above it; `low`: switches off at or below it; not
    above `high`; `initial`: state (...) before the first frame.

    Returns state (frames, ...) after each frame; InputError: `low` above `high`.

    Example:
        >>> hysteresis([0.0, 2.0, 1.2, 0.9, 1.2], high=1.5, low=1.0).tolist()
        [False, True, True, False, False]
    """
    high, low, saturation = _checked(high, low, saturation)
    series = numbers(values, "values of a hysteresis")
    if series.ndim == 0:
        raise InputError("values of a hysteresis have no time axis; expected (frames, ...)")
    on = (series > high) & (series < saturation)
    decided = on | ~((series > low) & (series < saturation))
    # The state after a frame is that of the last frame that decided.
    frame = np.arange(1, len(series) + 1).reshape(-1, *(1,) * (series.ndim - 1))
    last = np.maximum.accumulate(np.where(decided, frame, 0), axis=0)
    before = mask(initial, "initial state", (...,))
    if before.shape not in ((), series.shape[1:]):
        raise InputError(f"initial state has shape {before.shape}; expected () or {series.shape[1:]}")
    start = np.broadcast_to(before, series.shape[1:])[None]
    return np.asarray(np.take_along_axis(np.concatenate([start, on]), last, axis=0))


def active_of(layout: SoleLayout, force: ArrayLike, threshold: float | None = None) -> NDArray[np.bool_]:
    """Mask (..., n) of a sole's active taxels: `active_taxels`, none of a sole that measures no more than noise.

    At the layout's own threshold that is decided by its `contact_levels`; another threshold stands for itself.

    `force`: normal forces (..., n) in N; `threshold`: activation threshold in N; layout's if None.
    """
    low = layout.force_threshold if threshold is None else threshold
    above = active_taxels(force, low, layout.force_limit)
    cell, sole = layout.contact_levels
    if not cell or low != layout.force_threshold:
        return above
    given = np.asarray(force, dtype=np.float64)
    pressed = np.where(given > 0.0, given, 0.0)  # without NaN
    with np.errstate(over="ignore"):
        total = pressed.sum(axis=-1, keepdims=True)
    return np.asarray(above & ((pressed.max(axis=-1, keepdims=True) > cell) | (total > sole)))


class TaxelActivation:
    """Hysteresis of a sole's active taxels, reading by reading (T 4.22).

    Args:
        threshold: Force in N above which a taxel becomes active.
        release: Force in N up to which it stops, at most `threshold`; half of it if None.
        saturation: Force in N from which it is not active.

    Raises:
        InputError: `release` above `threshold`.
    """

    def __init__(self, threshold: float, release: float | None = None, saturation: float = math.inf) -> None:
        self.threshold = number(threshold, "activation threshold", nan=True)
        self.threshold, self.release, self.saturation = _checked(
            self.threshold, 0.5 * self.threshold if release is None else release, saturation
        )
        self._active: NDArray[np.bool_] | None = None

    def reset(self) -> None:
        """Set all taxels inactive."""
        self._active = None

    def update(self, force: ArrayLike) -> NDArray[np.bool_]:
        """Active taxels (n,) after the next forces (n,) in N; ReadingError for another shape."""
        now = numbers(force, "forces", ReadingError)
        if now.ndim != 1:
            raise ReadingError(f"forces have shape {now.shape}; expected (taxels,)")
        if self._active is not None and now.shape != self._active.shape:
            raise ReadingError(f"reading has {now.shape} taxels; the ones before had {self._active.shape}")
        active = now > self.threshold
        if self._active is not None:
            active |= self._active & (now > self.release)
        active &= now < self.saturation
        self._active = active
        return active.copy()


def _checked(high: float, low: float, saturation: float) -> tuple[float, float, float]:
    on = number(high, "threshold of a hysteresis", nan=True)
    off = number(low, "threshold of a hysteresis", nan=True)
    if not off <= on:
        raise InputError(f"hysteresis switches off at {low} and on above {high}; allowed: off not above on")
    return on, off, number(saturation, "saturation")
