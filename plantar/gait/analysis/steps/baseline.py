"""Readings in swing: offsets of a foot, and cells that a crease or shoe keeps loaded.

In a walk the force keeps returning to a flat level for about half a second; in standing it wanders. Only levels found
in a walk are removed, and reported.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.steps.events import MINIMUM_SWING, smoothed
from plantar.gait.analysis.steps.swing_levels import SwingLevels, swing_levels
from plantar.recordings.frame_table import let_go, table_of_blocks
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, true_runs

OFFSET = 0.10  # A level in swing of more than so much of the walk's range of force is an offset; shoes press less
_REPORTED = 0.03  # A level in swing of more than so much of the range is reported, though it is not taken off
# A level in swing of so much of the range below zero is an offset, too: no shoe pulls, and cells below zero take the
# centre of pressure out of the sole.
_PULL = 0.01
HOT = 0.5  # A cell that reads more in swing than this share of what it reads under load does not measure the foot
_ALONE = 5.0  # How many times the usual reading in swing a cell of a sensor with an offset reads then
_WINDOWS = (12.0, 6.0)  # Lengths in s of the stretches in which the level in swing is looked for, ten strides or five
_FLAT = 0.06  # Range of a level in swing, as a share of the range of force
_LONGEST_SWING = 1.5  # Longest time in s at one level that is a swing and not standing on the other foot
_SHARE = (0.15, 0.8)  # Share of a walk's time in which a foot is at its level in swing
# A foot lands and lifts quickly: it spends less than 0.7 of the time at its level between there and 0.3 of the range;
# a sine, as when weight is shifted from foot to foot, 1.3 times as much.
_ABOVE = 0.30
_SPARSE = 0.7
# Of recordings of one or two strides: longest contact in s, longest time in s in which a foot that lands or lifts
# passes the lower half of its force (0.03 to 0.15 s in walking, 0.3 s and more where weight is shifted), and largest
# share of the time in swing.
_LONGEST_CONTACT = 2.0
_QUICK = 0.2
_FEW_SHARE = 0.95
_HIGHEST = 20.0  # How many times the range of a walk the level in swing is at most: heart and breath move less
# Where the level of a single swing lies farther from the usual one, as a share of the range, each swing has a level
# of its own: events lie at 5 % of the range.
FOLLOWED = 0.025
_FRAMES = 4000  # Frames in swing from which a cell's reading is averaged: enough for 2 % of its noise


@dataclass(frozen=True, eq=False)
class RestingLevel:
    """Foot's force in swing.

    `level`: level (n,) in each frame, in the force's unit; `swing`: frames (n,) at that level for longer than
    `MINIMUM_SWING`; `span`: force range above the level; `each`: single swings, where the level follows them; else
    None.
    """

    level: NDArray[np.float64]
    swing: NDArray[np.bool_]
    span: float
    each: SwingLevels | None = None


def resting_level(force: NDArray[np.float64], rate: float) -> RestingLevel | None:
    """Returns level of a walking foot's force in swing, of each swing where it changes; None as in standing.

    `force`: vertical force (n,), NaN if unmeasured.

    Example:
        >>> time = np.arange(0.0, 12.0, 0.01)
        >>> walk = 300.0 + 800.0 * np.clip(np.sin(2.0 * np.pi * time), 0.0, None)
        >>> float(resting_level(walk, 100.0).level[0]), resting_level(500.0 + 20.0 * np.sin(time), 100.0)
        (300.0, None)
    """
    found = _usual_level(force, rate)
    each = swing_levels(force, rate)
    if each is not None:
        level = 0.0 if found is None else float(np.median(found.level))
        if np.abs(each.level - level)[each.swing].max() > FOLLOWED * each.span:
            found = RestingLevel(each.level, each.swing, each.span, each)
    return found if found is None or np.median(found.level) <= _HIGHEST * found.span else None


def _usual_level(force: NDArray[np.float64], rate: float) -> RestingLevel | None:
    n = len(force)
    tried = []
    for window in _WINDOWS:
        edges = np.linspace(0, n, max(1, int(n / rate / window)) + 1).astype(int)
        found = [_level(force[a:b], rate) for a, b in pairwise(edges)]
        tried.append((sum(part is not None for part in found) / len(found), edges, found))
        if tried[-1][0] == 1.0:  # shorter ones cannot show more
            break
    _, edges, found = max(tried, key=lambda one: one[0])
    known = [(*part, a, b) for part, (a, b) in zip(found, pairwise(edges), strict=True) if part is not None]
    if not known:
        return None
    levels, spans, frames, begins, ends = zip(*known, strict=True)
    swing = np.zeros(n, dtype=bool)
    for part, a in zip(frames, begins, strict=True):
        swing[a : a + len(part)] = part
    return RestingLevel(np.interp(np.arange(n), 0.5 * np.add(begins, ends), levels), swing, float(np.median(spans)))


def _level(force: NDArray[np.float64], rate: float) -> tuple[float, float, NDArray[np.bool_]] | None:
    """Level in swing, range above it and frames (n,) in swing of one stretch; None without a walk."""
    measured = np.isfinite(force)
    if measured.sum() < 20:
        return None
    course = np.full(len(force), np.inf)
    course[measured] = smoothed(force[measured])
    low, high = (float(v) for v in np.percentile(course[measured], (3.0, 92.0)))
    if not high > low:
        return None
    near = course <= low + _FLAT * (high - low)
    above = measured & ~near & (course <= low + _ABOVE * (high - low))
    if above.sum() > _SPARSE * near.sum():
        return None
    runs = [(a, b) for a, b in true_runs(near) if b - a >= MINIMUM_SWING * rate]
    inner = [(a, b) for a, b in runs if a > 0 and b < len(force)]
    swing = np.zeros(len(force), dtype=bool)
    for a, b in runs:
        edge = (b - a) // 5  # the level is reached and left slowly
        swing[a + edge : b - edge] = True
    few = len(inner) < 2 and _steps_show(course, near, low, high - low, rate)
    if (len(inner) < 2 and not few) or max((b - a for a, b in inner), default=0) > _LONGEST_SWING * rate:
        return None
    if not _SHARE[0] <= sum(b - a for a, b in runs) / len(force) <= (_FEW_SHARE if few else _SHARE[1]):
        return None
    level = float(np.median(force[swing & measured]))
    return level, high - level, swing & measured


def _steps_show(course: NDArray[np.float64], near: NDArray[np.bool_], low: float, span: float, rate: float) -> bool:
    """Whether contacts between flat stretches are steps: landing and lifting at once, unlike slow weight shifts."""
    flanks = []
    for a, b in true_runs(~near):
        part = course[a:b] - low
        if a == 0 or b == len(course) or part.max() < 0.5 * span or b - a > _LONGEST_CONTACT * rate:
            continue
        half = np.flatnonzero(part >= 0.5 * span)
        flanks += [half[0] / rate, (b - a - 1 - half[-1]) / rate]
    return len(flanks) > 0 and max(flanks) <= _QUICK


def without_baselines(recording: PressureRecording) -> PressureRecording:
    """Recording without offsets of feet and swing readings of creases and stuck cells, each with a warning."""
    if recording.kind == "platform":
        return recording
    feet = dict(recording.feet)
    notes = list(recording.warnings)
    unit = "counts" if recording.raw else "N"
    for side, foot in recording.feet.items():
        rest = resting_level(foot.vertical_force, recording.rate_hz)
        if rest is None:
            continue
        hot = _hot_cells(foot, rest)
        if len(hot):
            foot = _without_hot(foot, rest, hot)
            feet[side] = foot
            rest = resting_level(foot.vertical_force, recording.rate_hz) or rest
            names = foot.layout.ids[hot] if foot.layout is not None else hot + 1
            notes.append(
                f"{_cells(names.tolist())} of the {side} foot: what they read in swing, more than half of what they "
                "read under load (a crease, or a cell that sticks), is taken off (--baseline keep leaves it)"
            )
        offset = float(np.median(rest.level))
        drift = float(np.ptp(rest.level))
        if _is_offset(rest):
            feet[side] = _without_offset(foot, rest)
            moving = f", and drifts by {drift:.3g} {unit}" if drift > 0.05 * rest.span else ""
            notes.append(
                f"the {side} foot's sensor reads {offset:.4g} {unit} in swing{moving}: what each cell reads there "
                "is taken off as its baseline (--baseline keep leaves it)"
            )
        elif np.abs(rest.level).max() > _REPORTED * rest.span:
            notes.append(
                f"the {side} foot's sensor reads {offset:.3g} {unit} in swing, "
                f"{100.0 * offset / rest.span:.0f} % of its range: it stays in the forces, as a shoe may press so"
            )
    return replace(recording, feet=feet, warnings=tuple(notes))


def _is_offset(rest: RestingLevel) -> bool:
    drift = float(np.ptp(rest.level))
    pulls = rest.level.min() < -_PULL * rest.span
    return bool(drift > FOLLOWED * rest.span or np.abs(rest.level).max() > OFFSET * rest.span or pulls)


def _cells(ids: Sequence[int]) -> str:
    if len(ids) > 8:
        return f"{len(ids)} cells"
    return f"cell{'s' if len(ids) > 1 else ''} {', '.join(str(i) for i in ids)}"


def _frames(mask: NDArray[np.bool_]) -> NDArray[np.int64]:
    index = np.flatnonzero(mask)
    if len(index) <= _FRAMES:
        return index
    return np.concatenate([part[: _FRAMES // 40] for part in np.array_split(index, 40)])


def _in_swing(foot: FootRecording, frames: NDArray[np.int64]) -> NDArray[np.float64]:
    part = foot.force[frames]
    let_go(foot.force)
    known = np.isfinite(part)
    return np.asarray(np.where(known, part, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1))


def _without_offset(foot: FootRecording, rest: RestingLevel) -> FootRecording:
    total = None if foot.total is None else foot.total - rest.level
    if foot.force.shape[1] == 0:
        return replace(foot, total=total)
    places, stretches = _stretches(rest)
    means = [_in_swing(foot, a + _frames(rest.swing[a:b])) for a, b in stretches]
    at = np.array(places)
    table = np.array(means)
    force = table_of_blocks(
        foot.force, lambda rows: foot.force[rows] - _between(np.arange(rows.start, rows.stop), at, table)
    )
    return replace(foot, force=force, total=total)


def _between(index: NDArray[np.int64], at: NDArray[np.float64], table: NDArray[np.float64]) -> NDArray[np.float64]:
    if len(at) == 1:
        return table
    after = np.clip(np.searchsorted(at, index), 1, len(at) - 1)
    share = np.clip((index - at[after - 1]) / (at[after] - at[after - 1]), 0.0, 1.0)[:, None]
    return np.asarray((1.0 - share) * table[after - 1] + share * table[after])


def _stretches(rest: RestingLevel) -> tuple[list[float], list[tuple[int, int]]]:
    """Places (frames) where cells have their own baseline, and each one's stretch of frames."""
    if rest.each is not None:
        return rest.each.places.tolist(), [(int(a), int(b)) for a, b in rest.each.spans]
    n = len(rest.level)
    drifts = float(np.ptp(rest.level)) > 0.05 * rest.span
    count = min(20, max(1, int((np.diff(rest.swing.astype(np.int8)) == 1).sum()) // 5)) if drifts else 1
    edges = np.unique(np.linspace(0, n, 1 + count).astype(int)).tolist()
    stretches = [(a, b) for a, b in pairwise(edges) if rest.swing[a:b].any()]
    return [0.5 * (a + b) for a, b in stretches], stretches


def _hot_cells(foot: FootRecording, rest: RestingLevel) -> NDArray[np.int64]:
    if foot.force.shape[1] == 0:
        return np.zeros(0, dtype=np.int64)
    air = _in_swing(foot, _frames(rest.swing))
    with np.errstate(invalid="ignore"):
        under = foot.force[_frames(foot.vertical_force > rest.level + 0.3 * rest.span)]
    let_go(foot.force)
    load = np.percentile(np.where(np.isfinite(under), under, 0.0), 95.0, axis=0) if len(under) else np.zeros(len(air))
    least = max(0.002 * rest.span, 0.0 if foot.layout is None else foot.layout.force_threshold)
    if _is_offset(rest):
        least = max(least, _ALONE * float(np.median(np.abs(air))))
    return np.flatnonzero((air > HOT * load) & (air > least))


def _without_hot(foot: FootRecording, rest: RestingLevel, hot: NDArray[np.int64]) -> FootRecording:
    cells = np.isin(np.arange(foot.force.shape[1]), hot)
    air = np.where(cells, _in_swing(foot, _frames(rest.swing)), 0.0)
    least = np.where(cells, 0.0, -np.inf)
    return replace(foot, force=table_of_blocks(foot.force, lambda rows: np.maximum(foot.force[rows] - air, least)))
