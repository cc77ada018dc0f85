"""Checks of a read recording: missing-value marks, doubts about unit, rate or cell size."""

import re
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.recordings.frame_table import blocks_of_frames, let_go, put_rows, room
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, true_runs

_FORCE = (15.0, 6000.0)
_PRESSURE = (5e3, 3e6)
_CELL = (1e-6, 4e-3)
# Rates in Hz between which events are found to half a frame's time; below, a contact has a dozen frames.
_RATE = (20.0, 5000.0)
# Share of loaded frames that repeat the one before from which the sensor is slower than the file; frames in a row at
# a cell's largest reading, and cells that share that reading, from which it is the end of the sensor's range.
_HELD = 0.4
_FLAT = 5
_CELLS = 3
_REST = 0.4  # Share of readings from which the largest is that of an unloaded cell, whose sensor counts down
# How many times higher than both frames next to it, and from which pressure in Pa, a single value is no foot's.
_ALONE = 4.0
_HIGH = 50e3
_QUICK = 50.0  # Rate in Hz from which that is so: at 30 Hz a heel strike may pass a cell within one frame
# Readings of cells that are looked at for this, from the beginning on: a minute of 99 cells at 80 Hz, 4 MB.
_SEEN = 500_000
# A cell's smallest reading (0.1 % of the positive ones lie below), as a share of the readings' 98th percentile, from
# which what a sensor leaves out at low load moves events by 20 ms; and the share of readings of 0 that separates such
# a sensor from one with an offset.
_SWITCH = 0.20
_LOW = 0.1
_ZEROS = 0.05
MOST = 1e12
"""Largest value of any sensor, in N or counts: above are damaged numbers."""
_SHORTEST_FOOT = 0.05
_LIGHTEST = 10.0  # Largest force in N, of all feet, below which nobody stands: a newborn weighs 25 N
_LONGEST_FOOT = 0.40
_OPTION = re.compile(r"\(--\w+")  # that states what was assumed
# Share of its peak that a loaded foot has at least, and what is left where its samples are lost; time in s in which no
# foot is lifted and set down again.
_UNDER_FOOT = 0.30
_GONE = 0.01
_INSTANT = 0.10
_SLENDER = (1.8, 4.2)  # How many times longer than wide insoles are, with room; those of makers are 2.4 to 3.4


def checked(recording: PressureRecording) -> PressureRecording:
    """Recording with missing-value marks as NaN, warnings of these and of all doubts."""
    found = without_marks(_without_impossible(recording))
    alone = [f"the recording holds the {side} foot only" for side in found.feet if len(found.feet) == 1]
    notes = [*found.warnings, *(alone if found.kind != "platform" else ()), *doubts(found)]
    notes.sort(key=lambda note: _OPTION.search(note) is None)  # what was assumed, and an option states, first
    return replace(found, warnings=tuple(dict.fromkeys(notes)))


def _without_impossible(recording: PressureRecording) -> PressureRecording:
    """Recording with values that no sensor gives as NaN, each foot's with a warning."""
    feet = dict(recording.feet)
    warnings = list(recording.warnings)
    for side, foot in recording.feet.items():
        parts = {
            "force": None if _no_larger(foot) else foot.force,
            "total": foot.total,
            "cop": foot.cop,
            "wrench": foot.wrench,
            "motion": foot.motion,
        }
        changed = {
            n: part for n, whole in parts.items() if whole is not None and (part := possible(whole)) is not whole
        }
        if changed:
            feet[side] = replace(foot, **changed)  # type: ignore[arg-type]
            warnings.append(
                f"values of the {side} foot's {' and '.join(changed)} are larger than {MOST:g}, which no sensor "
                "gives: they count as not measured"
            )
    return recording if feet == recording.feet else replace(recording, feet=feet, warnings=tuple(warnings))


def _no_larger(foot: FootRecording) -> bool:
    """Whether no force of a foot's cells is larger than `MOST`, or infinite."""
    return bool(foot.extremes.low.min(initial=0.0) >= -MOST and foot.extremes.high.max(initial=0.0) <= MOST)


