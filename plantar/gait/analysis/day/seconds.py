"""A day's recording second by second: load of each foot, of its regions, and steps, in blocks that fit into memory."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.analysis.steps.events import EVENT_LEVELS, Contact, Levels, find_contacts
from plantar.recordings.frame_table import let_go
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

_BLOCK = 300.0  # s that are looked at together
_OVER = 4.0  # s by which a block goes on to complete its last contact
# Percentile of the load of seconds that is a person's weight: a person is upright for a 50th of a day.
_UPRIGHT = 98.0
_AROUND = 6  # Blocks before and after one in which the least load is looked for: who sits lifts a foot within the hour
_LIGHT = 0.05  # Share of the weight up to which that is an offset of the sensor
_STEP = 0.5  # Share of the weight that a step carries at its peak at least
_SHORTEST = 0.2  # Shortest and longest contact in s of a step
_LONGEST = 3.0
_MEASURED = 0.5  # Share of a second's frames that are measured at least


@dataclass(frozen=True)
class Footfall:
    """A step of the day: its foot, and heel strike and toe off in s."""

    side: Side
    strike: float
    lift: float


@dataclass(frozen=True, eq=False)
class DaySeconds:
    """A day by its n seconds from the first frame.

    Attributes:
        begin: Time of the first frame in s.
        weight: Body weight in N: as stated, or that by the load of upright seconds.
        measured: Which seconds (n,) were measured by every foot.
        load: Mean load (n,) of all feet in N, without what sensors read in the air.
        impulse: Impulse (n,) of each foot in N s.
        pressure: Integral (n, regions) of each foot's largest pressure of each region in Pa s; empty without geometry.
        steps: All steps in the order of their heel strikes.
    """

    begin: float
    weight: float
    measured: NDArray[np.bool_]
    load: NDArray[np.float64]
    impulse: Mapping[Side, NDArray[np.float64]]
    pressure: Mapping[Side, NDArray[np.float64]]
    steps: Sequence[Footfall]


def seconds_of_day(
    recording: PressureRecording, weight: float | None, regions: Mapping[Side, NDArray[np.int64]], count: int
) -> DaySeconds:
    """Returns a recording of insoles second by second.

    Args:
        recording: Its forces in N.
        weight: Body weight in N; None to take it from the load.
        regions: Number (k,) of the region of each foot's cells, -1 for none; empty for no pressures.
        count: Number of regions.

    Raises:
        InputError: For raw counts, or a recording that carries no load.
    """
    if recording.raw:
        raise InputError("a day's load needs forces; the recording holds raw counts (--unit names their unit)")
    begin = float(recording.time[0])
    second = np.floor(recording.time - begin).astype(np.int64)
    total = int(second[-1]) + 1
    feet = recording.feet
    blocks = _blocks(recording)
    lows = {side: np.array([_least(foot.vertical_force[a:b]) for a, b, _ in blocks]) for side, foot in feet.items()}
    sums = {side: _per_second(foot.vertical_force, second, total) for side, foot in feet.items()}
    rough = np.nansum(list(sums.values()), axis=0)
    usual = float(np.nanpercentile(rough, _UPRIGHT)) if np.isfinite(rough).any() else 0.0
    carried = weight or usual - sum(float(np.nanmin(low)) for low in lows.values() if np.isfinite(low).any())
    if not carried > 0.0:
        raise InputError("the recording carries no load: no day to measure")
    rest = {side: _rest(low, carried) for side, low in lows.items()}
    load = np.zeros(total)
    measured = np.ones(total, dtype=bool)
    impulse: dict[Side, NDArray[np.float64]] = {}
    pressure: dict[Side, NDArray[np.float64]] = {}
    steps: list[Footfall] = []
    for side, foot in feet.items():
        impulse[side] = np.zeros(total)
        pressure[side] = np.zeros((total, count if side in regions else 0))
        known = np.zeros(total)
        for (a, b, over), low in zip(blocks, rest[side], strict=True):
            force = foot.vertical_force[a:b] - low
            finite = np.isfinite(force)
            first = int(second[a])
            own = second[a:b] - first
            size = int(own[-1]) + 1
            part = slice(first, first + size)
            positive = np.where(finite, np.maximum(force, 0.0), 0.0) / recording.rate_hz
            impulse[side][part] += np.bincount(own, positive, minlength=size)
            known[part] += np.bincount(own, finite, minlength=size)
            if side in regions:
                pressure[side][part] += (
                    _pressures(foot, slice(a, b), regions[side], count, own, size) / recording.rate_hz
                )
            steps += _footfalls(recording, foot, (a, b, over), low, carried)
        measured &= known >= _MEASURED * recording.rate_hz
        load += impulse[side]
    return DaySeconds(begin, carried, measured, load, impulse, pressure, sorted(steps, key=lambda s: s.strike))


def weight_of(mass_kg: float | None) -> float | None:
    """Body weight in N of a mass in kg, or None."""
    return None if mass_kg is None else mass_kg * GRAVITY


def _blocks(recording: PressureRecording) -> list[tuple[int, int, int]]:
    """First frame, the frame after the last, and that after what completes the last contact, of each block."""
    n = len(recording.time)
    size = max(1, round(_BLOCK * recording.rate_hz))
    more = round(_OVER * recording.rate_hz)
    return [(a, min(n, a + size), min(n, a + size + more)) for a in range(0, n, size)]


def _least(force: NDArray[np.float64]) -> float:
    known = force[np.isfinite(force)]
    return float(np.percentile(known, 0.5)) if len(known) else float("nan")


def _rest(low: NDArray[np.float64], weight: float) -> NDArray[np.float64]:
    """What a foot's sensor reads in the air in each block: the least load of an hour around it.

    A foot that is not lifted for an hour reads what it does at other times; more than an offset is none.
    """
    n = len(low)
    around = [low[max(0, k - _AROUND) : k + _AROUND + 1] for k in range(n)]
    least = np.array([np.nanmin(part) if np.isfinite(part).any() else np.nan for part in around])
    offset = least <= _LIGHT * weight
    usual = float(np.median(least[offset])) if offset.any() else 0.0
    return np.where(offset, least, usual)


def _per_second(force: NDArray[np.float64], second: NDArray[np.int64], total: int) -> NDArray[np.float64]:
    """Mean (total,) of the measured frames of each second; NaN without any."""
    finite = np.isfinite(force)
    count = np.bincount(second, finite, minlength=total)
    with np.errstate(invalid="ignore"):
        return np.bincount(second, np.where(finite, force, 0.0), minlength=total) / np.where(count > 0, count, np.nan)


def _pressures(
    foot: FootRecording,
    frames: slice,
    region: NDArray[np.int64],
    count: int,
    second: NDArray[np.int64],
    size: int,
) -> NDArray[np.float64]:
    """Sum (seconds, regions) over the frames of a second of each region's largest pressure in Pa."""
    assert foot.layout is not None
    pressure = np.nan_to_num(foot.force[frames]) / foot.layout.areas
    let_go(foot.force)
    out = np.zeros((size, count))
    for number in range(count):
        cells = np.flatnonzero(region == number)
        if len(cells):
            out[:, number] = np.bincount(second, np.maximum(pressure[:, cells].max(axis=1), 0.0), minlength=size)
    return out


def _footfalls(
    recording: PressureRecording, foot: FootRecording, frames: tuple[int, int, int], rest: float, weight: float
) -> Iterator[Footfall]:
    a, b, over = frames
    share = EVENT_LEVELS["insole"]
    force = foot.vertical_force[a:over]
    if not np.isfinite(force).any():
        return
    ends = (rest + part * weight for part in (share.strike, share.contact, share.lift, share.clear or share.lift))
    strike, contact, lift, clear = ends
    levels = Levels(rest, rest + weight, strike, contact, 0.0, lift, clear)
    time = recording.time[a:over]
    for found in find_contacts(time, force, levels):
        if _is_step(found, force, rest, weight) and found.begin < b - a:
            yield Footfall(foot.side, float(found.heel_strike or 0.0), float(found.toe_off or 0.0))


def _is_step(contact: Contact, force: NDArray[np.float64], rest: float, weight: float) -> bool:
    if contact.heel_strike is None or contact.toe_off is None:
        return False
    lasts = contact.toe_off - contact.heel_strike
    peak = float(np.nanmax(force[contact.begin : contact.end])) - rest
    return _SHORTEST <= lasts <= _LONGEST and peak >= _STEP * weight
