"""Two soles' clocks compared by when their readings arrive: offset, and difference of rate.

A reading that has the time t arrives at t - (offset of its clock) + (delay of its way), and the least delay of many is
nearly the same from second to second. So the least `arrival - t` of each second gives the difference of the clocks, up
to that of the two ways' least delays, which packets do not show. A line is fitted through the seconds' differences.
"""

import math
from typing import NamedTuple

from plantar.common.sides import SIDES, Side

_SPAN = 1.0  # s of arrival that are compared at a time
_FEWEST = 10  # readings of each sole
_MOST = 500  # readings of each sole, which end a comparison before its time: of a file at full speed
_UNEVEN = 4  # times as many readings of one sole as of the other are not compared
_RATED = 10.0  # s that must be compared for a rate


class ClockDifference(NamedTuple):
    """How the right sole's clock differs from the left one's.

    Attributes:
        offset: Right minus left in s, at the last comparison.
        rate_ppm: Parts per million by which the right clock is faster, None before 10 s.
        rate_error_ppm: Its standard error.
    """

    offset: float
    rate_ppm: float | None
    rate_error_ppm: float | None


class _Least:
    def __init__(self) -> None:
        self.count = 0
        self.delay = math.inf
        self.time = 0.0

    def take(self, time: float, delay: float) -> None:
        self.count += 1
        if delay <= self.delay:
            self.delay = delay
            self.time = time


class ClockPair:
    """Difference of two soles' clocks, from readings as they come.

    Example:
        >>> pair = ClockPair()
        >>> for k in range(400):
        ...     _ = pair.take("left", 0.01 * k, 100.0 + 0.01 * k), pair.take("right", 0.01 * k + 0.3, 100.0 + 0.01 * k)
        >>> round(pair.difference().offset, 6)
        0.3
    """

    def __init__(self) -> None:
        self._since = math.nan
        self._least: dict[Side, _Least] = {}
        self.reset()

    def reset(self) -> None:
        """Forget all: a clock was set."""
        self._points = 0
        self._origin = (0.0, 0.0)
        self._sums = [0.0] * 5  # x, y, xx, xy, yy from the first point on
        self._end = 0.0
        self._last = 0.0
        self._begin_span(math.nan)

    def take(self, side: Side, time: float, arrival: float) -> bool:
        """Take the `time` in s of a reading of a `side` at its `arrival` in s. Returns whether a comparison ended."""
        if math.isnan(self._since):
            self._since = arrival
        self._least[side].take(time, arrival - time)
        left, right = (self._least[one].count for one in SIDES)
        fewer = min(left, right)
        if fewer < _MOST and (fewer < _FEWEST or arrival < self._since + _SPAN):
            if max(left, right) > 2 * _MOST * _UNEVEN:
                self._begin_span(arrival)
            return False
        return self._compare(arrival, max(left, right) <= _UNEVEN * fewer)

    def end(self) -> None:
        """Compare what has come of the last second, where nothing was compared yet."""
        left, right = (self._least[one].count for one in SIDES)
        if not self._points and min(left, right) >= _FEWEST and max(left, right) <= _UNEVEN * min(left, right):
            self._compare(self._since, True)

    def difference(self) -> ClockDifference | None:
        """Difference at the last comparison; None before the first."""
        if not self._points:
            return None
        count = self._points
        x, y, xx, xy, yy = self._sums
        mean = self._origin[1] + y / count
        spread = xx - x * x / count
        if count < 3 or self._end < _RATED:
            return ClockDifference(self._last, None, None)
        rate = (xy - x * y / count) / spread
        left = max(0.0, yy - y * y / count - rate * (xy - x * y / count))
        error = math.sqrt(left / (count - 2) / spread)
        return ClockDifference(mean + rate * (self._end - x / count), 1e6 * rate, 1e6 * error)

    def offset_at(self, time: float) -> float:
        """Right minus left in s at a right sole's `time` in s; 0 before the first comparison."""
        found = self.difference()
        if found is None:
            return 0.0
        ahead = time - self._origin[0] - self._end
        return found.offset + 1e-6 * (found.rate_ppm or 0.0) * ahead

    def _begin_span(self, arrival: float) -> None:
        self._since = arrival
        self._least = {side: _Least() for side in SIDES}

    def _compare(self, arrival: float, even: bool) -> bool:
        left, right = (self._least[side] for side in SIDES)
        if even:
            if not self._points:
                self._origin = (right.time, left.delay - right.delay)
            x = right.time - self._origin[0]
            y = left.delay - right.delay - self._origin[1]
            for k, term in enumerate((x, y, x * x, x * y, y * y)):
                self._sums[k] += term
            self._points += 1
            self._end = x
            self._last = left.delay - right.delay
        self._begin_span(arrival)
        return even
