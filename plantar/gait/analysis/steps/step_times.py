"""Times of a foot's steps: strides, stance, swing, and the time on both feet."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.steps.events import Contact, measured_spans
from plantar.recordings.pressure_recording import PressureRecording
from plantar.sides import Side

__all__ = ["OtherFoot", "longest_stride", "stride_times", "time_measures"]

PAUSE = 1.75  # A stride longer than so many times the median of its foot holds a pause or a step that was not recorded
# Time in s after which the other foot's heel strike is not that of the next step: runners fly for 0.3 s.
_LONGEST_FLIGHT = 0.6


def stride_times(contacts: Sequence[Contact]) -> list[float]:
    """Stride time in s of each complete one of a foot's contacts; NaN where the next heel strike is not the next
    step's.

    Strides lead from one complete contact to another, as a cut contact may be standing; without any, to cut ones.
    """
    raw, limit = _raw_strides(contacts), longest_stride(contacts)
    return [s if s <= limit else np.nan for s in raw]


def longest_stride(contacts: Sequence[Contact]) -> float:
    """Time in s above which a stride between contacts holds a pause or a missing step; inf of fewer than three
    strides.
    """
    known = [s for s in _raw_strides(contacts) if np.isfinite(s)]
    return PAUSE * float(np.median(known)) if len(known) >= 3 else np.inf


def _raw_strides(contacts: Sequence[Contact]) -> list[float]:
    """Time in s from each complete contact to the next, pauses included."""
    raw = _strides(contacts, whole=True)
    return raw if np.isfinite(raw).any() else _strides(contacts, whole=False)


def _strides(contacts: Sequence[Contact], whole: bool) -> list[float]:
    """Time in s from the strike of each complete contact to the next contact's; NaN without, or where that is cut."""
    out: list[float] = []
    for contact, after in zip_longest(contacts, contacts[1:]):
        if not contact.complete:
            continue
        if after is None or after.heel_strike is None or (whole and not after.complete):
            out.append(np.nan)
        else:
            out.append(after.heel_strike - cast(float, contact.heel_strike))
    return out


def time_measures(
    contact: Contact, previous: Contact | None, stride: float, longest: float, others: OtherFoot | None
) -> dict[str, float]:
    """Returns the measures of time of one complete contact; NaN for those of both feet where the other was not
    measured.

    Args:
        contact: The contact.
        previous: The contact of the same foot before it.
        stride: Its stride time in s, or NaN.
        longest: Time in s between strikes that holds a pause (`longest_stride`).
        others: The contacts of the other foot, None where it was not recorded.
    """
    strike, lift = cast(float, contact.heel_strike), cast(float, contact.toe_off)
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
        last = None if previous is None else previous.heel_strike
        if last is not None and strike - last <= longest and others.was_measured(last, strike):
            between = others.strikes_between(last, strike)
            if len(between) == 1:
                out["step_time_s"] = strike - float(between[0])
        both = 100.0 * others.overlap(strike, lift) / stride
        out["flight_time_s"] = others.flight(lift)
        out["double_support_percent"] = both
        out["single_support_percent"] = share - both
    return out


class OtherFoot:
    """The contacts of the other foot, as sorted arrays.

    Args:
        recording: The recording.
        side: The other foot.
        contacts: Its contacts, in order.
    """

    def __init__(self, recording: PressureRecording, side: Side, contacts: Sequence[Contact]) -> None:
        time = recording.time
        self.strikes = np.array([c.heel_strike for c in contacts if c.heel_strike is not None])
        spans = measured_spans(time, recording.feet[side].vertical_force)
        self._measured = [(float(time[first]), float(time[after - 1])) for first, after in spans]
        begin = [float(time[c.begin]) if c.heel_strike is None else c.heel_strike for c in contacts]
        end = [float(time[c.end - 1]) if c.toe_off is None else c.toe_off for c in contacts]
        self._begin, self._end = np.array(begin), np.array(end)

    def was_measured(self, begin: float, end: float) -> bool:
        """Returns whether the foot was measured from begin to end, in s, without a gap too long to bridge."""
        return any(first <= begin and end <= last for first, last in self._measured)

    def strikes_between(self, begin: float, end: float) -> NDArray[np.float64]:
        """Returns the heel strikes (k,) in s after begin and before end, in s."""
        first, last = np.searchsorted(self.strikes, begin, "right"), np.searchsorted(self.strikes, end, "left")
        return self.strikes[first:last]

    def flight(self, lift: float) -> float:
        """Time in s from `lift` in s to the other foot's heel strike, 0 where it is on the ground; NaN if unknown."""
        if ((self._begin <= lift) & (self._end > lift)).any():
            return 0.0
        after = self.strikes[self.strikes > lift]
        follows = len(after) > 0 and after[0] - lift < _LONGEST_FLIGHT and self.was_measured(lift, float(after[0]))
        return float(after[0]) - lift if follows else float("nan")

    def overlap(self, strike: float, lift: float) -> float:
        """Returns the time in s of a contact from strike to lift in s with the other foot on the ground; NaN if not
        measured.
        """
        if not self.was_measured(strike, lift):
            return float("nan")
        first, last = np.searchsorted(self._end, strike, "right"), np.searchsorted(self._begin, lift, "left")
        begin, end = self._begin[first:last], self._end[first:last]
        return float((np.minimum(end, lift) - np.maximum(begin, strike)).clip(0.0).sum())
