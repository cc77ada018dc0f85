"""Taxel faults, identified from a recording under known forces."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST
from plantar.common.arrays import array
from plantar.errors import ReadingError
from plantar.layouts.layout import SoleLayout
from plantar.sensing.taxel_faults import WARMING, TaxelFaults, WornFaults

_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
_ROUNDS = 16  # over delay, crosstalk and hysteresis, one after the other: delay and hysteresis both come late
_TURNS = 10  # of a golden section: a hundredth of its range
_LONGEST = 0.2  # s, of a delay
_MOST_SHARE = 0.5  # of crosstalk and hysteresis
_MOST_FRAMES = 4000


class IdentifiedFaults(NamedTuple):
    """Faults of a sole's taxels from a recording.

    `worn`: taxels' own faults, to apply to other forces; without noise; `faults`: their statistics, to draw other such
    soles; `gain_error`: standard error (n,) of each gain; NaN for dead taxels; `residual`: RMS (n,) in N of each
    taxel's error after fit.
    """

    worn: WornFaults
    faults: TaxelFaults
    gain_error: NDArray[np.float64]
    residual: NDArray[np.float64]


def identify_faults(layout: SoleLayout, time: ArrayLike, force: ArrayLike, read: ArrayLike) -> IdentifiedFaults:
    """Identify gains, zeros, drifts, dead taxels, crosstalk, hysteresis, delay, resolution and noise.

    Golden sections search crosstalk, hysteresis and delay; gains, zeros and drifts follow by least squares. Shear needs
    tangential forces and is not identified.

    Args:
        layout: Sole, n taxels.
        time: Times (t,) in s, increasing, 20 or more.
        force: Known normal force (t, n) on each taxel in N, rising and falling.
        read: Readings (t, n) in N; NaN if dead or lost.

    Returns faults; raises ReadingError under 20 frames.
    """
    times = array(time, "times", ("t",), ReadingError, finite=True)
    if len(times) < 20 or not (np.diff(times) > 0.0).all():
        raise ReadingError("faults are identified from 20 frames or more, at times that increase")
    truth = array(force, "forces", (len(times), len(layout)), ReadingError, finite=True)
    seen = array(read, "readings", truth.shape, ReadingError)
    lost = ~(np.abs(seen) <= LARGEST)
    dead = lost.mean(axis=0) > 0.5
    whole = ~lost[:, ~dead].any(axis=1)  # frames that the others all measured
    times = times[whole]
    truth = truth[whole]
    seen = np.where(lost, np.nan, seen)[whole]
    if len(times) < 20:
        raise ReadingError(f"{len(times)} frames were measured by all taxels that are not dead; allowed: 20 or more")
    loaded = np.ptp(truth, axis=0) > 0.0
    if not loaded.any():
        raise ReadingError("no taxel's load changes; press each with loads that come on and go off")
    dead |= loaded & (np.ptp(np.nan_to_num(seen), axis=0) == 0.0)
    used = np.flatnonzero(loaded & ~dead)
    if not len(used):
        raise ReadingError("all taxels that are loaded are dead")
    resolution = _resolution(seen[:, used])
    fit = _Fit(layout, times[:_MOST_FRAMES], truth[:_MOST_FRAMES], seen[:_MOST_FRAMES], used)
    shares = {"delay": 0.0, "crosstalk": 0.0, "hysteresis": 0.0}
    most = {"delay": min(_LONGEST, 0.2 * float(np.ptp(times))), "crosstalk": _MOST_SHARE, "hysteresis": _MOST_SHARE}
    for turn in range(_ROUNDS):
        for name in shares:
            # First over the whole range, then about what was found, ever finer.
            reach = most[name] / 2.0**turn
            low = max(0.0, shares[name] - reach)
            high = min(most[name], shares[name] + reach)
            shares[name] = fit.lowest(shares, name, low, high)
    common = TaxelFaults(**shares)
    solved, residual = fit.solve(shares)
    full = np.full(len(layout), np.nan)
    gains, offsets, drifts, left, error = (full.copy() for _ in range(5))
    offsets[used], drifts[used], gains[used] = solved
    left[used] = np.sqrt(np.square(residual).mean(axis=0))
    error[used] = fit.gain_error(shares, residual)
    statistics = replace(
        common,
        gain=float(gains[used].std()),
        offset=float(offsets[used].std()),
        drift=float(drifts[used].std()),
        dead=min(0.9, float(dead.mean())),
        noise=math.sqrt(max(0.0, float(np.median(left[used])) ** 2 - resolution**2 / 12.0)),
        resolution=resolution,
    )
    gains, offsets, drifts = np.where(
        np.isnan([gains, offsets, drifts]), [[1.0], [0.0], [0.0]], [gains, offsets, drifts]
    )
    worn = WornFaults(layout, replace(common, resolution=resolution), gains, offsets, drifts, dead)
    return IdentifiedFaults(worn, statistics, error, left)


class _Fit:
    """Least squares of gains, zeros and drifts for given shares."""

    def __init__(
        self,
        layout: SoleLayout,
        times: NDArray[np.float64],
        truth: NDArray[np.float64],
        seen: NDArray[np.float64],
        used: NDArray[np.intp],
    ) -> None:
        self._layout = layout
        self._times = times
        self._truth = truth
        self._used = used
        self._seen = seen[:, used]
        self._key = (-1.0, -1.0)
        self._rubbed = truth
        self._fixed = np.ones((len(times), 1))
        if np.ptp(times) > 0.2 * WARMING:  # within seconds no drift shows
            self._fixed = np.column_stack([self._fixed, -np.expm1(-np.maximum(times, 0.0) / WARMING)])
        self._inverse = np.linalg.pinv(self._fixed)

    def _pressed(self, shares: dict[str, float]) -> NDArray[np.float64]:
        key = shares["crosstalk"], shares["hysteresis"]
        if key != self._key:
            worn = WornFaults(
                self._layout, TaxelFaults(crosstalk=key[0], hysteresis=key[1]), np.ones(len(self._layout))
            )
            self._key = key
            self._rubbed = np.array([worn.rubbed(row) for row in self._truth])[:, self._used]
        rubbed = self._rubbed
        due = self._times - shares["delay"]
        after = np.clip(np.searchsorted(self._times, due), 1, len(due) - 1)
        share = (due - self._times[after - 1]) / (self._times[after] - self._times[after - 1])
        share = np.clip(share, 0.0, 1.0)[:, None]
        return np.asarray((1.0 - share) * rubbed[after - 1] + share * rubbed[after])

    def solve(self, shares: dict[str, float]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Zeros, drifts and gains (3, used), and residual (t, used) in N."""
        pressed = self._pressed(shares)
        off, seen = (values - self._fixed @ (self._inverse @ values) for values in (pressed, self._seen))
        gains = (off * seen).sum(axis=0) / np.maximum(np.square(off).sum(axis=0), 1e-300)
        rest = self._inverse @ (self._seen - gains * pressed)
        return np.array([rest[0], rest[1] if len(rest) > 1 else 0.0 * gains, gains]), seen - gains * off

    def error(self, shares: dict[str, float]) -> float:
        return float(np.square(self.solve(shares)[1]).sum())

    def lowest(self, shares: dict[str, float], name: str, low: float, high: float) -> float:
        """One share's best value from low to high, by golden section."""

        def error(value: float) -> float:
            return self.error({**shares, name: value})

        best = shares[name]
        least = error(shares[name])
        a = high - _GOLDEN * (high - low)
        b = low + _GOLDEN * (high - low)
        at_a = error(a)
        at_b = error(b)
        for _ in range(_TURNS):
            for value, left in ((a, at_a), (b, at_b)):
                if left < least:
                    best = value
                    least = left
            if at_a <= at_b:
                high = b
                b = a
                at_b = at_a
                a = high - _GOLDEN * (high - low)
                at_a = error(a)
            else:
                low = a
                a = b
                at_a = at_b
                b = low + _GOLDEN * (high - low)
                at_b = error(b)
        return best

    def gain_error(self, shares: dict[str, float], left: NDArray[np.float64]) -> NDArray[np.float64]:
        pressed = self._pressed(shares)
        off = pressed - pressed.mean(axis=0)
        return np.asarray(np.sqrt(np.square(left).sum(axis=0) / max(1, len(left) - 3) / np.square(off).sum(axis=0)))


def _resolution(seen: NDArray[np.float64]) -> float:
    values = np.unique(seen)
    steps = np.diff(values)
    steps = steps[steps > 1e-9 * max(1.0, float(np.abs(values).max()))]
    if len(steps) < 2 or len(steps) > 0.2 * seen.size:
        return 0.0
    step = float(steps.min())
    counts = np.round(values / step)
    step = float((values @ counts) / (counts @ counts)) if counts.any() else step
    return step if bool((np.abs(values / step - np.round(values / step)) < 1e-3).all()) else 0.0
