"""Which taxels to believe: dead, saturated and stuck ones are found, reported, and filled from neighbours on demand."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError, ReadingError
from plantar.layout import SoleLayout
from plantar.lazy import lazy

__all__ = ["StuckMonitor", "TaxelHealth", "dead_taxels", "fill_from_neighbours", "saturated_taxels", "stuck_taxels"]


@dataclass(frozen=True, eq=False)
class TaxelHealth:
    """The taxels of a sole that are left out of every sum, and why.

    Attributes:
        dead: Taxels (n,) that read NaN or inf.
        saturated: Taxels (n,) that read the end of their range or more: the true force is unknown.
        stuck: Taxels (n,) that have not changed for too long.

    Example:
        >>> health = TaxelHealth(*np.array([[True, False, False], [False, False, True], [False, False, False]]))
        >>> health.faulty.tolist(), str(health)
        ([True, False, True], '1 dead, 1 saturated, 0 stuck of 3 taxels')
    """

    dead: NDArray[np.bool_]
    saturated: NDArray[np.bool_]
    stuck: NDArray[np.bool_]

    @lazy
    def faulty(self) -> NDArray[np.bool_]:
        """Taxels (n,) with any of the three faults."""
        return self.dead | self.saturated | self.stuck

    def __str__(self) -> str:
        counts = [f"{int(getattr(self, name).sum())} {name}" for name in ("dead", "saturated", "stuck")]
        return f"{', '.join(counts)} of {len(self.dead)} taxels"


def dead_taxels(values: ArrayLike) -> NDArray[np.bool_]:
    """Taxels that read no finite number.

    Args:
        values: Readings (..., n) of a modality; a distance of inf means out of range and is not for this function.

    Returns:
        Mask (..., n).

    Example:
        >>> dead_taxels([1.0, np.nan, -np.inf]).tolist()
        [False, True, True]
    """
    return ~np.isfinite(np.asarray(values, dtype=np.float64))


def saturated_taxels(values: ArrayLike, highest: float) -> NDArray[np.bool_]:
    """Taxels at the upper end of their range; dead ones are not.

    Args:
        values: Readings (..., n) of a modality.
        highest: Upper end of its range in the same unit, for example `layout.ranges["force"][1]`.

    Returns:
        Mask (..., n).

    Example:
        >>> saturated_taxels([784.0, 785.0, np.nan, np.inf], 785.0).tolist()
        [False, True, False, False]
    """
    readings = np.asarray(values, dtype=np.float64)
    mask = np.isfinite(readings)
    mask &= readings >= highest
    return np.asarray(mask)


def stuck_taxels(
    times: ArrayLike, values: ArrayLike, hold: float = 1.0, tolerance: float = 0.0, rest: float = 0.0
) -> NDArray[np.bool_]:
    """Taxels that have not changed for a time although they read a load.

    A value changes where it differs from the sample before by more than the tolerance, or comes from or goes to NaN. A
    taxel at rest says nothing: a sound taxel in the air reads a constant 0 too. Sensors that resolve coarse steps need
    a `hold` longer than the robot stands still.

    Args:
        times: Times (frames,) in s, increasing.
        values: Readings (frames, n), for example forces in N.
        hold: Time in s without a change from which a taxel is stuck.
        tolerance: Largest difference of two samples that is no change.
        rest: A taxel that reads this or less is at rest, and never stuck.

    Returns:
        Mask (frames, n): stuck at that frame.

    Raises:
        InputError: If the times are not increasing or their number is not that of the frames, or `hold` is not above 0.

    Example:
        >>> stuck_taxels([0.0, 0.5, 1.0], [[0, 5, 5], [0, 5, 6], [0, 5, 5]], hold=1.0).tolist()[-1]
        [False, True, False]
    """
    t, series = np.asarray(times, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if series.ndim != 2 or t.shape != series.shape[:1]:
        raise InputError(f"times {t.shape} and values {series.shape} do not agree; expected (frames,) and (frames, n)")
    if not (np.diff(t) > 0.0).all():
        raise InputError("times are not increasing")
    _check_stuck(hold, tolerance)
    changed = np.ones(series.shape, dtype=bool)
    changed[1:] = ~_same(series[1:], series[:-1], tolerance)
    last = np.maximum.accumulate(np.where(changed, np.arange(len(t))[:, None], 0), axis=0)
    return np.asarray((t[:, None] - t[last] >= hold) & (series > rest) & (series < np.inf))


class StuckMonitor:
    """Finds stuck taxels reading by reading; the same rule as `stuck_taxels`.

    Args:
        hold: Time in s without a change from which a taxel is stuck.
        tolerance: Largest difference of two samples that is no change.
        rest: A taxel that reads this or less is at rest, and never stuck.

    Raises:
        InputError: If `hold` is not above 0 or `tolerance` is below 0.

    Example:
        >>> monitor = StuckMonitor(hold=1.0)
        >>> [monitor.update(t, [5.0, 5.0 + t]).tolist() for t in (0.0, 1.0)]
        [[False, False], [True, False]]
    """

    def __init__(self, hold: float = 1.0, tolerance: float = 0.0, rest: float = 0.0) -> None:
        _check_stuck(hold, tolerance)
        self.hold, self.tolerance, self.rest = hold, tolerance, rest
        self._last: NDArray[np.float64] | None = None
        self._since = np.empty(0)
        self._time = -math.inf

    def reset(self) -> None:
        """Forget the past."""
        self._last, self._time = None, -math.inf

    def update(self, time: float, values: ArrayLike) -> NDArray[np.bool_]:
        """Stuck taxels (n,) after the next reading.

        Args:
            time: Time in s, later than the one before.
            values: Readings (n,).

        Returns:
            Mask (n,).

        Raises:
            InputError: If the time is not later than the one before.
            ReadingError: If the number of taxels differs from that of the reading before.
        """
        now = np.array(values, dtype=np.float64)
        if not time > self._time:
            raise InputError(f"time {time} s is not later than the one before, {self._time} s")
        if self._last is None:
            self._since = np.full(now.shape, time)
        elif now.shape != self._last.shape:
            raise ReadingError(f"reading has {now.shape} taxels; the ones before had {self._last.shape}")
        else:
            self._since[~_same(now, self._last, self.tolerance)] = time
        self._last, self._time = now, time
        return np.asarray((time - self._since >= self.hold) & (now > self.rest) & (now < np.inf))


def fill_from_neighbours(
    layout: SoleLayout, values: ArrayLike, faulty: ArrayLike, *, per_area: bool = False
) -> NDArray[np.float64]:
    """Readings in which faulty taxels hold the mean of their sound neighbours.

    Args:
        layout: The sole, n taxels.
        values: Readings (n,) or (frames, n); never changed.
        faulty: Mask (n,) or of the shape of `values`: the taxels to fill.
        per_area: Average the value per area and scale it with the taxel's own area, as is right for forces where cells
            differ in size: force_i = A_i * mean(force_j / A_j).

    Returns:
        Readings in the shape of `values`; a faulty taxel without a sound neighbour holds NaN.

    Raises:
        ReadingError: If the number of taxels is not that of the layout.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], clip=False)
        >>> force = np.full(len(layout), 3.0)
        >>> force[4] = np.nan
        >>> bool((fill_from_neighbours(layout, force, np.isnan(force)) == 3.0).all())
        True
    """
    out = np.array(values, dtype=np.float64)
    if out.ndim not in (1, 2) or out.shape[-1] != len(layout):
        raise ReadingError(f"readings have shape {out.shape}; layout '{layout.name}' has {len(layout)} taxels")
    bad = np.asarray(faulty, dtype=bool)
    if bad.shape != out.shape:
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
    """Neighbours (n, most) of every taxel, padded, and which of them are there; made at first use."""
    try:
        table: tuple[NDArray[np.intp], NDArray[np.bool_]] = layout.__dict__["_neighbour_table"]
    except KeyError:
        most = max(map(len, layout.neighbours), default=0)
        near = np.zeros((len(layout), most), dtype=np.intp)
        known = np.zeros((len(layout), most), dtype=bool)
        for taxel, row in enumerate(layout.neighbours):
            near[taxel, : len(row)] = row
            known[taxel, : len(row)] = True
        table = layout.__dict__["_neighbour_table"] = near, known
    return table


def _same(now: NDArray[np.float64], before: NDArray[np.float64], tolerance: float) -> NDArray[np.bool_]:
    if tolerance == 0.0:  # no two numbers that differ have a difference of 0
        return np.asarray(now == before)
    with np.errstate(invalid="ignore"):  # inf - inf
        return np.asarray((now == before) | (np.abs(now - before) <= tolerance))


def _check_stuck(hold: float, tolerance: float) -> None:
    if not hold > 0.0:
        raise InputError(f"stuck taxels are held for {hold} s; allowed: above 0")
    if not tolerance >= 0.0:
        raise InputError(f"tolerance of stuck taxels is {tolerance}; allowed: 0 or more")
