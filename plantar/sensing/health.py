"""Dead, saturated and stuck taxels, and their replacement by neighbours."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.common.arrays import mask, numbers, read_only
from plantar.common.lazy import lazy
from plantar.errors import InputError, ReadingError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_frames


@dataclass(frozen=True, eq=False)
class TaxelHealth:
    """Taxels of a sole left out of every sum, and why.

    `dead`: taxels (n,) that read NaN or inf; `saturated`: taxels (n,) that read end of their range or more; `stuck`:
    taxels (n,) that have not changed for too long.
    """

    dead: NDArray[np.bool_]
    saturated: NDArray[np.bool_]
    stuck: NDArray[np.bool_]

    def __post_init__(self) -> None:
        for name in ("dead", "saturated", "stuck"):
            self.__dict__[name] = read_only(mask(getattr(self, name), f"mask '{name}'", ("n",), ReadingError).copy())
        if not self.dead.shape == self.saturated.shape == self.stuck.shape:
            raise ReadingError(
                f"masks of faults have shapes {self.dead.shape}, {self.saturated.shape} and {self.stuck.shape}; "
                "expected the same"
            )

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles are made anew: numpy forgets what is read-only.
        return type(self), (self.dead, self.saturated, self.stuck)

    @lazy
    def faulty(self) -> NDArray[np.bool_]:
        """Taxels (n,) with any of the three faults."""
        return self.dead | self.saturated | self.stuck

    def __str__(self) -> str:
        counts = [f"{int(getattr(self, name).sum())} {name}" for name in ("dead", "saturated", "stuck")]
        return f"{', '.join(counts)} of {len(self.dead)} taxels"


def dead_taxels(values: ArrayLike) -> NDArray[np.bool_]:
    """Mask (..., n) of taxels without a finite number; not for distances, where inf means out of range.

    `values`: readings (..., n) of modality; ReadingError if not numeric.
    """
    return np.asarray(~np.isfinite(numbers(values, "readings", ReadingError)))


def saturated_taxels(values: ArrayLike, highest: float) -> NDArray[np.bool_]:
    """Mask (..., n) of taxels at their range's upper end; dead ones are not.

    Args:
        values: Readings (..., n) of modality.
        highest: Upper end of its range, e.g. `layout.ranges["force"][1]`.

    Returns mask; ReadingError, InputError: values not numeric.
    """
    readings = numbers(values, "readings", ReadingError)
    return np.asarray(np.isfinite(readings) & (readings >= number(highest, "upper end of the range")))


def stuck_taxels(
    times: ArrayLike, values: ArrayLike, hold: float = 1.0, tolerance: float = 0.0, rest: float = 0.0
) -> NDArray[np.bool_]:
    """Mask (frames, n) of taxels that have not changed for a time under load.

    A change exceeds the tolerance, or is NaN that comes or goes. Coarse sensors need a `hold` longer than the robot
    stands still.

    Args:
        times: Times (frames,) in s, increasing.
        values: Readings (frames, n), e.g. in N.
        hold: Time in s without a change.
        tolerance: Largest difference of two samples that is no change.
        rest: Largest reading that is never stuck.

    Returns mask; InputError: times not increasing.

    Example:
        >>> stuck_taxels([0.0, 0.5, 1.0], [[0, 5, 5], [0, 5, 6], [0, 5, 5]], hold=1.0).tolist()[-1]
        [False, True, False]
    """
    t = numbers(times, "times")
    series = numbers(values, "readings")
    if series.ndim != 2 or t.shape != series.shape[:1]:
        raise InputError(f"times {t.shape} and values {series.shape} do not agree; expected (frames,) and (frames, n)")
    if not (np.isfinite(t).all() and (t[1:] > t[:-1]).all()):
        raise InputError("times are not finite and increasing")
    hold, tolerance, rest = _checked(hold, tolerance, rest)
    changed = np.ones(series.shape, dtype=bool)
    changed[1:] = ~_same(series[1:], series[:-1], tolerance)
    last = np.maximum.accumulate(np.where(changed, np.arange(len(t))[:, None], 0), axis=0)
    return np.asarray((t[:, None] - t[last] >= hold) & (series > rest) & (series < np.inf))


class StuckMonitor:
    """`stuck_taxels`, reading by reading.

    Args:
        hold: As in `stuck_taxels`.
        tolerance: As in `stuck_taxels`.
        rest: As in `stuck_taxels`.

    Raises:
        InputError: Hold not above 0.
    """

    def __init__(self, hold: float = 1.0, tolerance: float = 0.0, rest: float = 0.0) -> None:
        self.hold, self.tolerance, self.rest = _checked(hold, tolerance, rest)
        self._last: NDArray[np.float64] | None = None
        self._since = np.empty(0)
        self._time = -math.inf

    def reset(self) -> None:
        """Forget the past."""
        self._last = None
        self._time = -math.inf

    def update(self, time: float, values: ArrayLike) -> NDArray[np.bool_]:
        """Stuck taxels (n,) after the next reading.

        Args:
            time: Time in s, later than the last one.
            values: Readings (n,).

        Returns mask (n,); InputError, ReadingError: time not later.
        """
        now = numbers(values, "readings", ReadingError).copy()
        if now.ndim != 1:
            raise ReadingError(f"readings have shape {now.shape}; expected (taxels,)")
        time = number(time, "time", finite=True)
        if not time > self._time:
            raise InputError(f"time {time} s is not later than the one before, {self._time} s")
        if self._last is None:
            self._since = np.full(now.shape, time)
        elif now.shape != self._last.shape:
            raise ReadingError(f"reading has {now.shape} taxels; the ones before had {self._last.shape}")
        else:
            self._since[~_same(now, self._last, self.tolerance)] = time
        self._last = now
        self._time = time
        return np.asarray((time - self._since >= self.hold) & (now > self.rest) & (now < np.inf))


def fill_from_neighbours(
    layout: SoleLayout, values: ArrayLike, faulty: ArrayLike, *, per_area: bool = False
) -> NDArray[np.float64]:
    """Readings with faulty taxels at their sound neighbours' mean, NaN without any.

    `values`: readings (n,) or (frames, n); never changed; `faulty`: mask (n,) or of shape of `values`: taxels to fill;
    `per_area`: average per area, for forces on unequal cells.

    Returns readings in shape of `values`; ReadingError: values or mask do not fit.
    """
    out = taxel_frames(layout, values, "readings").copy()
    bad = mask(faulty, "mask of faulty taxels", (...,), ReadingError)
    if bad.shape != out.shape:
        if bad.shape != out.shape[-1:]:
            raise ReadingError(f"mask of faulty taxels has shape {bad.shape}; expected ({len(layout)},) or {out.shape}")
        bad = np.broadcast_to(bad, out.shape)
    *frame, taxel = bad.nonzero()
    if not len(taxel):
        return out
    near, known = _neighbour_table(layout)
    beside = near[taxel].T  # (most, faulty): first neighbour of every faulty taxel, then the second, ...
    at = (*frame, beside)
    # A neighbour that is not flagged may still read NaN: it is no source either.
    sound = known[taxel].T & ~bad[at] & np.isfinite(out[at])
    source = np.where(sound, out[at], 0.0)
    if per_area:
        source /= layout.areas[beside]
    count = sound.sum(axis=0)
    mean = np.where(count > 0, source.sum(axis=0), np.nan) / np.maximum(count, 1)
    out[bad] = mean * layout.areas[taxel] if per_area else mean
    return out


def _neighbour_table(layout: SoleLayout) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Padded neighbours (n, most) of every taxel, and a mask of the real ones."""
    try:
        table: tuple[NDArray[np.intp], NDArray[np.bool_]] = layout.__dict__["_neighbour_table"]
    except KeyError:
        most = max(map(len, layout.neighbours), default=0)
        near = np.zeros((len(layout), most), dtype=np.intp)
        known = np.zeros((len(layout), most), dtype=bool)
        for taxel, row in enumerate(layout.neighbours):
            near[taxel, : len(row)] = row
            known[taxel, : len(row)] = True
        table = near, known
        layout.__dict__["_neighbour_table"] = table
    return table


def _same(now: NDArray[np.float64], before: NDArray[np.float64], tolerance: float) -> NDArray[np.bool_]:
    if tolerance == 0.0:  # no two numbers that differ have a difference of 0
        return np.asarray(now == before)
    with np.errstate(invalid="ignore"):  # inf - inf
        return np.asarray((now == before) | (np.abs(now - before) <= tolerance))


def _checked(hold: float, tolerance: float, rest: float) -> tuple[float, float, float]:
    for_long = number(hold, "hold of stuck taxels", nan=True)
    same = number(tolerance, "tolerance of stuck taxels", nan=True)
    if not for_long > 0.0:
        raise InputError(f"stuck taxels are held for {hold} s; allowed: above 0")
    if not same >= 0.0:
        raise InputError(f"tolerance of stuck taxels is {tolerance}; allowed: 0 or more")
    return for_long, same, number(rest, "rest of stuck taxels")
