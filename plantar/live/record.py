"""Record a live stream, and show what comes."""

import math
import os
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.live.arrival import LiveEvent, LiveItem, LiveReading, Silence
from plantar.live.checked_stream import CheckedStream
from plantar.live.sink import Send
from plantar.live.step_detector import load_of
from plantar.percepts.percept import Percept
from plantar.recordings.foxglove import log_message
from plantar.recordings.recorder import Recorder
from plantar.sensing.reading import Reading

Show = Callable[[float, str], object]
"""Receives the share of the recording's time that has passed, and a line."""

SHOWN = 0.2
"""Time in s between two lines of what comes."""

_GAP = 2.5  # mean steps, above which a step does not count for the rate
_FIRST = 5  # steps that do


def record(
    stream: CheckedStream,
    path: str | os.PathLike[str],
    seconds: float = math.inf,
    show: Show | None = None,
    sinks: Sequence[Send] = (),
) -> dict[str, Any]:
    """Record forces from the first reading's time on into a file that reads up to its last half second at any time,
    until the stream ends, `seconds` have passed, or Ctrl-C.

    `stream` from `plantar.live.open_live`; `path`: the MCAP recording, replaced once a reading has come; `seconds`:
    above 0; `show`: receives load and center of pressure of each sole; `sinks`: receive the readings.
    Returns `seconds` recorded; the `frames`, `rate_hz` and largest gap `gap_max_s` of each of the `feet`; the number of
    each kind of `faults`; and the difference of `clocks`, None if unknown. InputError if no reading came.
    """
    stopped = False
    with LiveRecording(stream, path, seconds, sinks) as recording:
        try:
            _follow(stream, recording, show)
        except KeyboardInterrupt:
            stopped = True  # the usual end of a recording
    if recording.begun:
        return recording.summary()
    if stopped:
        raise KeyboardInterrupt
    came = ", ".join(f"{kind} {count}" for kind, count in stream.faults.items() if count)
    raise InputError(f"no reading came from the source{f' ({came})' if came else ''}")


def _follow(stream: CheckedStream, recording: "LiveRecording", show: Show | None) -> None:
    shown = -math.inf
    for item in stream.items:
        if not recording.put(item):
            return
        if show is not None and (isinstance(item, Silence) or recording.latest >= shown + SHOWN):
            show(recording.share, recording.text(item))
            shown = recording.latest


