"""A delay line."""

from collections import deque
from typing import Generic, TypeVar

from plantar.mechanics.same_time import SAME_TIME

T = TypeVar("T")


class Delay(Generic[T]):
    """Returns the newest item sent at least `delay` in s ago.

    Example:
        >>> line = Delay(0.01)
        >>> [line.passed(0.005 * k, k) for k in range(5)]
        [0, 0, 0, 1, 2]
    """

    def __init__(self, delay: float) -> None:
        self._delay = delay
        self._sent: deque[tuple[float, T]] = deque()

    def passed(self, time: float, item: T) -> T:
        """Send an `item` at `time` in s, never decreasing; returns the one that arrives."""
        self._sent.append((time, item))
        while len(self._sent) > 1 and self._sent[1][0] <= time - self._delay + SAME_TIME:
            self._sent.popleft()
        return self._sent[0][1]
