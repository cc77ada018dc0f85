"""Plantar pressure over time, the type that formats are read into."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.layouts.layout import Side, SoleLayout, mirrored
from plantar.recordings.frame_table import ColumnExtremes, blocks_of_frames, column_extremes, table_of_blocks

RATES = (0.1, 1e5)
"""Lowest and highest rate in frames a second that is believed."""

COP_FORCE = 20.0
"""Load in N below which a center of pressure is not given, unless another is stated."""

_GAP = 2.5  # Steps in time of more than so many usual ones are gaps, and are not used for the rate
_COUNTED = 5.0  # Stated rate in Hz from which times that rise by 1 are no seconds but the frames' numbers
# Frames that go on in order, on the average, where a recording has begun again and is not merely out of order.
_BEGUN = 20
# Times that fall to each one that does not, from which rows are in reverse order and not exchanged here and there
_REVERSED = 10
# Least time from one frame to the next, as a share of the usual one: with less every velocity would be infinite.
_LEAST_STEP = 1e-3


Kind = Literal["insole", "platform", "robot", "plate"]
"""What measured: insoles in shoes, a platform that is walked over, a robot's soles, or force plates without cells."""


@dataclass(frozen=True, eq=False, repr=False)
class FootRecording:
    """Cells under one foot, n frames of k cells; FormatError if the layout's count differs.

    Attributes:
        force: Normal cell force (n, k) in N, NaN if unmeasured; counts in raw recordings.
        layout: Cell places, or None.
        total: Device's vertical force (n,) in N, NaN if unmeasured; None to sum cells.
        cop: Device's CoP (n, 2) in m, NaN without load; None to compute it.
        wrench: Wrench (n, 6) on the foot in N and N m about the frame's origin, if measured.
        placement: Sole pose (n, 3) on the ground, x and y in m and turn about z in rad, if known.
        motion: Acceleration (with gravity) in m/s^2 and angular rate in rad/s (n, 6) of an inertial sensor in the sole,
            in its own axes, NaN if unmeasured; None without one.
    """

    side: Side
    force: NDArray[np.float64]
    layout: SoleLayout | None = None
    total: NDArray[np.float64] | None = None
    cop: NDArray[np.float64] | None = None
    wrench: NDArray[np.float64] | None = None
    placement: NDArray[np.float64] | None = None
    motion: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        if self.layout is not None and len(self.layout) != self.force.shape[1]:
            cells = self.force.shape[1]
            name = self.layout.name
            raise FormatError(f"the {self.side} foot has {cells} cells, layout '{name}' {len(self.layout)}")

    def __repr__(self) -> str:
        frames, cells = self.force.shape
        layout = "no layout" if self.layout is None else f"layout '{self.layout.name}'"
        return f"FootRecording({self.side}: {frames} frames of {cells} cells, {layout})"

    @cached_property
    def missing(self) -> NDArray[np.bool_] | None:
        """Missing values (n, k); None if all were measured."""
        lacking = self.extremes.lacking
        if not lacking:
            return None
        missing = np.zeros(self.force.shape, dtype=bool)
        for rows in lacking:
            missing[rows] = np.isnan(self.force[rows])
        return missing

    @cached_property
    def measured(self) -> NDArray[np.float64]:
        """Forces (n, k) with 0 in place of NaN."""
        if self.missing is None:
            return self.force
        missing = self.missing
        return table_of_blocks(self.force, lambda rows: np.where(missing[rows], 0.0, self.force[rows]))

    @cached_property
    def extremes(self) -> ColumnExtremes:
        """Smallest and largest force (k,) of each cell, at most and at least 0, and which frames lack values."""
        return column_extremes(self.force)

    @cached_property
    def vertical_force(self) -> NDArray[np.float64]:
        """Vertical force (n,) in N, the device's total or the cells' sum; NaN if unmeasured.

        A frame lacking over a tenth of the ever-measuring cells counts as unmeasured.
        """
        if self.total is not None:
            return self.total
        total = self._carried
        if self.missing is not None:
            total = total.copy()
            dead = self.missing.all(axis=0)
            lacking = self.missing[:, ~dead].sum(axis=1)
            total[lacking > 0.1 * max(1, int((~dead).sum()))] = np.nan
            if dead.all():
                total[:] = np.nan
        return total

    @cached_property
    def _carried(self) -> NDArray[np.float64]:
        """Vertical force (n,) in N of all cells that measured."""
        rise = np.ones(self.force.shape[1]) if self.layout is None else self.layout.rotations[:, 2, 2]
        return _product(self.measured, rise)

    def pressure(self) -> NDArray[np.float64] | None:
        """Pressure (n, k) in Pa, NaN if unmeasured; None without cell areas."""
        return None if self.layout is None else np.asarray(self.force / self.layout.areas)

    def center_of_pressure(self, minimum_force: float = COP_FORCE) -> NDArray[np.float64] | None:
        """CoP (n, 2) in the sole frame in m (T 4.21); the device's if given, else computed from the cells.

        NaN below `minimum_force` in N, by default 20 N; None without layout.
        """
        with np.errstate(invalid="ignore"):
            loaded = self.vertical_force >= max(minimum_force, 1e-9)
        if self.cop is not None:
            return np.where(loaded[:, None] & np.isfinite(self.cop).all(axis=1, keepdims=True), self.cop, np.nan)
        if self.layout is None:
            return None
        normal = self.layout.rotations[:, 2, 2]
        moments = _product(self.measured, self.layout.positions[:, :2] * normal[:, None])
        carried = self._carried  # by the cells, not the device's force
        out = np.full((len(moments), 2), np.nan)
        loaded &= carried > 0.0
        out[loaded] = moments[loaded] / carried[loaded, None]
        return out


