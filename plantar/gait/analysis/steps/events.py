"""Gait events: heel strikes and toe offs from a foot's vertical force.

`EVENT_LEVELS` are shares of the range from swing level to robust peak, raised by noise. An event is where force crosses
its level, or midway in a jump of half the range; an insole's landing is straightened back to where its rise begins, and
its push-off to where its fall ends, by up to a hundredth of a second.
"""

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from plantar.recordings.pressure_recording import Kind, true_runs


@dataclass(frozen=True)
class EventLevels:
    """Force range shares at which events lie.

    `strike`: rising crossing of a heel strike; below it the foot is off the ground; `lift`: last falling crossing,
    earliest toe off; `clear`: falling crossing of the latest toe off; None if at `lift`.
    """

    strike: float
    contact: float
    lift: float
    clear: float | None = None


EVENT_LEVELS: Mapping[Kind, EventLevels] = {
    "insole": EventLevels(0.05, 0.10, 0.10, 0.02),
    "robot": EventLevels(0.02, 0.10, 0.02),
    "platform": EventLevels(0.02, 0.05, 0.02),
    "plate": EventLevels(0.02, 0.05, 0.03),
}
"""Levels of the events by what measures."""

LEAST_FRAMES = 3  # Measured frames from which noise is told from load, by second differences
MINIMUM_STANCE = 0.1
"""Shortest contact in s; shorter ones are a brush of the ground or a disturbance and are dropped."""

MINIMUM_SWING = 0.15
"""Shortest time in s off the ground; over shorter ones the foot counts as in contact."""

LONGEST_BRIDGE = 0.1  # Longest gap in s of frames that were not measured over which the force is interpolated
# Standard deviations of the noise that a foot's release, and its contact, lie above the level at rest.
_NOISE_RELEASE = 4.0
_NOISE_CONTACT = 8.0
_MEDIAN_OF_NORMAL = 0.6745  # Median of the magnitude of a normal variable, in standard deviations
# Shares of the range that part the fall of push-off, from its steepest piece on: a foot that leaves slowly goes on
# falling at 0.4 of that or more; where the force hardly falls any more the shoe presses, and the piece before is
# continued straight. Of shares and slopes tried, these have the least largest mean over the sets of
# `benchmarks/gait_events.py`.
_FALL = (0.60, 0.30, 0.15, 0.075)
_SHELF = 0.4
_BESIDE = 0.5  # Time in s before a landing and after a push-off in which the force at rest is looked for
# Shares of the range that part the rise of a landing, from the event level on: its steepest piece is continued back
# straight. A shoe that touches lightly before the foot lands makes the first piece flat.
_RISE = (0.20, 0.50)
# Shares of the range that makers' events of insoles lie at, and times in s by which a straightened landing may begin
# before and a push-off end after: a slow walker's shoe presses long before and after what makers call a contact. With
# 10 ms after, a quick walker's double support is 1.7 points longer than its maker's; with 8.5 the stances of a pedar
# walk are shorter than by another package's definitions.
_STATED_RISE = 0.075
_STATED_FALL = 0.13
_BEFORE = 0.008
_AFTER = 0.009
_LIGHT = 0.7  # Share of the middle load that a contact has to reach for its peak to count
# Contacts of more than 1.5 s are looked at for steps in them: force that rises by more than half of the foot's range
# within 0.25 s, from 0.2 to 0.8 of what it ranges over there; weight is shifted more slowly.
_LONGEST_STEP = 1.5
_DEEP = 0.5
_LANDING = 0.25
_FEWEST_STEPS = 20  # Steps between swing samples from which their noise is judged


@dataclass(frozen=True)
class Levels:
    """One foot's force levels in N.

    `release`: heel strike level, below which the foot is off the ground; `lift`: earliest toe off; `noise`: standard
    deviation in swing; `clear`: latest toe off, where push-off is continued to `rest`; None if at `lift`.
    """

    rest: float
    peak: float
    release: float
    contact: float
    noise: float
    lift: float
    clear: float | None = None


@dataclass(frozen=True)
class Contact:
    """One contact of a foot; times are None where the recording or a gap cuts it.

    Attributes:
        heel_strike: Begin in s.
        toe_off: End in s.
        begin: First frame.
        end: Frame after the last.
        standing: Whether too long for a step.
        walk: Number of the pass over a platform or plates, which no stride leaves.
        cut: Whether a platform's edge cuts its footprint off.
    """

    heel_strike: float | None
    toe_off: float | None
    begin: int
    end: int
    standing: bool = False
    walk: int = 0
    cut: bool = False

    @property
    def complete(self) -> bool:
        """Whether it is a step with both ends and the whole footprint recorded."""
        return self.heel_strike is not None and self.toe_off is not None and not self.standing and not self.cut


