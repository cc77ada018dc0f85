"""A stream that is recorded and shown on its page, with the page's buttons."""

import math
import os
import threading
import time
from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.live.arrival import LiveEvent, LiveItem, LiveReading, Silence
from plantar.live.checked_stream import CheckedStream
from plantar.live.record import SHOWN, LiveRecording, Show
from plantar.live.sink import Send
from plantar.sensing.reading import Reading
from plantar.viewer.live_page import LivePage
from plantar.viewer.live_state import LiveState

_ZEROED = 0.5  # s of readings that a zero is the mean of


def record_with_page(
    stream: CheckedStream,
    page: LivePage,
    path: str | os.PathLike[str],
    seconds: float = math.inf,
    show: Show | None = None,
    sinks: Sequence[Send] = (),
) -> dict[str, Any]:
    """Record a stream as `plantar.live.record.record` does, and show it on a `page`, whose buttons count.

    Zero takes what the soles read in the last half second off what follows, also in the recording; mark writes an
    event; record stops and goes on.

    Args:
        stream: From `plantar.live.open_live`.
        page: That is served.
        path: The MCAP recording, replaced once a reading has come.
        seconds: Above 0, after which it ends.
        show: Receives a share of the time and a line of load and center of pressure.
        sinks: Receive the readings.

    Returns:
        Seconds, frames and rate of each of the feet, faults and clocks, as `record`.

    Raises:
        InputError: If no reading was recorded.
    """
    with LiveRecording(stream, path, seconds, sinks) as recording:
        session = _Session(stream, page, recording, show)
        try:
            for item in stream.items:
                if not session.take(item):
                    break
        except KeyboardInterrupt:
            if not recording.begun:
                raise
        finally:
            page.send(session.shown())
    if recording.begun:
        return recording.summary()
    raise InputError("no reading came from the source, or none was recorded")


class _Session:
    def __init__(self, stream: CheckedStream, page: LivePage, recording: LiveRecording, show: Show | None) -> None:
        self._stream = stream
        self._page = page
        self._recording = recording
        self._show = show
        self._state = LiveState(stream.soles, stream.kind, stream.unit)
        self._records = True
        self._marks = 0
        self._arrived = 0.0
        self._silent = ""
        self._lock = threading.Lock()  # of state and log, which the page's threads read
        self._shown = -math.inf
        self._recent: dict[Side, deque[Reading]] = {side: deque() for side in stream.soles}
        self._zero: dict[Side, Any] = {}

    def take(self, item: LiveItem) -> bool:
        """Record and show an item; returns whether the recording goes on."""
        for action in self._page.actions():
            self._act(action)
        if isinstance(item, LiveReading):
            item = self._zeroed(item)
            if not item.late:
                with self._lock:
                    self._state.take(item.side, item.reading)
                    self._arrived = time.time()
        elif isinstance(item, LiveEvent):
            with self._lock:
                self._state.note(item.text)
        goes_on = self._recording.put(item) if self._records or not isinstance(item, LiveReading) else True
        self._silent = f", nothing received for {item.seconds:.1f} s" if isinstance(item, Silence) else ""
        self._page.send(self.shown)
        now = time.monotonic()
        if self._show is not None and now - self._shown >= SHOWN:
            self._shown = now
            self._show(self._recording.share, self._recording.text(item))
        return goes_on

    def shown(self) -> dict[str, Any]:
        """The present state, as the page shows it."""
        faults = sum(self._stream.faults.values())
        kept = f"{self._recording.latest:.1f} s recorded" if self._recording.begun else "not recorded"
        with self._lock:
            status = f"{self._state.time:.1f} s, {kept}, faults: {faults}{self._silent}"
            more = {"status": status, "recording": self._records, "arrived": round(1e3 * self._arrived)}
            return {**self._state.as_dict(), **more}

    def _act(self, action: str) -> None:
        if action == "zero":
            for side, recent in self._recent.items():
                if recent:
                    mean = np.mean([reading.force for reading in recent], axis=0)
                    self._zero[side] = np.nan_to_num(mean)
            self._note("zero: what the soles read is taken off")
        elif action == "mark":
            self._marks += 1
            self._note(f"mark {self._marks}")
        else:
            self._records = not self._records
            self._note("recording goes on" if self._records else "recording stopped")

    def _note(self, text: str) -> None:
        with self._lock:
            self._state.note(text)
        self._recording.put(LiveEvent(self._state.time, text))

    def _zeroed(self, item: LiveReading) -> LiveReading:
        recent = self._recent[item.side]
        if not item.late:
            recent.append(item.reading)
            while recent[0].time < item.reading.time - _ZEROED or recent[0].time > item.reading.time:
                recent.popleft()
        zero = self._zero.get(item.side)
        if zero is None:
            return item
        reading = item.reading
        force = np.maximum(reading.force - zero, 0.0)
        return item._replace(
            reading=Reading(reading.time, force, proximity=reading.proximity, temperature=reading.temperature)
        )