@dataclass(frozen=True, eq=False)
class StatedEvents:
    """Heel strikes (m,) and toe offs (k,) of one foot in s, in order, as a file states."""

    heel_strikes: NDArray[np.float64]
    toe_offs: NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class PressureRecording:
    """Recording of one or two feet on one time base.

    Attributes:
        path: File.
        format: Its name.
        rate_hz: Frames a second.
        time: Times (n,) in s.
        feet: A platform is one entry until `plantar.gait.analysis.prints.platform` separates it.
        metadata: Other file entries.
        warnings: What was assumed, repaired or left out.
        raw: Whether values are uncalibrated counts, without force or pressure.
        grid: Rows and columns of a sensor matrix.
        events: Each foot's stated heel strikes and toe offs.
    """

    path: Path
    format: str
    rate_hz: float
    time: NDArray[np.float64]
    feet: Mapping[Side, FootRecording]
    metadata: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    kind: Kind = "insole"
    raw: bool = False
    grid: tuple[int, int] | None = None
    events: Mapping[Side, StatedEvents] = field(default_factory=dict)

    def __repr__(self) -> str:
        feet = ", ".join(self.feet) or "no feet"
        frames = f"{len(self.time)} frames at {self.rate_hz:g} Hz"
        return f"PressureRecording({self.path.name}: {self.format}, {feet}, {frames})"

    def _repr_html_(self) -> str:
        from plantar.plotting import COLOURS, html_of, new_figure, thinned

        figure, axes = new_figure(8.0, 2.6, grid=True)
        for side, foot in self.feet.items():
            axes.plot(*thinned(self.time, foot.vertical_force), color=COLOURS[side], linewidth=1.0, label=side)
        axes.set_xlabel("time in s")
        axes.set_ylabel("counts" if self.raw else "vertical force in N")
        if self.feet:
            axes.legend(loc="upper right")
        return html_of(figure, repr(self))