def force_levels(force: NDArray[np.float64], kind: Kind = "robot", lifted: bool = True) -> Levels | None:
    """Returns levels of a foot's vertical force (n,) in N, NaN if unmeasured; None where never above its noise.

    Noise and swing load depend on the kind of sensor; a foot not lifted has no swing.
    """
    measured = force[np.isfinite(force)]
    if len(measured) < LEAST_FRAMES:
        return None
    smooth = smoothed(measured)
    peak = _peak_above_noise(measured, smooth)
    if peak is None:
        return None
    share = EVENT_LEVELS[kind]
    rest, noise = _rest_and_noise(force, smooth, peak, share.contact, kind) if lifted else (0.0, 0.0)
    span = peak - rest
    if span <= 2.0 * _NOISE_CONTACT * noise or span <= 0.0:
        return None
    return Levels(
        rest=rest,
        peak=peak,
        release=rest + max(share.strike * span, _NOISE_RELEASE * noise),
        contact=rest + max(share.contact * span, _NOISE_CONTACT * noise),
        noise=noise,
        lift=rest + max(share.lift * span, _NOISE_RELEASE * noise),
        clear=None if share.clear is None else rest + max(share.clear * span, _NOISE_RELEASE * noise),
    )


def threshold_levels(levels: Levels, threshold: float) -> Levels:
    """Levels of a protocol whose events lie where the force crosses a threshold in N; `levels` are the foot's own."""
    contact = max(threshold, levels.contact)
    return replace(levels, release=threshold, contact=contact, lift=threshold, clear=None)


