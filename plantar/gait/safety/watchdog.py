"""Watchdog for late or missing ticks."""

import math
import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

from plantar.errors import InputError


class Watchdog:
    """Calls a function once when ticks stop, from a thread.

    Args:
        limit: In s without a tick.
        late: Called, such as power off; once until ticks return.

    Attributes:
        times: Number of stops.

    Raises:
        InputError: Limit not positive, finite.

    Example:
        >>> with Watchdog(10.0, lambda: None) as watchdog:
        ...     watchdog.beat()
        >>> watchdog.times
        0
    """

    def __init__(self, limit: float, late: Callable[[], object]) -> None:
        if not 0.0 < limit < math.inf:
            raise InputError(f"limit of the watchdog is {limit} s; allowed: more than 0")
        self._limit = limit
        self._late = late
        self._beat: float | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self.times = 0

    def beat(self) -> None:
        """A tick has come; the first starts the watch."""
        self._beat = time.monotonic()

    def _watch(self) -> None:
        called_for: float | None = None
        while not self._ended.wait(0.25 * self._limit):
            beat = self._beat
            if beat is not None and beat != called_for and time.monotonic() - beat > self._limit:
                called_for = beat
                self.times += 1
                self._late()

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._ended.set()
        self._thread.join()
