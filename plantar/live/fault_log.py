"""Faults of a stream: counted by kind, and reported as events of which a flood leaves one a second."""

from plantar.errors import InputError
from plantar.live.arrival import LiveEvent

KINDS = {
    "garbled": "lines without a side, a time and a force of each taxel",
    "blank": "empty lines",
    "cut": "lines without their end",
    "stranger": "readings of a second sender of the same sole",
    "impossible": "readings with a time or forces that cannot be; such forces count as missing",
    "repeated": "readings that came twice",
    "same_time": "readings with the time of the one before, and other forces",
    "late": "readings that came after later ones; recorded at their own time",
    "out_of_place": "single readings far from the times around them, left out",
    "restart": "clocks that began again, or were set; times go on from the one before",
    "gap": "pauses of more than 2.5 usual steps",
    "two_clocks": "soles whose clocks are too far apart for one recording; put together by when they arrive",
    "lost": "devices that went away and were opened again",
}
"""Kinds of faults and what is counted."""

ALLOWED_IN_STRICT = ("gap", "cut", "stranger")
"""Kinds that do not end a strict stream."""

_EACH = 10  # faults of a kind that are reported one by one
_APART = 1.0  # s between later reports of a kind


class FaultLog:
    """Counts faults, and gathers events.

    `strict`: InputError at the first fault of a kind that is not in ALLOWED_IN_STRICT. Attribute `counts`: number by
    kind.

    Example:
        >>> log = FaultLog()
        >>> for k in range(100):
        ...     log.note(0.01 * k, "blank", f"line {k} is empty")
        >>> log.counts["blank"], len(log.taken())
        (100, 10)
        >>> log.end(1.0)
        >>> log.taken()
        [LiveEvent(time=1.0, text='blank: 90 more')]
    """

    def __init__(self, strict: bool = False) -> None:
        self.counts = dict.fromkeys(KINDS, 0)
        self._strict = strict
        self._events: list[LiveEvent] = []
        self._reported: dict[str, float] = {}
        self._unreported: dict[str, int] = {}

    def __bool__(self) -> bool:
        return bool(self._events)

    def note(self, time: float, kind: str, text: str) -> None:
        """Count a fault of a `kind` at a `time` in s; InputError with its `text` if strict."""
        if self._strict and kind not in ALLOWED_IN_STRICT:
            raise InputError(text)
        count = self.counts.get(kind, 0) + 1
        self.counts[kind] = count
        if count > _EACH and time < self._reported[kind] + _APART:
            self._unreported[kind] = self._unreported.get(kind, 0) + 1
            return
        self._reported[kind] = time
        more = self._unreported.pop(kind, 0)
        before = f" ({more} more before)" if more else ""
        self._events.append(LiveEvent(time, f"{kind}: {text}{before}"))

    def report(self, time: float, text: str) -> None:
        """Gather an event that is no fault."""
        self._events.append(LiveEvent(time, text))

    def taken(self) -> list[LiveEvent]:
        """Events since the last call."""
        events = self._events
        self._events = []
        return events

    def end(self, time: float) -> None:
        """Gather what was counted and not reported."""
        for kind, more in self._unreported.items():
            self._events.append(LiveEvent(time, f"{kind}: {more} more"))
        self._unreported = {}
