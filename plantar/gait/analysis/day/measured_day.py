"""A day in figures: time in each activity, steps, load of feet and regions by the hour, and best cadences."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.analysis.day.bouts import ACTIVITIES, Bout, bouts_of, walks_of
from plantar.gait.analysis.day.seconds import DaySeconds, seconds_of_day, weight_of
from plantar.gait.analysis.masks import SEVEN_MASKS, Masks
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.parameters import analyse_feet
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

LEAST = 600.0
"""Shortest recording in s that is measured as a day."""

_SAMPLE = 60.0  # s of the longest walk from which regions are taken
_BEST = 30  # Minutes whose mean is the best cadence of 30 minutes


@dataclass(frozen=True, eq=False)
class Hour:
    """One hour: its begin in s and what its clock shows; time in s in each activity; steps; loads.

    `impulse_Ns`: of each foot; `pressure_Pas`: of each region of each foot.
    """

    begin: float
    clock: str
    seconds: Mapping[str, float]
    steps: int
    impulse_Ns: Mapping[Side, float]
    pressure_Pas: Mapping[Side, Mapping[str, float]]


@dataclass(frozen=True, eq=False)
class Day:
    """A day.

    Attributes:
        clock: When the recording began; None if unknown.
        weight_N: Body weight.
        bouts: All bouts in order.
        hours: Its hours.
        cadence_1: Steps of the minute with the most, per minute.
        cadence_30: Mean of the 30 minutes with the most steps, which need not follow one another (Tudor-Locke et al.
            2012, Prev. Med. 54:31); None below 30 minutes.
        notes: What was assumed.
    """

    clock: datetime | None
    weight_N: float
    begin: float
    end: float
    bouts: Sequence[Bout]
    hours: Sequence[Hour]
    cadence_1: float
    cadence_30: float | None
    notes: Sequence[str]

    @property
    def walks(self) -> list[Bout]:
        """Bouts of walking."""
        return walks_of(self.bouts)

    @property
    def steps(self) -> int:
        """Steps in bouts of walking."""
        return sum(bout.steps for bout in self.bouts)

    def seconds(self, activity: str) -> float:
        """Time in s in an activity."""
        return sum(bout.lasts for bout in self.bouts if bout.activity == activity)

    def at(self, time: float) -> str:
        """Clock at a time in s of the recording: hours and minutes since its begin where no clock is known."""
        if self.clock is not None:
            return (self.clock + timedelta(seconds=time - self.begin)).strftime("%H:%M:%S")
        whole = int(time - self.begin)
        return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def measure_day(
    recording: PressureRecording,
    mass_kg: float | None = None,
    clock: datetime | None = None,
    masks: Masks = SEVEN_MASKS,
) -> Day:
    """Measure a day of insoles.

    Args:
        recording: Of one foot or two, in N.
        mass_kg: Body mass; None to take the weight from the load of upright seconds.
        clock: When the recording began; None for times since then.
        masks: Regions whose load is given.

    Raises:
        InputError: For other sensors, raw counts, less than 10 minutes or no load.
    """
    if recording.kind != "insole":
        raise InputError(f"--day is for insoles; the recording is of kind {recording.kind}")
    lasts = float(recording.time[-1] - recording.time[0])
    if lasts < LEAST:
        raise InputError(f"--day takes {LEAST / 60:g} minutes or more; the recording lasts {lasts / 60:.3g} minutes")
    notes = list(recording.warnings)
    plain = seconds_of_day(recording, weight_of(mass_kg), {}, 0)
    bouts = bouts_of(plain, len(recording.feet))
    names = [name for name, _ in masks.names]
    regions = _regions(recording, bouts, masks, notes)
    day = seconds_of_day(recording, plain.weight, regions, len(names)) if regions else plain
    if mass_kg is None:
        notes.insert(
            0,
            f"no body mass is stated: the weight is taken as {day.weight:.0f} N, what the feet carry in the 2 % of "
            "seconds with the most load (--mass)",
        )
    if len(recording.feet) == 1:
        notes.append("one foot was measured: steps count twice, and standing on the other foot looks like sitting")
    if clock is None:
        notes.append("no clock is known: times are since the begin (--clock)")
    strikes = _strikes(bouts, day)
    best = np.sort(_per_minute(strikes, day, len(recording.feet)))[::-1]
    return Day(
        clock=clock,
        weight_N=day.weight,
        begin=day.begin,
        end=float(recording.time[-1]),
        bouts=bouts,
        hours=_hours(day, bouts, strikes, clock, names),
        cadence_1=float(best[0]) if len(best) else 0.0,
        cadence_30=float(best[:_BEST].mean()) if len(best) >= _BEST else None,
        notes=tuple(dict.fromkeys(notes)),
    )


def _regions(
    recording: PressureRecording, bouts: Sequence[Bout], masks: Masks, notes: list[str]
) -> dict[Side, NDArray[np.int64]]:
    """Region (k,) of each foot's cells by the longest walk; empty without one, or without geometry."""
    walks = walks_of(bouts)
    if not walks or any(foot.layout is None for foot in recording.feet.values()):
        notes.append("no walk, or no cells with places: load is given of the whole foot alone")
        return {}
    longest = max(walks, key=lambda bout: bout.lasts)
    a, b = np.searchsorted(recording.time, (longest.begin, min(longest.end, longest.begin + _SAMPLE)))
    feet = {side: _part(foot, slice(int(a), int(b))) for side, foot in recording.feet.items()}
    part = PressureRecording(recording.path, recording.format, recording.rate_hz, recording.time[a:b], feet)
    found = analyse_feet(part, options=AnalysisOptions(steps="all", masks=masks))
    return {side: gait.region for side, gait in found.items() if gait.region is not None}


