"""When a foot's steps follow each other: strides, stance, swing, and the time on both feet."""

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

PAUSE = 1.75
"""A stride longer than so many times the median of its foot holds a pause or a step that was not recorded."""

_LONGEST_FLIGHT = 0.6
"""Time in s after which the other foot's heel strike is not that of the next step: runners fly for 0.3 s."""


def stride_times(contacts: Sequence[Contact]) -> list[float]:
    """Stride time of each complete contact; NaN where the next heel strike is not the next step's.

    Strides lead from one complete contact to another: a contact that the recording cuts may be standing. Where a foot
    has no such stride, those to a cut contact are taken.

    Args:
        contacts: All contacts of the foot, in order.

    Returns:
        The time in s of each complete one's stride.
    """
    raw, limit = _raw_strides(contacts), longest_stride(contacts)
    return [s if s <= limit else np.nan for s in raw]


def longest_stride(contacts: Sequence[Contact]) -> float:
    """The time in s from which a stride holds a pause or a step that was not recorded; inf of fewer than three strides.

    Args:
        contacts: All contacts of the foot, in order.

    Returns:
        The time in s.
    """
    known = [s for s in _raw_strides(contacts) if np.isfinite(s)]
    return PAUSE * float(np.median(known)) if len(known) >= 3 else np.inf


def _raw_strides(contacts: Sequence[Contact]) -> list[float]:
    """Time in s from each complete contact to the next, pauses and all."""
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
    """Measures of time of one complete contact. What takes both feet is NaN where the other one was not measured.

    Args:
        contact: The contact.
        previous: The contact of the same foot before it.
        stride: Its stride time in s; NaN where it is not known.
        longest: Time in s from the contact before it that holds a pause, see `longest_stride`.
        others: The contacts of the other foot, None where it was not recorded.

    Returns:
        The measures by their key.
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
    """The contacts of the other foot, as arrays that are searched quickly.

    Args:
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
        """Whether the foot was measured all the time: where it was not, it is not in the air.

        Args:
            begin: Begin of the time in s.
            end: Its end in s.

        Returns:
            False where a gap that is too long to bridge falls into it.
        """
        return any(first <= begin and end <= last for first, last in self._measured)

    def strikes_between(self, begin: float, end: float) -> NDArray[np.float64]:
        """Heel strikes after one time and before another.

        Args:
            begin: The one time in s.
            end: The other one in s.

        Returns:
            Their times (k,) in s.
        """
        first, last = np.searchsorted(self.strikes, begin, "right"), np.searchsorted(self.strikes, end, "left")
        return self.strikes[first:last]

    def flight(self, lift: float) -> float:
        """How long both feet are off the ground after this one leaves it.

        Args:
            lift: Its toe off in s.

        Returns:
            The time in s to the other foot's heel strike, 0 where that foot is on the ground; NaN where none follows,
            or where it was not measured.
        """
        if ((self._begin <= lift) & (self._end > lift)).any():
            return 0.0
        after = self.strikes[self.strikes > lift]
        follows = len(after) > 0 and after[0] - lift < _LONGEST_FLIGHT and self.was_measured(lift, float(after[0]))
        return float(after[0]) - lift if follows else float("nan")

    def overlap(self, strike: float, lift: float) -> float:
        """How long of a contact the other foot is on the ground too.

        Args:
            strike: Begin of the contact in s.
            lift: Its end in s.

        Returns:
            The time in s; NaN where that foot was not measured all the time.
        """
        if not self.was_measured(strike, lift):
            return float("nan")
        first, last = np.searchsorted(self._end, strike, "right"), np.searchsorted(self._begin, lift, "left")
        begin, end = self._begin[first:last], self._end[first:last]
        return float((np.minimum(end, lift) - np.maximum(begin, strike)).clip(0.0).sum())
