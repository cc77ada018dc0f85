"""Ctrl-C and SIGTERM in a sweep: while rows come they are a note that is read between two rows, not an exception."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["StopNote", "SweepStopped", "stop_noted"]

_NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM"}


class SweepStopped(KeyboardInterrupt):
    """A signal ended a sweep; what it had is kept.

    Args:
        number: The signal.
        kept: What was kept, in words.
    """

    def __init__(self, number: int, kept: str = "no run was begun") -> None:
        super().__init__(f"stopped by {_NAMES.get(signal.Signals(number), number)}: {kept}")
        self.number = number


class StopNote:
    """Which signal asked for a stop. Later ones are ignored: the sweep is already stopping.

    Attributes:
        number: The first signal, or 0 as long as none came.
    """

    def __init__(self) -> None:
        self.number = 0
        self._held = False

    @contextmanager
    def held(self) -> Iterator[None]:
        """Let a signal only be noted; it is raised at the end of this."""
        self._held = True
        try:
            yield
        finally:
            self._held = False
        self.check()

    def check(self) -> None:
        """Raise SweepStopped if a signal came."""
        if self.number:
            raise SweepStopped(self.number)

    def take(self, number: int, frame: Any) -> None:
        """Handle a signal.

        Args:
            number: Number of the signal.
            frame: Where it came, which is not looked at.
        """
        if not self.number:
            self.number = number
            if not self._held:
                self.check()


@contextmanager
def stop_noted() -> Iterator[StopNote]:
    """Handle both signals as long as this lasts. Threads other than the main one cannot, and are left alone."""
    note = StopNote()
    before = {}
    if threading.current_thread() is threading.main_thread():
        # Who ignores a signal (nohup, a shell's background) goes on ignoring it.
        before = {n: signal.getsignal(n) for n in _NAMES if signal.getsignal(n) not in (signal.SIG_IGN, None)}
    try:
        for number in before:
            signal.signal(number, note.take)
        yield note
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
