"""Ctrl-C and SIGTERM in a sweep: noted while rows come, and read between two rows."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["StopNote", "SweepStopped", "stop_noted"]

_NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM"}


class SweepStopped(KeyboardInterrupt):
    """The signal `number` ended a sweep; `kept` names in words what is kept."""

    def __init__(self, number: int, kept: str = "no run was begun") -> None:
        super().__init__(f"stopped by {_NAMES.get(signal.Signals(number), number)}: {kept}")
        self.number = number


class StopNote:
    """The first signal that asked for a stop, or 0."""

    def __init__(self) -> None:
        self.number = 0
        self._held = False

    @contextmanager
    def held(self) -> Iterator[None]:
        """Only note a signal during this; it is raised at the end."""
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
        """Handle the signal `number`; the `frame` is not used."""
        if not self.number:
            self.number = number
            if not self._held:
                self.check()


@contextmanager
def stop_noted() -> Iterator[StopNote]:
    """Handle both signals during this, in the main thread; others cannot."""
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