def _part(foot: FootRecording, frames: slice) -> FootRecording:
    total = None if foot.total is None else foot.total[frames]
    cop = None if foot.cop is None else foot.cop[frames]
    return FootRecording(foot.side, np.array(foot.force[frames]), foot.layout, total, cop)


def _strikes(bouts: Sequence[Bout], day: DaySeconds) -> NDArray[np.float64]:
    """Heel strikes in s of all steps in bouts of walking."""
    strikes = np.array([step.strike for step in day.steps])
    inside = np.zeros(len(strikes), dtype=bool)
    for bout in walks_of(bouts):
        inside |= (strikes >= bout.begin) & (strikes <= bout.end)
    return strikes[inside]


def _per_minute(strikes: NDArray[np.float64], day: DaySeconds, feet: int) -> NDArray[np.float64]:
    """Steps in each minute from the begin, by their heel strikes."""
    minutes = len(day.load) // 60
    minute = ((strikes - day.begin) // 60).astype(np.int64)
    return np.bincount(minute[minute < minutes], minlength=minutes) * 2.0 / feet


def _hours(
    day: DaySeconds,
    bouts: Sequence[Bout],
    strikes: NDArray[np.float64],
    clock: datetime | None,
    names: Sequence[str],
) -> list[Hour]:
    into = 0.0 if clock is None else clock.minute * 60.0 + clock.second + 1e-6 * clock.microsecond
    total = len(day.load)
    edges = sorted({0, *(k for k in np.arange(3600.0 - into, total, 3600.0).astype(int).tolist() if k > 0), total})
    out = []
    for a, b in pairwise(edges):
        begin = day.begin + a
        end = day.begin + b
        times = dict.fromkeys(ACTIVITIES, 0.0)
        for bout in bouts:
            common = min(end, bout.end) - max(begin, bout.begin)
            if common > 0.0:
                times[bout.activity] += common
        shown = f"{a // 3600} h" if clock is None else (clock + timedelta(seconds=a)).strftime("%H:%M")
        impulse = {side: float(own[a:b].sum()) for side, own in day.impulse.items()}
        pressure = {
            side: {name: float(own[a:b, i].sum()) for i, name in enumerate(names)} if own.shape[1] else {}
            for side, own in day.pressure.items()
        }
        steps = round(2.0 / len(day.impulse) * int(((strikes >= begin) & (strikes < end)).sum()))
        out.append(Hour(begin, shown, times, steps, impulse, pressure))
    return out


def clock_of(text: str | None) -> datetime | None:
    """Clock of a text such as "2026-03-02T08:30" or "08:30"; InputError for others.

    Example:
        >>> clock_of("2026-03-02T08:30").hour, clock_of("08:30:10").second, clock_of(None)
        (8, 10, None)
    """
    if text is None:
        return None
    for pattern in ("%H:%M", "%H:%M:%S"):
        try:
            return datetime.strptime(text, pattern).replace(year=2000)
        except ValueError:
            continue
    try:
        return datetime.fromisoformat(text)
    except ValueError:
        raise InputError(f"--clock is {text!r}; allowed: 08:30, 08:30:10 or 2026-03-02T08:30") from None


def hours_and_minutes(seconds: float) -> str:
    """Duration in words.

    Example:
        >>> hours_and_minutes(3725.0), hours_and_minutes(59.0)
        ('1 h 2 min', '1 min')
    """
    minutes = math.floor(seconds / 60.0 + 0.5)
    return f"{minutes // 60} h {minutes % 60} min" if minutes >= 60 else f"{minutes} min"