class LiveRecording:
    """A recording of a stream up to a time of `seconds`, begun by its first reading; a context manager.

    Attributes: `begun`: whether a reading has come; `latest`: time in s that is recorded. InputError if `seconds` is
    not above 0.
    """

    def __init__(
        self, stream: CheckedStream, path: str | os.PathLike[str], seconds: float, sinks: Sequence[Send] = ()
    ) -> None:
        if not seconds > 0.0:
            raise InputError(f"cannot record {seconds} s; allowed: above 0")
        self.seconds = seconds
        self.begun = False
        self.latest = 0.0
        self._stream = stream
        self._path = path
        self._sinks = sinks
        self._opened = time.monotonic()
        self._start = 0.0
        self._early = 0
        self._feet = {side: _Foot() for side in stream.soles}
        self._events: list[LiveEvent] = []  # from before the first reading
        self._open = ExitStack()

    def __enter__(self) -> "LiveRecording":
        return self

    def __exit__(self, *error: object) -> None:
        with self._open:
            for item in self._stream.remaining():
                self.put(item)
            if self.begun:
                self._recorder.note(live=self._about())

    @property
    def share(self) -> float:
        """Share of its time that is recorded."""
        return min(1.0, self.latest / self.seconds)

    def put(self, item: LiveItem) -> bool:
        """Record an item, and send readings on; returns whether the recording goes on."""
        if isinstance(item, LiveReading):
            return self._take(item)
        if isinstance(item, LiveEvent):
            self._report(item)
            return True
        passed = self.latest + item.seconds if self.begun else time.monotonic() - self._opened
        return passed <= self.seconds

    def _take(self, item: LiveReading) -> bool:
        if not self.begun:
            self._begin(item.reading.time)
        now = item.reading.time - self._start
        if now > self.seconds:
            return False
        if now < 0.0:
            self._early += 1
            return True
        self._skins[item.side].write(now, item.reading.force)
        self._feet[item.side].take(now, item)
        self.latest = max(self.latest, now)
        for send in self._sinks:
            send(item.side, item.reading)
        return True

    def _report(self, event: LiveEvent) -> None:
        if not self.begun:
            self._events.append(event)
            return
        now = max(0.0, event.time - self._start)
        self._log.write(now, log_message(now, event.text, "warning", "live"))

    def text(self, item: object) -> str:
        """What came last of each sole, and the number of faults, in a line."""
        if isinstance(item, Silence):
            return f"{self.latest:.1f} s  nothing received for {item.seconds:.1f} s"
        soles = [foot.text(side, self._stream) for side, foot in self._feet.items() if foot.last is not None]
        faults = sum(self._stream.faults.values())
        return "  ".join([f"{self.latest:.1f} s", *soles, *([f"faults: {faults}"] if faults else [])])

    def summary(self) -> dict[str, Any]:
        """What was recorded, as `record` returns it."""
        feet = {side: foot.summary() for side, foot in self._feet.items() if foot.frames}
        return {"seconds": round(self.latest, 3), "feet": feet, **self._about()}

    def _begin(self, start: float) -> None:
        soles = {str(side): sole for side, sole in self._stream.soles.items()}
        metadata = {"source": "live", "kind": self._stream.kind, "unit": self._stream.unit}
        self._recorder = self._open.enter_context(Recorder(self._path, metadata, soles))
        self._skins = {
            side: self._recorder.channel(f"/skin/{side}", [("force", len(sole))])
            for side, sole in self._stream.soles.items()
        }
        self._log = self._recorder.message_channel("/log", "foxglove.Log")
        self._start = start
        self.begun = True
        for event in self._events:
            self._report(event)
        self._events = []

    def _about(self) -> dict[str, Any]:
        clocks = self._stream.clocks
        known = (
            None
            if clocks is None
            else {
                "right_minus_left_s": round(clocks.offset, 4),
                "rate_ppm": None if clocks.rate_ppm is None else round(clocks.rate_ppm, 1),
                "rate_error_ppm": None if clocks.rate_error_ppm is None else round(clocks.rate_error_ppm, 1),
                "corrected": self._stream.correct,
            }
        )
        return {"faults": {**self._stream.faults, "before_start": self._early}, "clocks": known}


class _Foot:
    """Counts of one sole's readings."""

    def __init__(self) -> None:
        self.frames = 0
        self.last: Reading | None = None
        self._time = 0.0
        self._steps = 0
        self._passed = 0.0
        self._gap = 0.0

    def take(self, now: float, item: LiveReading) -> None:
        self.frames += 1
        if item.late:
            self._steps += 1  # within a step that was counted as one
            return
        if self.last is not None:
            step = now - self._time
            self._gap = max(self._gap, step)
            if self._steps < _FIRST or step * self._steps <= _GAP * self._passed:
                self._steps += 1
                self._passed += step
        self._time = now
        self.last = item.reading

    def text(self, side: Side, stream: CheckedStream) -> str:
        if self.last is None:
            return ""
        percept = Percept(stream.soles[side], self.last)
        place = percept.position_cop_in_sole
        load = f"{side} {load_of(stream.soles[side], self.last):.0f} {stream.unit}"
        return load if place is None else f"{load} at {round(1e3 * place[0])}, {round(1e3 * place[1])} mm"

    def summary(self) -> dict[str, float | None]:
        known = self._steps > 0 and self._passed > 0.0
        return {
            "frames": self.frames,
            "rate_hz": round(self._steps / self._passed, 3) if known else None,
            "gap_max_s": round(self._gap, 4) if known else None,
        }
