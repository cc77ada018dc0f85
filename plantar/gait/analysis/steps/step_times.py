"""Times of steps: strides, stance, swing, double support."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from itertools import zip_longest
from statistics import median
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.steps.events import Contact, measured_spans
from plantar.recordings.pressure_recording import PressureRecording

# A stride longer than so many times the median of this many before or after it holds a pause or an unrecorded step.
PAUSE = 1.75
_BESIDE = 7
# Time in s after which the other foot's heel strike is not that of the next step: runners fly for 0.3 s.
_LONGEST_FLIGHT = 0.6


def stride_times(contacts: Sequence[Contact], longest: Sequence[float] | None = None) -> list[float]:
    """Stride time in s of each complete contact; NaN where the next heel strike is not the next step's.

    `longest`: their `longest_strides`, where these are known.

    Strides join complete contacts, as a cut one may be standing; without any, cut ones.
    """
    limits = longest_strides(contacts) if longest is None else longest
    return [s if s <= most else np.nan for s, most in zip(_raw_strides(contacts), limits, strict=True)]


def longest_strides(contacts: Sequence[Contact]) -> list[float]:
    """Time in s above which each complete contact's stride holds a pause or missing step; inf below three strides.

    By the strides before and after it: a walk may become a run.
    """
    raw = _raw_strides(contacts)
    known = [s for s in raw if math.isfinite(s)]
    if len(known) < 3:
        return [np.inf] * len(raw)
    out = []
    first = 0  # known strides before each contact's
    for stride in raw:
        last = first + math.isfinite(stride)
        beside = (known[max(0, first - _BESIDE) : first], known[last : last + _BESIDE])
        out.append(PAUSE * max(median(part) for part in beside if part))
        first = last
    return out


def _raw_strides(contacts: Sequence[Contact]) -> list[float]:
    raw = _strides(contacts, whole=True)
    return raw if np.isfinite(raw).any() else _strides(contacts, whole=False)


def _strides(contacts: Sequence[Contact], whole: bool) -> list[float]:
    """Time in s from each complete contact's strike to the next contact's; NaN without, or if cut."""
    out: list[float] = []
    for contact, after in zip_longest(contacts, contacts[1:]):
        if not contact.complete:
            continue
        if after is None or after.heel_strike is None or after.walk != contact.walk or (whole and not after.complete):
            out.append(np.nan)
        else:
            out.append(after.heel_strike - cast(float, contact.heel_strike))
    return out


def time_measures(
    contact: Contact, previous: Contact | None, stride: float, longest: float, others: OtherFoot | None
) -> dict[str, float]:
    """Returns time measures of one complete contact; NaN for those of both feet if the other is unmeasured.

    `stride`: stride time in s, or NaN; `longest`: strike interval in s that holds a pause (`longest_strides`);
    `others`: other foot's contacts, None if not recorded.
    """
    strike = cast(float, contact.heel_strike)
    lift = cast(float, contact.toe_off)
    duration = lift - strike
    share = 100.0 * duration / stride
    out = {
        "contact_time_s": duration,
        "stride_time_s": stride,
        "swing_time_s": stride - duration,
        "stance_percent": share,
        "swing_percent": 100.0 - share,
    }
    if others is not None:
        last = None if previous is None or previous.walk != contact.walk else previous.heel_strike
        if last is not None and strike - last <= longest and others.was_measured(last, strike):
            between = others.strikes_between(last, strike)
            if len(between) == 1:
                out["step_time_s"] = strike - float(between[0])
        both = 100.0 * others.overlap(strike, lift, contact.walk) / stride
        out["flight_time_s"] = others.flight(lift)
        out["double_support_percent"] = both
        out["single_support_percent"] = share - both
    return out


class OtherFoot:
    """Other foot's contacts, as sorted arrays.

    `spans`: first and last time in s of each contact; `measured`: those in which the foot was measured without gaps.
    """

    def __init__(
        self,
        contacts: Sequence[Contact],
        spans: Sequence[tuple[float, float]],
        measured: Sequence[tuple[float, float]],
    ) -> None:
        self.strikes = np.array([c.heel_strike for c in contacts if c.heel_strike is not None])
        self._measured = measured
        self._begin = [begin for begin, _ in spans]
        self._end = [end for _, end in spans]
        self._strikes: list[float] = self.strikes.tolist()
        self._walks: dict[int, tuple[float, float]] = {}  # first begin and last end of each
        for contact, (begin, end) in zip(contacts, spans, strict=True):
            first, last = self._walks.get(contact.walk, (begin, end))
            self._walks[contact.walk] = (min(first, begin), max(last, end))

    @classmethod
    def of_recording(cls, recording: PressureRecording, side: Side, contacts: Sequence[Contact]) -> OtherFoot:
        """Foot of a side of a recording; contacts that this cuts begin and end with their frames."""
        time = recording.time
        measured = measured_spans(time, recording.feet[side].vertical_force)
        begins = [float(time[c.begin]) if c.heel_strike is None else c.heel_strike for c in contacts]
        ends = [float(time[c.end - 1]) if c.toe_off is None else c.toe_off for c in contacts]
        whole = [(float(time[first]), float(time[after - 1])) for first, after in measured]
        return cls(contacts, list(zip(begins, ends, strict=True)), whole)

    def was_measured(self, begin: float, end: float) -> bool:
        """Returns whether the foot was measured from begin to end in s, without long gaps."""
        return any(first <= begin and end <= last for first, last in self._measured)

    def strikes_between(self, begin: float, end: float) -> NDArray[np.float64]:
        """Returns heel strikes (k,) in s between begin and end, in s."""
        return self.strikes[bisect_right(self._strikes, begin) : bisect_left(self._strikes, end)]

    def flight(self, lift: float) -> float:
        """Time in s from `lift` in s to the other foot's heel strike, 0 on the ground; NaN if unknown."""
        left = bisect_right(self._end, lift)
        if left < len(self._end) and self._begin[left] <= lift:
            return 0.0
        next_ = bisect_right(self._strikes, lift)
        if next_ == len(self._strikes):
            return math.nan
        after = self._strikes[next_]
        follows = after - lift < _LONGEST_FLIGHT and self.was_measured(lift, after)
        return after - lift if follows else math.nan

    def overlap(self, strike: float, lift: float, walk: int = 0) -> float:
        """Returns time in s with the other foot on the ground from strike to lift in s; NaN if unmeasured.

        As is one without a contact before and after in its walk, which may have been beside the platform.
        """
        begin, end = self._walks.get(walk, (math.inf, -math.inf))
        if not (self.was_measured(strike, lift) and begin < strike and end > lift):
            return math.nan
        first = bisect_right(self._end, strike)
        last = bisect_left(self._begin, lift)
        beside = zip(self._begin[first:last], self._end[first:last], strict=True)
        return sum((max(0.0, min(end, lift) - max(begin, strike)) for begin, end in beside), 0.0)
