"""Level of each swing, for sensors with offsets that change each stride.

A morphological opening (Serra 1982, Image Analysis and Mathematical Morphology, ch. 2) follows the level under
contacts; runs of frames at it between quick flanks are swings.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from plantar.gait.analysis.steps.events import MINIMUM_SWING, smoothed
from plantar.recordings.pressure_recording import true_runs

# Longest contacts in s that are tried: a window longer than a contact follows the level under it, one that is much
# longer follows only slow changes.
_CONTACTS = (1.6, 0.9, 2.6)
_WELL = 0.9  # Share of the gaps between contacts that are swings from which no other window is tried
# In stretches of 4 s the force of a walk ranges over little more than from its level in swing to its peak; a window
# that is shorter than the contacts sees less than 0.6 of that.
_STRETCH = 4.0
_WHOLE = 0.6
_NEAR = 0.10  # A swing's frames lie so close above the level, as a share of the range of force
# Longest time in s off the ground that is a swing; of a longer one at an end of the recording what lies beside the
# contact is taken.
_LONGEST_SWING = 1.5
# Longest time in s, and as a share of the contact, in which a foot that lands or lifts passes the lower half.
_QUICK = 0.2
_QUICK_SHARE = 0.12
# A walking foot spends less than 0.4 of the time at its level between there and 0.3 of the range (0.03 to 0.2); the
# sway of standing 0.7 and more, a sine 0.8.
_ABOVE = 0.30
_SPARSE = 0.4
_OFTEN = 0.5  # Share of the gaps between contacts that are swings; of the dips of a standing foot a seventh or less
_FEWEST = 3  # Swings between contacts from which they are those of a walk
# A level that changes by more from one swing to the next, as a share of the range, may do so from one frame to the
# next.
_JUMP = 0.03
# A swing whose level lies so far above both its neighbours', as a share of the range, is a moment of standing.
_OUTLIER = 0.25


@dataclass(frozen=True, eq=False)
class SwingLevels:
    """Swings of a foot and its force level, in the force's unit.

    `places`: frames (m,) with known level, in order; `spans`: first frame and frame after the last in swing around each
    place (m, 2); `level`: level (n,) under contacts, linear between places; `swing`: frames (n,) in swing; `span`:
    force range above the level.
    """

    places: NDArray[np.float64]
    spans: NDArray[np.int64]
    level: NDArray[np.float64]
    swing: NDArray[np.bool_]
    span: float


def swing_levels(force: NDArray[np.float64], rate: float) -> SwingLevels | None:
    """Returns level of each swing of a walking foot; None below three swings between contacts.

    `force`: vertical (n,), NaN if unmeasured.

    Example:
        >>> time = np.arange(0.0, 12.0, 0.01)
        >>> walk = 40.0 * time + 800.0 * np.clip(1.5 * np.sin(2.0 * np.pi * time), 0.0, 1.0)
        >>> bool(np.abs(swing_levels(walk, 100.0).level - 40.0 * time)[100:-100].max() < 2.0)
        True
    """
    measured = np.flatnonzero(np.isfinite(force))
    if len(measured) < max(20.0, 2.0 * rate):
        return None
    course = smoothed(np.interp(np.arange(len(force)), measured, force[measured]))
    usual = _usual_range(course, rate)
    tried: list[tuple[int, float, list[tuple[int, int]]]] = []
    for longest in _CONTACTS:
        under = course - _opened(course, longest, rate)
        span = _range(under)
        found, share = _swings(under, course, span, rate) if span > _WHOLE * usual else ([], 0.0)
        tried.append((len(found), span, found))
        if share > _WELL:
            break
    _, span, found = max(tried, key=lambda one: one[:2])
    found = _measured(found, force, rate)
    if len(found) < _FEWEST:
        return None
    places, spans = _known_places(force, course, found, span)
    level = np.interp(np.arange(len(force)), places, [_middle(course[a:b]) for a, b in spans])
    swing = np.zeros(len(force), dtype=bool)
    for a, b in found:
        swing[a:b] = True
    return SwingLevels(places, spans, level, swing & np.isfinite(force), span)


def _middle(values: NDArray[np.float64]) -> float:
    ordered = np.sort(values)
    return 0.5 * float(ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2])


def _measured(found: Sequence[tuple[int, int]], force: NDArray[np.float64], rate: float) -> list[tuple[int, int]]:
    out = []
    for a, b in found:
        known = a + np.flatnonzero(np.isfinite(force[a:b]))
        if len(known) >= max(3, round(MINIMUM_SWING * rate)):
            out.append((int(known[0]), int(known[-1]) + 1))
    return out


def _known_places(
    force: NDArray[np.float64], course: NDArray[np.float64], found: Sequence[tuple[int, int]], span: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Places (m,) and spans (m, 2) of swings: middles of their halves, and both sides of offset jumps."""
    rows: list[tuple[float, int, int]] = []
    for a, b in found:
        if rows:
            _, before, until = rows[-1]
            change = _middle(course[a : (a + b) // 2]) - _middle(course[before:until])
            quarter = (a - until) // 4  # a foot that lands or lifts may jump, too
            jump = _jump(force[until + quarter : a - quarter], change) if abs(change) > _JUMP * span else None
            if jump is not None:
                jump += until + quarter
                rows += [(float(jump), before, until), (jump + 1.0, a, (a + b) // 2)]
        middle = (a + b) // 2
        change = _middle(course[b - (b - a) // 3 : b]) - _middle(course[a : a + (b - a) // 3])
        jump = _jump(force[a:b], change) if abs(change) > _JUMP * span else None
        if jump is not None and 1 < jump < b - a - 3:
            middle = a + jump + 1
            rows += [(0.5 * (a + middle - 1), a, middle), (middle - 1.0, a, middle), (float(middle), middle, b)]
        else:
            rows.append((0.5 * (a + middle - 1), a, middle))
        rows.append((0.5 * (middle + b - 1), middle, b))
    return np.array([row[0] for row in rows]), np.array([row[1:] for row in rows])


def _jump(force: NDArray[np.float64], change: float) -> int | None:
    if len(force) < 6 or not np.isfinite(force).all():
        return None
    steps = np.diff(force)
    usual = np.median(sliding_window_view(np.pad(steps, 2, mode="edge"), 5), axis=1)
    alone = (steps - usual) / change
    at = int(np.argmax(alone))
    return at if 0.6 < alone[at] < 1.6 else None


def _opened(course: NDArray[np.float64], longest: float, rate: float) -> NDArray[np.float64]:
    width = max(3, round(longest * rate))
    eroded = _least(np.pad(course, width, mode="edge"), width)
    return -_least(-eroded, width)[1 : len(course) + 1]


def _least(values: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    """Least value (n - width + 1,) of each run of `width` values, in time independent of width."""
    count = len(values)
    rows = -(-count // width)
    blocks = np.pad(values, (0, rows * width - count), constant_values=np.inf).reshape(rows, width)
    begun = np.minimum.accumulate(blocks, axis=1).ravel()
    ended = np.minimum.accumulate(blocks[:, ::-1], axis=1)[:, ::-1].ravel()
    return np.minimum(ended[: count - width + 1], begun[width - 1 : count])


def _usual_range(course: NDArray[np.float64], rate: float) -> float:
    rows = min(max(1, round(_STRETCH * rate)), len(course))
    low, high = np.percentile(course[: len(course) // rows * rows].reshape(-1, rows), (3.0, 92.0), axis=1)
    return float(np.median(high - low))


def _range(under: NDArray[np.float64]) -> float:
    top = float(np.percentile(under, 98.0))
    return float(np.percentile(under[under >= 0.2 * top], 90.0)) if top > 0.0 else 0.0


def _swings(
    under: NDArray[np.float64], course: NDArray[np.float64], span: float, rate: float
) -> tuple[list[tuple[int, int]], float]:
    n = len(under)
    near = under <= _NEAR * span
    if (~near & (under <= _ABOVE * span)).sum() > _SPARSE * near.sum():
        return [], 0.0
    contacts = true_runs(~near)
    quick = [_quick_ends(under[a:b], span, rate) for a, b in contacts]
    lands = {a for (a, _), (rises, _) in zip(contacts, quick, strict=True) if rises}
    lifts = {b for (_, b), (_, falls) in zip(contacts, quick, strict=True) if falls}
    steps = sum(under[a:b].max() > 0.5 * span for a, b in contacts)
    most = int(_LONGEST_SWING * rate)
    least = max(3, round(MINIMUM_SWING * rate))
    found = []
    inner = 0
    for a, b in true_runs(near):
        ends = (a == 0 or a in lifts) and (b == n or b in lands) and b - a < n
        if not ends or b - a < least or (a > 0 and b < n and b - a > most):
            continue
        at_start = a == 0
        at_end = b == n
        a, b = _level_at_end(course, a, b, span, least)
        a, b = (max(a, b - most), b) if at_start else (a, min(b, a + most)) if at_end else (a, b)
        if b - a < least:
            continue
        edge = (b - a) // 5
        found.append((a + edge, b - edge))
        inner += not (at_start or at_end)
    levels = np.array([_middle(course[a:b]) for a, b in found])
    kept = [run for run, odd in zip(found, _stand_out(levels, _OUTLIER * span), strict=True) if not odd]
    share = inner / max(1, steps - 1)
    return (kept, share) if inner >= _FEWEST and share >= _OFTEN else ([], 0.0)


def _level_at_end(course: NDArray[np.float64], a: int, b: int, span: float, least: int) -> tuple[int, int]:
    if a > 0 and b < len(course):
        return a, b
    beside = _middle(course[b - least : b] if a == 0 else course[a : a + least])
    off = np.flatnonzero(np.abs(course[a:b] - beside) > _NEAR * span)
    if not len(off):
        return a, b
    return (a + int(off[-1]) + 1, b) if a == 0 else (a, a + int(off[0]))


def _stand_out(levels: NDArray[np.float64], least: float) -> NDArray[np.bool_]:
    """Levels (m,) far above both neighbours (at an end: above the only one)."""
    before = np.concatenate([[np.inf], levels[:-1]])
    after = np.concatenate([levels[1:], [np.inf]])
    beside = np.where(np.isinf(before), after, np.where(np.isinf(after), before, np.maximum(before, after)))
    return np.asarray(levels - beside > least)


def _quick_ends(contact: NDArray[np.float64], span: float, rate: float) -> tuple[bool, bool]:
    half = np.flatnonzero(contact > 0.5 * span)
    if not len(half):
        return False, False
    longest = max(_QUICK * rate, _QUICK_SHARE * len(contact))
    return bool(half[0] <= longest), bool(len(contact) - 1 - half[-1] <= longest)
