"""What a live source hands on: readings, faults of what was no reading, and silence."""

from typing import NamedTuple

from plantar.common.sides import Side
from plantar.sensing.reading import Reading


class Fault(NamedTuple):
    """Something that arrived and is not a reading, or that happened to the device.

    Attributes:
        kind: What it is counted as: one of `plantar.live.fault_log.KINDS`, or a name of the source's own.
        text: What was wrong and what is allowed, in a line.
    """

    kind: str
    text: str


Arrival = tuple[Side, Reading] | Fault | None
"""A side and its reading, or a fault, or None where nothing arrived for a while."""


class LiveReading(NamedTuple):
    """A checked reading; `late` if later ones of its sole came before it."""

    side: Side
    reading: Reading
    late: bool = False


class LiveEvent(NamedTuple):
    """What happened to a stream at a `time` in s of its readings, in a line."""

    time: float
    text: str


class Silence(NamedTuple):
    """`seconds` since something arrived."""

    seconds: float


LiveItem = LiveReading | LiveEvent | Silence
"""What a checked stream consists of."""