def _product(values: NDArray[np.float64], matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """values @ matrix by blocks: BLAS would copy a wider table's columns whole, and start threads."""
    columns = [np.ascontiguousarray(column) for column in matrix.reshape(len(matrix), -1).T]
    blocks = [
        np.stack([np.einsum("ij,j->i", values[rows], column) for column in columns], axis=1)
        for rows in blocks_of_frames(values)
    ]
    return np.concatenate([np.zeros((0, len(columns))), *blocks]).reshape(-1, *matrix.shape[1:])


def layout_for(side: Side, given: SoleLayout | None) -> SoleLayout | None:
    """Returns layout of a `side`: `given` of either side, mirrored for the other; None for None."""
    return given if given is None or given.side == side else mirrored(given)


def true_runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First frame and frame after the last of each true run in a mask (n,).

    Example:
        >>> true_runs(np.array([True, False, True, True]))
        [(0, 1), (2, 4)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def possible_rate(rate: float, what: str) -> float:
    """Returns `rate` in Hz; outside RATES FormatError, whose message begins with `what`."""
    if not RATES[0] <= rate <= RATES[1]:
        raise FormatError(
            f"{what} {rate:.4g} frames a second, which is not possible; allowed: {RATES[0]:g} to {RATES[1]:g} "
            "(--rate overrides)"
        )
    return rate


def sampling(
    time: NDArray[np.float64], stated_hz: float | None, given_hz: float | None = None
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    """Returns increasing times (n,) in s, rate in Hz, and warnings; single damaged times are repaired.

    The user's `given_hz` replaces times and the file's `stated_hz`, in Hz or None. `time` (n,) is in s, 1 or more
    frames, NaN if unreadable. FormatError without a rate, or outside RATES.
    """
    if given_hz is not None:
        return np.arange(len(time)) / given_hz, given_hz, ()
    with np.errstate(all="ignore"):  # damaged times may be of any size
        return _checked_times(time, stated_hz)


def _checked_times(
    time: NDArray[np.float64], stated: float | None
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    warnings: list[str] = []
    if stated is not None:
        possible_rate(stated, "the file states")
        if _counts(time) and stated >= _COUNTED:
            time = time / stated
            warnings.append(f"the frames' times count them: taken from the rate of {stated:g} Hz that the file states")
    steps = np.diff(time)
    back = int((steps < 0.0).sum())
    if back > _REVERSED * int((steps >= 0.0).sum()):
        raise FormatError(
            f"the frame times fall, from {time[0]:.6g} to {time[-1]:.6g} s: are the rows in reverse order?"
        )
    rises = np.diff(np.sort(time)) if _BEGUN * back > len(steps) > back else steps  # where rows are exchanged
    forward = rises[np.isfinite(rises) & (rises > 0.0)]
    measured = None
    if len(forward):  # the mean of the usual steps: times may be rounded to ms, and frames may be lost
        usual = forward[np.abs(forward / np.median(forward) - 1.0) <= 0.5]
        measured = 1.0 / float(usual.mean())
    in_order = bool(np.isfinite(time).all() and (steps >= 0.0).all())
    tied = in_order and measured is not None and bool((steps == 0.0).any())
    if tied:  # a clock that is coarser than the frames, or frames that were written twice
        without_gaps = forward[forward <= _GAP * np.median(forward)]
        until = int(np.flatnonzero(steps > 0.0)[-1]) + 1  # how many frames share the last time is not known
        measured = (until - len(forward) + len(without_gaps)) / float(without_gaps.sum())
    rate = measured or stated
    if rate is None:
        raise FormatError("the frames have no times that increase, and no rate is stated")
    possible_rate(rate, "the frame times give")
    if measured and stated and abs(measured - stated) > 0.05 * stated:
        warnings.append(f"the file states {stated:g} Hz, its frame times give {measured:.6g} Hz: the times are used")
    elif stated:
        rate = stated
    index = np.arange(len(time))
    start = float(np.nanmedian(time - index / rate)) if np.isfinite(time).any() else 0.0
    grid = start + index / rate
    if tied:
        if (np.abs(time - grid) <= 1.0 / rate + np.median(forward)).all():
            warnings.append(f"frames share their times: taken from the rate of {rate:g} Hz")
            return grid, rate, tuple(warnings)
        warnings.append(f"{(steps == 0.0).sum()} frame(s) have the time of the one before: put between it and the next")
        return _apart(time, float(np.median(forward))), rate, tuple(warnings)
    off = ~(np.abs(time - grid) <= 0.5 / rate)
    if not off.any() or off.mean() <= 0.01:
        repaired = np.where(off, grid, time)
        if (np.diff(repaired) >= _LEAST_STEP / rate).all():
            if off.any():
                warnings.append(f"{int(off.sum())} frame time(s) were damaged: taken from the rate")
            return repaired, rate, tuple(warnings)
    elif np.isfinite(time).all() and (steps >= _LEAST_STEP / rate).all():
        warnings.append("the frames are not evenly spaced: their own times are used")
        return time, rate, tuple(warnings)
    elif in_order:
        close = np.append(False, steps < _LEAST_STEP / rate)
        warnings.append(f"{int(close.sum())} frame(s) come right after the one before: put between it and the next")
        first = np.maximum.accumulate(np.where(close, -np.inf, time))
        return _apart(first, float(np.median(forward))), rate, tuple(warnings)
    warnings.append(f"the frame times are not in order: taken from the rate of {rate:g} Hz{_begun_again(time, rate)}")
    return grid, rate, tuple(warnings)


def _begun_again(time: NDArray[np.float64], rate: float) -> str:
    known = np.flatnonzero(np.isfinite(time))
    steps = np.diff(time[known])
    back = np.flatnonzero(steps < -max(1.0, _BEGUN / rate))
    if not len(back) or int((steps < 0.0).sum()) > len(back) or _BEGUN * len(back) > len(steps):
        return ""
    frame = int(known[back[0] + 1]) + 1
    return f"; they begin again at frame {frame}: several recordings in one file? A contact there may be made of two"


def _counts(time: NDArray[np.float64]) -> bool:
    known = time[np.isfinite(time)]
    return len(known) > 10 and bool((known == np.round(known)).all()) and float(np.median(np.diff(known))) == 1.0


def _apart(time: NDArray[np.float64], usual: float) -> NDArray[np.float64]:
    """Times (n,) with equal ones spread evenly to the next, at most the usual step in s each: a gap may follow."""
    first = np.flatnonzero(np.diff(time, prepend=-np.inf) > 0.0)
    count = np.diff(np.append(first, len(time)))
    step = np.minimum(np.append(np.diff(time[first]), np.inf) / count, usual)
    return np.asarray(time + (np.arange(len(time)) - np.repeat(first, count)) * np.repeat(step, count))
