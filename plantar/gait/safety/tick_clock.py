"""Monotone, plausible tick times for any reported time."""

import math

_NEAR = 0.5  # derived: periods that a tick may come early or late by and still be taken as it is
_FOLLOWED = 0.1  # chosen: s that a clock may be off by and still be followed, slowly
_STALLED = 0.5  # chosen: s of a stall beyond which joints are not expected to move farther
_DRAWN = 0.02  # chosen: share of an error that a tick follows
_MOST_DRAWN = 0.2  # chosen: periods by which a tick is longer or shorter for that


class TickClock:
    """Time by what ticks report.

    A tick is expected one period after the last. A near time is used, one a little off pulls the clock slowly, one far
    off is another zero.

    `period` of control in s; `latest`: first time in s that may be; after a later or negative one ticks count from 0.
    Attributes `odd`: successive ticks with unusable times; `jumped`: time in s by which the last one was another zero;
    `late`: ticks by which it came later than the one before.

    Example:
        >>> clock = TickClock(0.005)
        >>> [round(clock.time_of(t), 4) for t in (1.0, 1.005, math.nan, 6.015, 6.02)], clock.odd
        ([1.0, 1.005, 1.01, 1.015, 1.02], 0)
    """

    def __init__(self, period: float, latest: float = math.inf) -> None:
        self._period = period
        self._latest = latest
        self._last: float | None = None
        self._offset = 0.0
        self.odd = 0
        self.jumped = 0.0
        self.late = 0
        self._error = 0.0

    def time_of(self, reported: float) -> float:
        """A tick's time in s, after the last one's, by the `reported` time in s."""
        if self._last is None:
            self._last = reported if 0.0 <= reported <= self._latest and math.isfinite(reported) else 0.0
            self._offset = self._last - reported if math.isfinite(reported) else math.nan
            return self._last
        expected = self._last + self._period
        error = reported + self._offset - expected
        self.jumped = 0.0
        self.late = round(min(error - self._error, _STALLED) / self._period) if error > self._error else 0
        self._error = 0.0
        if abs(error) <= _NEAR * self._period:
            self.odd = 0
            self._last = reported + self._offset
            return self._last
        if not math.isfinite(reported):
            self.odd += 1
        elif abs(error) <= _FOLLOWED:
            self.odd = 0
            most = _MOST_DRAWN * self._period
            expected += min(max(_DRAWN * error, -most), most)
            self._error = error
        else:
            self.odd += 1
            self.jumped = error
            self._offset = expected - reported
        self._last = expected
        return expected
