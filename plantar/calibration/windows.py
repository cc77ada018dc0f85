"""What a fit reads of a take: counts and loads in windows of a tenth of a second, with what each taxel's loop adds."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.calibration.take import Take
from plantar.common.sides import Side
from plantar.layouts.calibration import LoopState

WINDOW = 0.1
"""Width of a window in s: shorter than the times in which a load on a foot changes, longer than a sensor's noise."""

_CLASSES = 4  # of windows with as fast a load: a body in motion is known less well than one that leans slowly
_SMOOTHED = 10  # windows
_ALONE = 0.02  # of all counts that other soles may have while one carries alone
_LIFTED = 0.05  # of a sole's largest sum of counts
_SETTLED = 1.5  # s after which a body that was set on a sole stands
_FEWEST_BITS = 8  # of a converter


class SoleWindows(NamedTuple):
    """Of one sole: `above` (k, n), the counts above the offset, and the `loops` (2, k, n) of `LoopState`."""

    above: NDArray[np.float64]
    loops: NDArray[np.float64]


class Windows(NamedTuple):
    """One take in k windows.

    `soles`: of each side; `load` (k,) in N; `cop`: (k, 2) in m of each side, NaN where unknown or not alone; `speed`:
    class (k,) of how fast the load changes, 0 the slowest quarter; `usable` (k,): no count is missing, or at
    a converter's end.
    """

    soles: Mapping[Side, SoleWindows]
    load: NDArray[np.float64]
    cop: Mapping[Side, NDArray[np.float64]]
    speed: NDArray[np.int64]
    usable: NDArray[np.bool_]


def windows_of(
    take: Take, offset: Mapping[Side, NDArray[np.float64]], top: Mapping[Side, NDArray[np.float64]]
) -> Windows:
    """Windows of a take with a load. `offset`, `top`: counts (n,) of each side without load and at its largest."""
    width = max(1, round(WINDOW * take.rate))
    k = len(take.time) // width

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(values[: k * width].reshape(k, width, *values.shape[1:]).mean(axis=1))

    soles: dict[Side, SoleWindows] = {}
    spoilt = np.zeros(len(take.time), dtype=bool)
    for side, counts in take.counts.items():
        state = LoopState(top[side], 1.0 / take.rate)
        above = np.nan_to_num(counts - offset[side])
        loops = np.array([state.advance(row) for row in above])
        soles[side] = SoleWindows(mean(above), np.array([mean(loops[:, 0]), mean(loops[:, 1])]))
        spoilt |= _at_the_end(counts) | np.isnan(counts[:, ~np.isnan(counts).all(axis=0)]).any(axis=1)
    assert isinstance(take.load, np.ndarray)  # of all takes but zeros
    load = mean(take.load)
    summed = {side: sole.above.sum(axis=1) for side, sole in soles.items()}
    every = sum(summed.values())
    cop = {}
    for side, places in take.cop.items():
        alone = every - summed[side] < _ALONE * np.maximum(every, 1e-9)
        cop[side] = np.where(alone[:, None], mean(places), np.nan)
    usable = ~(mean(spoilt.astype(float)) > 0.0) & np.isfinite(load)
    if take.kind == "motion" and np.ptp(take.load) == 0.0:
        usable &= ~_near_steps(summed)
    return Windows(soles, load, cop, _speed_classes(load, soles, top), usable)


def _at_the_end(counts: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Frames (k,) in which a taxel is at the largest count of a converter, which is a power of two less 1."""
    most = float(np.nanmax(counts))
    bits = np.log2(most + 1.0) if most > 0.0 else 0.0
    if bits < _FEWEST_BITS or bits != round(bits):
        return np.zeros(len(counts), dtype=bool)
    return np.asarray((counts >= most).any(axis=1))


def _near_steps(summed: Mapping[Side, NDArray[np.float64]]) -> NDArray[np.bool_]:
    """Windows (k,) near those in which a sole is lifted or set down, when the body accelerates: its weight is no load.

    `summed`: counts (k,) of each side.
    """
    events = np.zeros(len(next(iter(summed.values()))), dtype=bool)
    for counts in summed.values():
        on = counts > _LIFTED * np.quantile(counts, 0.98)
        events[1:] |= on[1:] != on[:-1]
    reach = round(_SETTLED / WINDOW)
    return np.asarray(np.convolve(events, np.ones(2 * reach + 1), mode="same") > 0.0)


def _speed_classes(
    load: NDArray[np.float64], soles: Mapping[Side, SoleWindows], top: Mapping[Side, NDArray[np.float64]]
) -> NDArray[np.int64]:
    speed = np.zeros(len(load))
    for side, sole in soles.items():
        if len(load) > 1:
            speed += np.abs(np.gradient(sole.above, axis=0) / top[side]).mean(axis=1)
    smooth = np.convolve(speed, np.full(_SMOOTHED, 1.0 / _SMOOTHED), mode="same")
    edges = np.quantile(smooth, np.arange(1, _CLASSES) / _CLASSES)
    return np.searchsorted(edges, smooth).astype(np.int64)
