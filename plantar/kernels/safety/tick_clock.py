"""Monotone, plausible tick times for any reported time."""

import math

__all__ = ["TickClock"]

_INFINITE = float("inf")
_NONE = float("nan")
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
        >>> import math
        >>> clock = TickClock(0.005)
        >>> [round(clock.time_of(t), 4) for t in (1.0, 1.005, math.nan, 6.015, 6.02)], clock.odd
        ([1.0, 1.005, 1.01, 1.015, 1.02], 0)
    """

    def __init__(self, period, latest=_INFINITE):
        self.period = period
        self.latest = latest
        self.begun = False
        self.last = 0.0
        self.offset = 0.0
        self.odd = 0
        self.jumped = 0.0
        self.late = 0
        self.error = 0.0

    def time_of(self, reported):
        """A tick's time in s, after the last one's, by the `reported` time in s."""
        finite = math.isfinite(reported)
        if not self.begun:
            self.begun = True
            self.last = reported if finite and 0.0 <= reported <= self.latest else 0.0
            self.offset = self.last - reported if finite else _NONE
            return self.last
        expected = self.last + self.period
        error = reported + self.offset - expected
        self.jumped = 0.0
        self.late = 0
        if error > self.error:
            late = error - self.error
            self.late = round((late if late < _STALLED else _STALLED) / self.period)
        self.error = 0.0
        if math.fabs(error) <= _NEAR * self.period:
            self.odd = 0
            self.last = reported + self.offset
            return self.last
        if not finite:
            self.odd += 1
        elif math.fabs(error) <= _FOLLOWED:
            self.odd = 0
            most = _MOST_DRAWN * self.period
            drawn = _DRAWN * error
            expected += -most if drawn < -most else most if drawn > most else drawn
            self.error = error
        else:
            self.odd += 1
            self.jumped = error
            self.offset = expected - reported
        self.last = expected
        return expected