def possible(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns values (n, ...) with NaN for infinite ones and those above `MOST`; the same array without any."""
    high = any(_beyond(values[rows]) for rows in blocks_of_frames(values))
    let_go(values)
    return np.where(np.abs(values) <= MOST, values, np.nan) if high else values


def _beyond(values: NDArray[np.float64]) -> bool:
    if not values.size:
        return False
    low = values.min()
    high = values.max()
    if low >= -MOST and high <= MOST:  # not so with a NaN
        return False
    return bool((np.abs(values) > MOST).any())


def refuse_small(recording: PressureRecording) -> None:
    """FormatError for a sensor that no foot fits on, such as a finger's, or loads that are nobody's."""
    if recording.kind not in ("insole", "platform"):
        return
    largest = max((float(np.nanmax(f.vertical_force, initial=0.0)) for f in recording.feet.values()), default=0.0)
    if 0.0 < largest < _LIGHTEST and not recording.raw:
        raise FormatError(
            f"the feet carry no more than {largest:.2g} N, which is nobody's load; allowed: {_LIGHTEST:g} N or more "
            "(check the unit; --unit overrides)"
        )
    for side, foot in recording.feet.items():
        extent = np.inf if foot.layout is None else float(np.ptp(foot.layout.outline, axis=0).max())
        if extent < _SHORTEST_FOOT:
            raise FormatError(
                f"the {side} foot's sensor is {1e3 * extent:.3g} mm long, which no foot is; allowed: "
                f"{1e3 * _SHORTEST_FOOT:g} mm or more (check the cell size; --layout overrides)"
            )


def doubts(recording: PressureRecording) -> list[str]:
    """Warnings about raw counts, and force, pressure, cell area, insole length and rate that are no foot's."""
    out: list[str] = []
    if recording.raw and not any("raw counts" in w or "of body weight" in w for w in recording.warnings):
        out.append("the readings are raw counts: forces and pressures cannot be given")
    if not _RATE[0] <= recording.rate_hz <= _RATE[1]:
        out.append(f"{recording.rate_hz:.4g} frames a second is an unusual rate: check it")
    for side, foot in recording.feet.items():
        if recording.kind not in ("robot", "plate"):
            out += _clipped_or_held(foot, recording.rate_hz, recording.raw)
        force = foot.vertical_force[np.isfinite(foot.vertical_force)]
        peak = float(np.percentile(force, 99.0)) if len(force) else 0.0
        if recording.kind in ("insole", "plate") and not (recording.raw and foot.force.shape[1] > _CELLS):
            out += _lost_or_flat(side, foot.vertical_force, peak, recording.rate_hz, "" if recording.raw else " N")
        if recording.raw:
            continue
        if force.any() and not _FORCE[0] <= peak <= _FORCE[1]:
            out.append(
                f"the {side} foot carries up to {peak:.4g} N, which is unusual: check the unit and the cell size"
            )
        if len(force) and float(force.min()) < -0.1 * peak - 10.0:
            out.append(f"the {side} foot's force falls to {force.min():.4g} N: check its zero and its sign")
        if foot.layout is None or recording.kind == "plate":
            continue
        highest = float(np.max(foot.extremes.high / foot.layout.areas, initial=0.0))
        if highest > 0.0 and not _PRESSURE[0] <= highest <= _PRESSURE[1] and recording.kind != "robot":
            out.append(f"the {side} foot's peak pressure is {highest / 1e3:.4g} kPa, which is unusual: check the unit")
        cell = float(np.median(foot.layout.areas))
        if not _CELL[0] <= cell <= _CELL[1]:
            out.append(f"the {side} foot's cells of {cell * 1e6:.4g} mm2 are unusual: check the cell size")
        extent = float(np.ptp(foot.layout.outline, axis=0).max())
        if recording.kind != "platform" and extent > _LONGEST_FOOT:
            out.append(f"the {side} sole is {extent * 1e3:.4g} mm long, which is unusual: check the cell size")
        out += _slender_or_wide(foot) if recording.kind == "insole" else []
    return out


def _lost_or_flat(side: str, force: NDArray[np.float64], peak: float, rate: float, unit: str) -> list[str]:
    out = []
    beside = _UNDER_FOOT * peak
    drops = [
        (a, b) for a, b in true_runs(force <= _GONE * peak) if a > 0 and b < len(force) and b - a < _INSTANT * rate
    ]
    drops = [(a, b) for a, b in drops if force[a - 1] > beside and force[b] > beside]
    if drops:
        out.append(
            f"the {side} foot's force drops to 0 and back within {_INSTANT:g} s {len(drops)} time(s): lost samples? "
            "Impulses and contact times are too small"
        )
    top = force >= np.nanmax(force, initial=0.0) * (1.0 - 1e-9)
    full = sum(b - a >= _FLAT for a, b in true_runs(top))
    others = np.diff(force)[(~top & (force > beside))[1:]]  # where these repeat, too, the sensor is slow
    if full >= _CELLS and len(others) and float((others == 0.0).mean()) < _HELD:
        out.append(
            f"the {side} foot's force stays at {peak:.4g}{unit}, its largest value, in {full} steps: the end of the "
            "sensor's range? Forces would be larger"
        )
    return out


def _slender_or_wide(foot: FootRecording) -> list[str]:
    assert foot.layout is not None
    length, width = (float(v) for v in np.ptp(foot.layout.outline, axis=0))
    if not width > 0.0 or _SLENDER[0] <= length / width <= _SLENDER[1]:
        return []
    return [
        f"the {foot.side} insole is {length * 1e3:.4g} mm long and {width * 1e3:.4g} mm wide, which is no foot's "
        "shape: check the width and the height of a cell"
    ]


def _shown(value: float, foot: FootRecording, raw: bool) -> str:
    return f"{value:.6g}" if raw else f"{value:.6g} N" if foot.layout is None else f"{value / 1e3:.4g} kPa"


def _areas_or_ones(foot: FootRecording, raw: bool) -> NDArray[np.float64]:
    return np.ones(foot.force.shape[1]) if raw or foot.layout is None else foot.layout.areas


def _clipped_or_held(foot: FootRecording, rate: float, raw: bool) -> list[str]:
    measured = foot.force[: max(20, _SEEN // foot.force.shape[1])]
    part = np.nan_to_num(measured)
    let_go(foot.force)
    loaded = part.sum(axis=1) > 0.2 * float(part.sum(axis=1).max(initial=0.0))
    if loaded.sum() < 20 or part.shape[1] <= _CELLS:
        return []
    per = _areas_or_ones(foot, raw)
    are_pressures = foot.layout is not None and not raw
    value = part / per
    out = _switched_on(foot.side, value) if are_pressures else []
    highest = float(value.max())
    full = value >= highest * (1.0 - 1e-9)
    runs = full[_FLAT - 1 :].copy()
    for shift in range(_FLAT - 1):
        runs &= full[shift : len(full) - _FLAT + 1 + shift]
    clipped = int(runs.any(axis=0).sum())
    levels = clipped < part.shape[1] or len(np.unique(value)) > 2 * _LEVELS  # a switch has two
    if clipped >= _CELLS and levels and float(full.mean()) < _REST:
        out.append(
            f"{clipped} cells of the {foot.side} foot stay at {_shown(highest, foot, raw)}, the largest value: the end "
            "of the sensor's range? Forces and pressures would be larger"
        )
    beside = np.maximum(measured[:-2], measured[2:]) / per  # NaN beside what was not measured
    alone = int(((value[1:-1] > _ALONE * beside) & (value[1:-1] > _HIGH)).sum())
    if alone and are_pressures and rate >= _QUICK:
        out.append(
            f"{alone} value(s) of the {foot.side} foot stand alone, more than {_ALONE:g} times as high as the frames "
            "beside them: a loose contact? Peaks rest on them"
        )
    both = loaded[1:] & loaded[:-1]
    repeated = (part[1:] == part[:-1]).all(axis=1) & both
    share = float(repeated.sum()) / max(1, int(both.sum()))
    if share > _HELD:
        out.append(
            f"{100.0 * share:.0f} % of the {foot.side} foot's frames repeat the one before: the sensor gives about "
            f"{rate * (1.0 - share):.2g} new frames a second, and events are as coarse as that"
        )
    return out


def _switched_on(side: str, value: NDArray[np.float64]) -> list[str]:
    seen = value[:, value.max(axis=0) > 0.0]
    positive = seen[seen > 0.0]
    if not len(positive) or float((seen == 0.0).mean()) < _ZEROS:
        return []
    low, high = (float(v) for v in np.percentile(positive, (_LOW, 98.0)))
    if low < _SWITCH * high:
        return []
    return [
        f"no cell of the {side} foot reads between 0 and {low / 1e3:.3g} kPa, {100.0 * low / high:.0f} % of its high "
        "readings: what is lower is not in the file, so that steps seem to begin later and end sooner, and forces and "
        "areas to be smaller"
    ]


_FEWEST = 3  # Readings of a mark from which they are no chance
# How many times the next largest reading a mark is at least: what a sensor clips has readings right below it.
_BEYOND = 3.0
_LEVELS = 10  # Different readings that a sensor has below a mark: a switch has two, and its upper one is no mark
# How far in Pa below zero a reading moves a result; and the same as a share of the largest reading, where no cell
# areas make pressures of them.
_BELOW = 4e3
_SHARE = 0.1
# Share of the readings up to which the one value below zero is a mark: of more, it is where the sensor ends.
_MOST = 0.5
_SAMPLED = 500_000  # Readings that are looked at first, all over the recording
_SAME = 1e-6  # Relative difference up to which readings are the same, after a conversion of units


def without_marks(recording: PressureRecording) -> PressureRecording:
    """Recording with marks as NaN, each with a warning; robots' and force plates' are unchanged.

    A mark is a repeated value three times as large as any other reading, or the only one below zero.
    """
    if recording.kind in ("robot", "plate"):
        return recording
    feet = dict(recording.feet)
    warnings = list(recording.warnings)
    for side, foot in recording.feet.items():
        force = foot.force
        per = _areas_or_ones(foot, recording.raw)
        for mark in _marks(foot, per, foot.layout is not None and not recording.raw):
            force, count = _left_out(force, per, mark)
            shown = _shown(mark, foot, recording.raw)
            warnings.append(
                f"{count} value(s) of the {side} foot are {shown}, far from all others: taken as a mark for what "
                "was not measured"
            )
        if force is not foot.force:
            feet[side] = replace(foot, force=force)
    return recording if feet == recording.feet else replace(recording, feet=feet, warnings=tuple(warnings))


def _marks(foot: FootRecording, per: NDArray[np.float64], are_pressures: bool) -> list[float]:
    """Marks among a foot's readings (n, k), each divided by one of (k,) numbers."""
    force = foot.force
    if not force.size:
        return []
    every = max(1, force.size // _SAMPLED)
    parts = [force[rows][-rows.start % every :: every].copy() for rows in blocks_of_frames(force)]  # page by page
    sample = np.concatenate(parts) / per
    sample = np.unique(sample[np.isfinite(sample)])
    low, high, _ = foot.extremes
    lowest = float((low / per).min())
    highest = float((high / per).max())
    found = []
    others = sample[(sample > 0.0) & ~_is(sample, highest)]
    if len(others) >= _LEVELS and highest >= _BEYOND * others[-1]:  # as of all that were read, or more
        count = 0
        next_one = 0.0
        for rows in blocks_of_frames(force):
            value = force[rows] / per
            marked = _is(value, highest)
            count += int(marked.sum())
            next_one = max(next_one, float(np.nanmax(value, initial=0.0, where=~marked & np.isfinite(value))))
        if count >= _FEWEST and highest >= _BEYOND * next_one:
            found.append(highest)
            highest = next_one
    if lowest < -(_BELOW if are_pressures else _SHARE * highest):
        count = 0
        below = 0
        for rows in blocks_of_frames(force):
            value = force[rows] / per
            count += int(_is(value, lowest).sum())
            below += int((value < 0.0).sum())
        if _FEWEST <= count == below <= _MOST * force.size:
            found.append(lowest)
    return found


def _is(value: NDArray[np.float64], mark: float) -> NDArray[np.bool_]:
    return np.abs(value - mark) <= _SAME * abs(mark)


def _left_out(force: NDArray[np.float64], per: NDArray[np.float64], mark: float) -> tuple[NDArray[np.float64], int]:
    out = room(*force.shape)
    count = 0
    for rows in blocks_of_frames(force):
        marked = _is(force[rows] / per, mark)
        put_rows(out, rows.start, np.where(marked, np.nan, force[rows]))
        count += int(marked.sum())
        let_go(out)
    return out, count
