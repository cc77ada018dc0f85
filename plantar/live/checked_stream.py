"""A live stream that goes on: what is no reading is counted, times go on over restarts, clocks are compared."""

import time as clock
from collections.abc import Generator, Iterator, Mapping
from typing import get_args

import numpy as np

from plantar.common.arguments import instance
from plantar.common.sides import Side, other_side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault, LiveItem, LiveReading, Silence
from plantar.live.clock_pair import ClockDifference, ClockPair
from plantar.live.fault_log import FaultLog
from plantar.live.sole_timeline import SoleTimeline, Timed
from plantar.live.source import LiveStream, Unit, device_errors, in_newtons, opened_source
from plantar.recordings.pressure_recording import Kind
from plantar.sensing.reading import Reading

_MOST_FORCE = 1e5  # N that a taxel bears: a person's weight a hundred times
_LATEST = 1e10  # s: the year 2286
_EARLY = 1.0  # s by which the second sole's readings may lie before the first one's
_APART = 0.02  # s from which a difference of clocks is reported
_HELD = 3.0  # s for which readings wait for the clocks' difference, where it is corrected
_MOST_HELD = 4000
_SLEWED = 0.05  # of the time that passes, by which a correction changes


class CheckedStream:
    """Readings of a live stream in order of time for each sole; faulty input is counted and left out.

    Args:
        stream: What a source opened.
        strict: Raise InputError at the first fault other than a gap.
        correct: Put the right sole on the left one's clock, by the difference that their arrivals show.

    Attributes:
        soles: Layout of each side.
        kind: What measures.
        unit: Of the forces: "N" or "counts".
        correct: Whether clocks are corrected.

    Example:
        >>> from plantar import hex_layout
        >>> sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], side="left")
        >>> readings = [("left", Reading(0.01 * k, np.ones(len(sole)))) for k in (0, 1, 1, 2)]
        >>> stream = CheckedStream(LiveStream({"left": sole}, iter(readings)))
        >>> [reading.time for side, reading in stream.readings], stream.faults["repeated"]
        ([0.0, 0.01, 0.02], 1)
    """

    def __init__(self, stream: LiveStream, strict: bool = False, correct: bool = False) -> None:
        self.soles: Mapping[Side, SoleLayout] = stream.soles
        self.kind: Kind = stream.kind
        self.unit: Unit = stream.unit
        self._log = FaultLog(strict)
        self._strict = strict
        self.correct = correct and len(stream.soles) > 1
        self._source = stream.readings
        self._timelines = {side: SoleTimeline(side, self._note, strict) for side in stream.soles}
        self._pair = ClockPair()
        self._epochs = 0
        self._latest = 0.0
        self._stated = 0.0
        self._applied: float | None = None
        self._last_corrected = 0.0
        self._held: list[tuple[Side, Timed]] = []
        self._held_since = 0.0
        self._items = self._checked()

    @property
    def readings(self) -> Iterator[tuple[Side, Reading]]:
        """Yields a side and its reading, in order of time for each sole, until the source ends.

        InputError if the device fails, or, where the stream is strict, at a fault.
        """
        for item in self._items:
            if isinstance(item, LiveReading) and not item.late:
                yield item.side, item.reading

    @property
    def items(self) -> Iterator[LiveItem]:
        """Yields readings, late ones too, with events and silences between them; errors as of `readings`."""
        return self._items

    @property
    def faults(self) -> dict[str, int]:
        """Number of faults so far, by the kinds of `plantar.live.fault_log.KINDS`."""
        return dict(self._log.counts)

    @property
    def clocks(self) -> ClockDifference | None:
        """How the right sole's clock differs from the left one's; None where it is not known."""
        found = self._pair.difference()
        if found is None:
            return None
        left, right = (self._timelines[side].offset for side in ("left", "right"))
        return found._replace(offset=found.offset + left - right)

    def remaining(self) -> list[LiveItem]:
        """Readings that were held back, and events that were not reported yet, where the stream is left."""
        for timeline in self._timelines.values():
            timeline.end()
        self._pair.end()
        readings = list(self._release())
        self._state_clocks()
        self._log.end(self._latest)
        return [*readings, *self._log.taken()]

    def close(self) -> None:
        """Close the source."""
        self._items.close()
        if isinstance(self._source, Generator):
            self._source.close()

    def _note(self, kind: str, text: str) -> None:
        self._log.note(self._latest, kind, text)

    def _arrivals(self) -> Iterator[Arrival]:
        with device_errors("the source cannot be read"):
            yield from self._source

    def _checked(self) -> Generator[LiveItem, None, None]:
        came = clock.monotonic()
        for arrival in self._arrivals():
            now = clock.monotonic()
            if arrival is None:
                yield Silence(now - came)
                continue
            came = now
            if isinstance(arrival, Fault):
                self._note(*arrival)
            else:
                yield from self._take(*arrival, now)
            if self._log:
                yield from self._log.taken()
        yield from self.remaining()

    def _take(self, side: Side, given: Reading, now: float) -> Iterator[LiveReading]:
        reading = self._possible(side, instance(given, Reading, "reading"))
        if reading is None:
            return
        timeline = self._timelines[side]
        if timeline.latest is None:
            placed = [timeline.begin(reading, now, self._first_offset(side, reading, now))]
        else:
            placed = timeline.take(reading, now, self._timelines.get(other_side(side)))
        for timed in placed:
            if not timed.late:
                self._latest = max(self._latest, timed.time)
        if len(self._timelines) > 1 and placed:
            self._compare_clocks(side, placed[-1], now)
        if self.correct:
            yield from self._corrected(side, placed, now)
        else:
            for timed in placed:
                yield _read(side, timed, timed.time)

    def _possible(self, side: Side, reading: Reading) -> Reading | None:
        """A reading without forces that cannot be; None if it is none of a sole."""
        if side not in self.soles:
            self._note("garbled", f"a reading is of a sole {side!r}; allowed: {', '.join(self.soles)}")
            return None
        force = reading.force
        if len(force) != len(self.soles[side]):
            wanted = len(self.soles[side])
            self._note("garbled", f"a reading of the {side} sole holds {len(force)} forces; allowed: {wanted}")
            return None
        if not abs(reading.time) < _LATEST:
            self._note("impossible", f"the {side} sole has the time {reading.time:.6g} s; allowed: below {_LATEST:g} s")
            return None
        size = np.abs(force)
        if size.max() <= _MOST_FORCE:
            return reading
        wrong = size > _MOST_FORCE
        if not wrong.any():  # it holds missing forces, which are NaN
            return reading
        taxel = int(wrong.argmax())
        self._note(
            "impossible",
            f"the {side} sole has {force[taxel]:g} N on taxel {taxel} at {reading.time:.13g} s; "
            f"allowed: up to {_MOST_FORCE:g} N",
        )
        return _changed(reading, force=np.where(wrong, np.nan, force))

    def _first_offset(self, side: Side, reading: Reading, now: float) -> float:
        """What is added to the times of a sole that was not read before, in s."""
        other = self._timelines.get(other_side(side))
        if other is None or other.latest is None:
            self._latest = reading.time
            return 0.0
        expected = other.latest + now - other.arrival
        shared = reading.time + other.offset
        begin = other.begin_time - _EARLY
        if begin < shared <= expected + _EARLY:
            return other.offset
        if self._strict and shared > begin:
            return 0.0
        self._note(
            "two_clocks",
            f"the {side} sole got {reading.time:.13g} s after {other.latest:.13g} s of the {other.side} one; "
            "allowed: times that go on, of both soles by one clock",
        )
        return expected - reading.time

    def _compare_clocks(self, side: Side, timed: Timed, now: float) -> None:
        epochs = sum(timeline.epoch for timeline in self._timelines.values())
        if epochs != self._epochs:
            self._epochs = epochs
            self._pair.reset()
        if not timed.late and self._pair.take(side, timed.time, now):
            self._state_clocks()

    def _state_clocks(self) -> None:
        """Report the clocks' difference where it is not small, and where it changed."""
        found = self._pair.difference()
        if found is None or abs(found.offset - self._stated) < _APART:
            return
        self._stated = found.offset
        behind = "ahead of" if found.offset > 0.0 else "behind"
        done = "corrected" if self.correct else "not corrected"
        self._log.report(
            self._latest, f"clocks: the right sole's is {abs(found.offset):.3f} s {behind} the left one's; {done}"
        )

    def _corrected(self, side: Side, placed: list[Timed], now: float) -> Iterator[LiveReading]:
        if self._applied is None:
            self._held_since = self._held_since or now
            self._held += [(side, timed) for timed in placed]
            waited = now - self._held_since > _HELD or len(self._held) > _MOST_HELD
            if waited or self._pair.difference() is not None:
                yield from self._release()
            return
        for timed in placed:
            yield _read(side, timed, self._one_time(side, timed))

    def _release(self) -> Iterator[LiveReading]:
        if self.correct and self._applied is None:
            self._applied = self._pair.offset_at(self._latest)
        held = self._held
        self._held = []
        for side, timed in held:
            yield _read(side, timed, self._one_time(side, timed))

    def _one_time(self, side: Side, timed: Timed) -> float:
        if side == "left" or self._applied is None:
            return timed.time
        passed = timed.time - self._last_corrected
        if passed > 0.0:
            most = _SLEWED * min(passed, 1.0)
            change = self._pair.offset_at(timed.time) - self._applied
            self._applied += min(max(change, -most), most)
            self._last_corrected = timed.time
        return timed.time - self._applied


