"""Times of one sole's readings, in order: repeats, late readings, restarts and gaps told apart as they come."""

from bisect import bisect_left
from collections import deque
from collections.abc import Callable
from statistics import median
from typing import NamedTuple

import numpy as np

from plantar.common.sides import Side
from plantar.sensing.reading import Reading

_GAP = 2.5  # usual steps
_HOLE = 1.5  # usual steps between two readings where one is missing
_PAUSE = (0.5, 20.0)  # s, or usual steps, that a clock may go ahead at once of what has passed
_SLOWEST = 60.0  # s between readings while their usual step is not known
_CONFIRMED = 3  # readings in order that make a step in time a clock that was set
_KEPT = 64  # readings among which a late one finds its place
_STEPS = 31  # of which the median is the usual one
_RENEWED = 16  # readings after which the usual step is found again
_FEWEST = 5  # steps
_FARTHEST = 1e8  # s by which recorded times may go ahead of what has passed
_SAME = 0.5  # s within which the other sole's clock fits


class Timed(NamedTuple):
    """A reading with its `time` in s on the stream's clock; `late` if later ones came before it."""

    time: float
    reading: Reading
    late: bool = False


class SoleTimeline:
    """Places readings of one sole on a clock that goes on: its own first clock, from restart to restart.

    `note`: receives the kind and text of faults. Attributes: `offset`: what is added to the device's time in s;
    `latest`: last time in s of the stream's clock, None before the first reading; `arrival`: when that came, in s.
    """

    def __init__(self, side: Side, note: Callable[[str, str], None], strict: bool = False) -> None:
        self.side = side
        self.offset = 0.0
        self.latest: float | None = None
        self.arrival = 0.0
        self.usual: float | None = None
        self.epoch = 0
        self._note = note
        self._strict = strict
        self._last = 0.0  # device's time
        self._begun = (0.0, 0.0)  # stream's time and arrival of the first reading
        self._epoch_begun = (0.0, 0.0)
        self._steps: deque[float] = deque(maxlen=_STEPS)
        self._since_renewed = 0
        self._recent: deque[tuple[float, Reading]] = deque(maxlen=_KEPT)
        self._waiting: list[tuple[Reading, float]] = []

    def begin(self, reading: Reading, arrival: float, offset: float) -> Timed:
        """Returns the first reading, whose time goes on by `offset`; `arrival` in s."""
        self.offset = offset
        self._begun = (reading.time + offset, arrival)
        self._epoch_begun = (reading.time, arrival)
        return self._placed(reading, arrival)

    def take(self, reading: Reading, arrival: float, other: "SoleTimeline | None") -> list[Timed]:
        """Returns what a `reading` settles, none to several; `arrival` in s; `other`: the other sole's clock."""
        at = reading.time
        step = at - self._last
        if step > 0.0 and (self._strict or step <= self._reach(arrival)):
            if self._waiting:
                self._drop_waiting()
            return [self._went_on(reading, arrival, step)]
        if step <= 0.0:
            if self._strict:
                self._note("late", self._disorder(at))
            if self._repeats(reading):
                self._note("repeated", f"the {self.side} sole sent its reading of {at:.13g} s again")
                return []
            if step == 0.0 and not self._waiting:
                self._note("same_time", f"the {self.side} sole sent other forces at {at:.13g} s again")
                return [Timed(at + self.offset, reading)]
            if self._fits(at):
                self._note("late", self._disorder(at))
                self._recent.append((at, reading))
                return [Timed(at + self.offset, reading, late=True)]
        return self._wait(reading, arrival, other)

    @property
    def begin_time(self) -> float:
        """Time in s of the first reading, on the stream's clock."""
        return self._begun[0]

    def end(self) -> None:
        """Give up readings whose place was not yet settled."""
        self._drop_waiting()

    def _disorder(self, at: float) -> str:
        before = f"the {self.side} sole got {at:.13g} s after {self._last:.13g} s"
        return f"{before}; allowed: times that go on, of both soles by one clock"

    def _reach(self, arrival: float) -> float:
        """Step in s that is believed at once."""
        passed = arrival - self.arrival
        if self.usual is None:
            return passed + _SLOWEST
        believed = passed + max(_PAUSE[0], _PAUSE[1] * self.usual)
        begun, begun_arrival = self._begun
        left = begun + arrival - begun_arrival + _FARTHEST - (self._last + self.offset)
        return min(believed, left)

    def _went_on(self, reading: Reading, arrival: float, step: float) -> Timed:
        if self.usual is not None and step > _GAP * self.usual:
            self._note("gap", f"no reading of the {self.side} sole for {step:.4g} s before {reading.time:.13g} s")
        self._steps.append(step)
        self._since_renewed += 1
        if self._since_renewed >= (_FEWEST if self.usual is None else _RENEWED):
            self._since_renewed = 0
            self.usual = min(median(self._steps), _SLOWEST)
        return self._placed(reading, arrival)

    def _placed(self, reading: Reading, arrival: float) -> Timed:
        self._last = reading.time
        self.latest = reading.time + self.offset
        self.arrival = arrival
        self._recent.append((reading.time, reading))
        return Timed(self.latest, reading)

    def _repeats(self, reading: Reading) -> bool:
        return any(
            at == reading.time and np.array_equal(known.force, reading.force, equal_nan=True)
            for at, known in self._recent
        )

    def _fits(self, at: float) -> bool:
        """Whether a reading is missing at a device's time."""
        times = sorted(time for time, _ in self._recent)
        place = bisect_left(times, at)
        if self.usual is None or not 0 < place < len(times) or times[place] == at:
            return False
        return times[place] - times[place - 1] > _HOLE * self.usual

    def _wait(self, reading: Reading, arrival: float, other: "SoleTimeline | None") -> list[Timed]:
        if self._waiting:
            step = reading.time - self._waiting[-1][0].time
            most = _SLOWEST if self.usual is None else max(_PAUSE[0], _PAUSE[1] * self.usual)
            if not 0.0 < step <= most:
                self._drop_waiting()
        self._waiting.append((reading, arrival))
        if len(self._waiting) < _CONFIRMED:
            return []
        first, came = self._waiting[0]
        if first.time > self._last and self._is_gap(first.time, came):
            self._note("gap", f"no reading of the {self.side} sole for {first.time - self._last:.4g} s")
        else:
            self._start_again(first, came, other)
        waiting = self._waiting
        self._waiting = []
        return [self._placed(known, when) for known, when in waiting]

    def _is_gap(self, at: float, arrival: float) -> bool:
        """Whether a clock that went ahead was not set: its readings come faster than they were measured."""
        began, began_arrival = self._epoch_begun
        paced = self.arrival - began_arrival > 0.5 * (self._last - began)
        begun, begun_arrival = self._begun
        return not paced and at + self.offset - begun < arrival - begun_arrival + _FARTHEST

    def _start_again(self, first: Reading, arrival: float, other: "SoleTimeline | None") -> None:
        latest = self._last + self.offset
        expected = latest + max(arrival - self.arrival, self.usual or 1e-3)
        offset = expected - first.time
        if other is not None and other.latest is not None:
            shared = first.time + other.offset
            if shared > latest and abs(shared - expected) < _SAME:
                offset = other.offset  # both soles of one device began again
        self._note(
            "restart",
            f"the {self.side} sole's clock went from {self._last:.13g} s to {first.time:.13g} s; it goes on at "
            f"{first.time + offset:.13g} s",
        )
        self.offset = offset
        self.epoch += 1
        self.usual = None
        self._steps.clear()
        self._since_renewed = 0
        self._recent.clear()
        self._epoch_begun = (first.time, arrival)

    def _drop_waiting(self) -> None:
        for reading, _ in self._waiting:
            self._note("out_of_place", self._disorder(reading.time))
        self._waiting = []