def smoothed(force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Median of five frames of force (n,): single damaged frames are no peaks."""
    padded = np.pad(force, 2, mode="edge")
    a, b, c, d, e = (padded[k : len(force) + k] for k in range(5))
    low = np.minimum(a, b)
    high = np.maximum(a, b)
    least = np.minimum(c, d)
    most = np.maximum(c, d)
    inner = np.maximum(low, least), np.minimum(high, most)  # without the smallest and the largest of four
    return np.maximum(np.minimum(*inner), np.minimum(np.maximum(*inner), e))


def _peak_above_noise(measured: NDArray[np.float64], smooth: NDArray[np.float64]) -> float | None:
    top = float(smooth.max())
    if not top > 0.0:
        return None
    peak = _peak_of_contacts(smooth, 0.2 * top)
    # Second differences see the noise and not the slopes; that of white noise is sqrt(1 + 4 + 1) times as large.
    bend = np.abs(np.diff(measured, 2))
    return peak if peak > _NOISE_CONTACT * float(np.median(bend)) / (_MEDIAN_OF_NORMAL * np.sqrt(6.0)) else None


def _peak_of_contacts(smooth: NDArray[np.float64], floor: float) -> float:
    """Median contact peak in N, independent of standing before a walk."""
    least = _LIGHT * float(np.median(smooth[smooth >= floor]))  # chatter about the floor is no contact
    loads = [np.sort(smooth[a:b]) for a, b in true_runs(smooth >= floor)]
    # Median of their 90th percentiles, for which numpy's own function takes ten times as long.
    return float(np.median([np.interp(0.9 * (len(q) - 1), np.arange(len(q)), q) for q in loads if q[-1] >= least]))


def _rest_and_noise(
    force: NDArray[np.float64], smooth: NDArray[np.float64], peak: float, contact: float, kind: Kind
) -> tuple[float, float]:
    rest = float(np.percentile(smooth, 5.0))
    if rest > 0.3 * peak or kind == "platform":  # never off the ground, or nothing rests on it when it is
        rest = 0.0
    rest = max(rest, 0.0)
    quiet = force < rest + contact * (peak - rest)
    steps = np.diff(force)[quiet[:-1] & quiet[1:]]
    if len(steps) < _FEWEST_STEPS:
        return rest, 0.0
    noise = float(np.median(np.abs(steps))) / (_MEDIAN_OF_NORMAL * np.sqrt(2.0))
    if kind != "platform":  # the middle of the swing samples is the better zero
        rest = max(0.0, min(float(np.median(force[quiet])), rest + 2.0 * noise + 0.02 * peak))
    return rest, noise


def find_contacts(
    time: NDArray[np.float64],
    force: NDArray[np.float64],
    levels: Levels | None = None,
    minimum_stance: float = MINIMUM_STANCE,
) -> list[Contact]:
    """Returns one foot's contacts in order.

    Args:
        time: (n,) in s, increasing.
        force: Vertical (n,) in N; NaN if unmeasured. Gaps up to 0.1 s are interpolated; longer ones cut a contact, as
            do the recording's ends.
        levels: Those of `force_levels` where None.
        minimum_stance: Shortest contact in s.

    Example:
        >>> time = np.arange(400) * 0.01
        >>> force = np.where((time % 1.0 > 0.2) & (time % 1.0 < 0.8), 700.0, 0.0)
        >>> [c.complete for c in find_contacts(time, force)]
        [True, True, True, True]
    """
    levels = force_levels(force) if levels is None else levels
    if levels is None:
        return []
    contacts: list[Contact] = []
    for start, stop in measured_spans(time, force):
        gap = ~np.isfinite(force[start:stop])
        part = force[start:stop].copy()
        if gap.any():
            part[gap] = np.interp(time[start:stop][gap], time[start:stop][~gap], part[~gap])
        contacts += _contacts_of_span(time[start:stop], part, levels, start, minimum_stance)
    return contacts


def measured_spans(time: NDArray[np.float64], force: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Returns first and end frames of spans without gaps over `LONGEST_BRIDGE`, in force or time.

    `time` (n,) in s, increasing; `force`: vertical (n,) in N; NaN if unmeasured.

    Example:
        >>> measured_spans(np.arange(6) * 0.1, np.array([1.0, 2.0, np.nan, np.nan, np.nan, 0.0]))
        [(0, 2), (5, 6)]
    """
    index = np.flatnonzero(np.isfinite(force))
    if len(index) < 2:
        return [(int(i), int(i) + 1) for i in index]
    cut = np.flatnonzero(np.diff(time[index]) > LONGEST_BRIDGE + 1.5 * float(np.median(np.diff(time))))
    starts = np.concatenate([[index[0]], index[cut + 1]])
    stops = np.concatenate([index[cut], [index[-1]]]) + 1
    return [(int(a), int(b)) for a, b in zip(starts, stops, strict=True)]


class _Curve(NamedTuple):
    """Times in s and vertical force in N of a span's frames, as views that give plain numbers faster than an array."""

    time: Sequence[float]
    force: Sequence[float]

    def first_from(self, begin: int, end: int, level: float) -> int | None:
        """First frame from `begin` to before `end` with a level's force or more; None without."""
        return next((i for i in range(begin, end) if self.force[i] >= level), None)

    def last_from(self, begin: int, end: int, level: float) -> int | None:
        """Last frame from `begin` to before `end` with a level's force or more; None without."""
        return next((i for i in range(end - 1, begin - 1, -1) if self.force[i] >= level), None)

    def crossing(self, frame: int, level: float, jump: float = math.inf) -> float:
        """Time the force crosses the level between a frame and the last: midway in jumps."""
        f0 = self.force[frame - 1]
        f1 = self.force[frame]
        before = self.time[frame - 1]
        after = self.time[frame]
        share = 0.5 if f0 == f1 or abs(f1 - f0) > jump else min(max((level - f0) / (f1 - f0), 0.0), 1.0)
        return float(before + share * (after - before))


def _contacts_of_span(
    time: NDArray[np.float64], force: NDArray[np.float64], levels: Levels, offset: int, minimum_stance: float
) -> list[Contact]:
    curve = _Curve(cast(Sequence[float], time.data), cast(Sequence[float], force.data))
    spans = _merged(curve, force, levels, true_runs(force >= levels.release))
    found = [_contact(curve, levels, span, offset) for span in spans]
    return [c for c in found if not c.complete or cast(float, c.toe_off) - cast(float, c.heel_strike) >= minimum_stance]


def _merged(
    curve: _Curve, force: NDArray[np.float64], levels: Levels, spans: list[tuple[int, int]]
) -> list[tuple[int, int]]:
    reaching = [k for k, (a, b) in enumerate(spans) if force[a:b].max() >= levels.contact]
    merged: list[tuple[int, int]] = []
    for i, k in enumerate(reaching):
        # Off the ground between two contacts only if the force stays below the event level for long enough: a foot
        # that lands lightly and chatters does not.
        if i and _longest_gap(curve, spans[reaching[i - 1] : k + 1], levels.release) < MINIMUM_SWING:
            merged[-1] = (merged[-1][0], spans[k][1])
        else:
            merged.append(spans[k])
    return merged


def _contact(curve: _Curve, levels: Levels, span: tuple[int, int], offset: int) -> Contact:
    begin, end = span
    force = curve.force
    jump = 0.5 * (levels.peak - levels.rest)
    strike = curve.crossing(begin, levels.release, jump) if begin > 0 else None
    if strike is not None and levels.clear is not None and force[begin] - force[begin - 1] <= jump:
        strike = _begin_of_rise(curve, span, levels, strike)
    lift = None
    if end < len(force):
        level = min(levels.lift, levels.contact)
        end = cast(int, curve.last_from(begin, end, level)) + 1
        lift = curve.crossing(end, level, jump)
        if levels.clear is not None and force[end - 1] - force[end] <= jump:
            lift = _end_of_push_off(curve, (begin, end), levels, lift)
            end = max(end, bisect_left(curve.time, lift))
    return Contact(strike, lift, begin + offset, end + offset)


def _begin_of_rise(curve: _Curve, span: tuple[int, int], levels: Levels, strike: float) -> float:
    """Begin of a landing's rise, continued back straight: not before the force leaves its rest."""
    begin, end = span
    assert levels.clear is not None
    at = [strike]
    heights = [levels.release]
    for share in _RISE:
        level = levels.rest + share * (levels.peak - levels.rest)
        above = curve.first_from(begin, end, level)
        if above is None or level <= heights[-1]:
            return strike
        at.append(max(curve.crossing(above, level), at[-1]))
        heights.append(level)
    slow = [(b - a) / (h - g) for a, b, g, h in zip(at, at[1:], heights, heights[1:], strict=False)]
    steepest = slow.index(min(slow))
    straight = at[steepest] - slow[steepest] * (heights[steepest] - levels.rest)
    first = bisect_left(curve.time, strike - _BESIDE)
    before = next((i for i in range(begin - 1, first - 1, -1) if curve.force[i] <= levels.clear), None)
    least = strike if before is None else curve.crossing(before + 1, levels.clear)
    least -= slow[steepest] * (levels.clear - levels.rest)
    level = levels.rest + _STATED_RISE * (levels.peak - levels.rest)
    stated = curve.crossing(cast(int, curve.first_from(begin, end, level)), level)
    return max(min(strike, max(straight, least)), stated - _BEFORE)


def _end_of_push_off(curve: _Curve, span: tuple[int, int], levels: Levels, lift: float) -> float:
    """End of push-off, continued straight: after `lift`, not after the force is clear."""
    begin, end = span
    assert levels.clear is not None
    time = curve.time
    force = curve.force
    until = bisect_left(time, time[end] + _BESIDE) + 1
    at = []
    for share in _FALL:
        level = levels.rest + share * (levels.peak - levels.rest)
        loaded = curve.last_from(begin, end, level)
        below = None if loaded is None else loaded + 1
        if level < force[end - 1]:
            below = next((i for i in range(end, min(until, len(force))) if force[i] < level), None)
        at.append(np.inf if loaded is None or below is None else curve.crossing(below, level))
    slow = [
        (b - a) / (g - h) if a < b < np.inf else np.inf
        for a, b, g, h in zip(at, at[1:], _FALL, _FALL[1:], strict=False)
    ]
    piece = 0 if slow[0] <= slow[1] else 1
    if not math.isfinite(slow[piece]):
        return lift  # a light contact
    quickest = slow[piece]
    while piece + 1 < len(slow) and slow[piece + 1] * _SHELF <= quickest:
        piece += 1  # the foot still unloads, if more slowly
    straight = at[piece + 1] + slow[piece] * _FALL[piece + 1]
    stop = bisect_left(time, straight)
    light = next((i for i in range(end, min(stop + 1, len(force))) if force[i] <= levels.clear), None)
    if light is not None:
        clear = curve.crossing(light, levels.clear)
        straight = min(straight, clear + slow[piece] * (levels.clear - levels.rest))
    level = levels.rest + _STATED_FALL * (levels.peak - levels.rest)
    last = curve.last_from(begin, end, level)
    stated = lift if last is None else curve.crossing(last + 1, level)
    return min(max(lift, min(straight, time[-1])), stated + _AFTER)


def _longest_gap(curve: _Curve, spans: list[tuple[int, int]], level: float) -> float:
    return max(
        curve.crossing(later[0], level) - curve.crossing(earlier[1], level) for earlier, later in pairwise(spans)
    )


def run_together(force: NDArray[np.float64], rate: float, levels: Levels, contact: Contact) -> int:
    """Returns number of landings that an offset joins in a contact; 0 if short. `force`: vertical (n,) in N.

    Example:
        >>> time = np.arange(0.0, 10.0, 0.01)
        >>> force = 200.0 + 700.0 * ((time % 1.0 > 0.4) & (time > 1.0))
        >>> found = Contact(0.0, None, 0, 1000)
        >>> run_together(force, 100.0, Levels(0.0, 900.0, 45.0, 90.0, 0.0, 90.0), found)
        9
    """
    part = force[contact.begin : contact.end]
    part = part[np.isfinite(part)]
    if len(part) < _LONGEST_STEP * rate:
        return 0
    course = smoothed(part)
    low, high = (float(v) for v in np.percentile(course, (3.0, 92.0)))
    if high - low < _DEEP * (levels.peak - levels.rest):
        return 0
    share = (course - low) / (high - low)
    edges = np.flatnonzero(np.diff((share > 0.5).astype(np.int8)) == 1)
    reach = max(1, round(0.5 * _LANDING * rate))
    lands = (share[max(0, i - reach) : i + 1].min() < 0.2 and share[i : i + reach + 2].max() > 0.8 for i in edges)
    return int(sum(lands))