def _read(side: Side, timed: Timed, time: float) -> LiveReading:
    reading = timed.reading
    return LiveReading(side, reading if time == reading.time else _changed(reading, time=time), timed.late)


def _changed(reading: Reading, **fields: object) -> Reading:
    names = ("time", "force", "proximity", "temperature", "acceleration")
    return Reading(**{name: getattr(reading, name) for name in names} | fields)


def open_live(
    text: str,
    layout: SoleLayout | None = None,
    *,
    strict: bool = False,
    correct: bool = False,
    kind: str | None = None,
    counts: bool = False,
) -> CheckedStream:
    """Open a live source by its `text`, such as "serial:/dev/ttyUSB0" or "replay:run.mcap".

    Args:
        text: Name of the source, and its address after a colon; `plantar list sources` lists them.
        layout: Sole, mirrored for the other foot; None where the source has its own.
        strict: Raise InputError at the first fault other than a gap; else faults are counted.
        correct: Put the right sole on the left one's clock, where they differ.
        kind: What measures: "robot", "insole", "platform"; None: what the source states.
        counts: Its values are counts, which become forces by the layout's calibration.

    Returns:
        Stream, whose `readings` yields a side and its reading as they come.

    Raises:
        PlantarError: The source is unknown or cannot be opened.

    Example:
        >>> open_live("hearsay")
        Traceback (most recent call last):
        plantar.errors.InputError: unknown live source 'hearsay'; allowed: file, lines, packets, replay, serial, udp
    """
    stream = opened_source(text, layout)
    if counts:
        stream = in_newtons(stream)
    if kind is None:
        return CheckedStream(stream, strict, correct)
    known = next((one for one in get_args(Kind) if one == kind), None)
    if known is None:
        raise InputError(f"kind is {kind!r}; allowed: {', '.join(get_args(Kind))}")
    return CheckedStream(stream._replace(kind=known), strict, correct)
