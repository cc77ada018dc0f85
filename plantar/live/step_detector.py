"""Heel strikes and toe offs of one foot as its readings come, with the time until each is known."""

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import Kind
from plantar.sensing.reading import Reading

_STRIKE = 0.05  # of the range from rest to peak: `plantar.gait.analysis` puts events there, too
_CONTACT = 0.10  # of it, which a heel strike has to reach to count
_LIGHT = 0.13  # of it, and the s after that by which a toe off lies at the latest: a slow walker's shoe presses on
_AFTER_LIGHT = 0.009
_NOISE = 4.0  # standard deviations that a level lies above rest
_CONTACT_NOISE = 8.0
_LEAST_PEAK = 20.0  # N that a foot has to reach: what lies below is no step
_FORGOTTEN = 8.0  # s after which half of a peak is forgotten
_SHORTEST_SWING = 0.10  # s off the ground, below which a contact goes on
_FOLLOWED = 50  # readings over which rest and noise are followed


def load_of(sole: SoleLayout, reading: Reading) -> float:
    """Vertical force in N on all taxels that measure, those beyond their range included; NaN where none does."""
    force = reading.force * sole.rotations[:, 2, 2]
    return float(np.nansum(force)) if np.isfinite(force).any() else math.nan


class StepEvent(NamedTuple):
    """A heel strike or toe off, named by `kind`, at a `time` in s that was known `delay` in s later."""

    kind: str
    time: float
    delay: float


class StepDetector:
    """Contacts of one foot by its vertical force; nothing but what has come is used.

    A heel strike lies where the force rises through 5 % of the range from rest to peak, and is known when 10 % are
    reached. A toe off lies where it falls through 5 %, of an insole at most 9 ms after 13 %, and is known 0.1 s
    later: until then the foot may be set on again. `kind`: what measures.

    Attribute `loaded`: whether the foot carries.

    Example:
        >>> import math
        >>> detector, events = StepDetector(), []
        >>> for k in range(300):  # two steps of 0.6 s
        ...     events += detector.take(0.01 * k, max(0.0, 700.0 * math.sin(k * math.pi / 60.0)))
        >>> [(event.kind, round(event.time, 2)) for event in events]
        [('strike', 0.0), ('off', 0.59), ('strike', 1.21), ('off', 1.79), ('strike', 2.41)]
    """

    def __init__(self, kind: Kind = "robot") -> None:
        self._presses_on = kind == "insole"
        self.loaded = False
        self._peak = 0.0
        self._rest = 0.0
        self._spread = 0.0
        self._last: tuple[float, float] | None = None
        self._rose: float | None = None
        self._fell: float | None = None
        self._light: float | None = None
        self._rests: deque[float] = deque(maxlen=_FOLLOWED)

    def take(self, time: float, force: float) -> list[StepEvent]:
        """Events that a `force` in N at a `time` in s settles; none where the force is NaN."""
        if force != force or (self._last is not None and time <= self._last[0]):
            return []
        before = self._last or (time, self._rest)
        self._last = (time, force)
        self._peak = max(force, self._rest + (self._peak - self._rest) * 0.5 ** ((time - before[0]) / _FORGOTTEN))
        span = self._peak - self._rest
        level = self._rest + max(_STRIKE * span, _NOISE * self._spread)
        events: list[StepEvent] = []
        if self.loaded:
            self._while_loaded(before, time, force, level, events)
        else:
            self._while_lifted(before, time, force, level, span, events)
        return events

    def _while_loaded(
        self, before: tuple[float, float], time: float, force: float, level: float, events: list[StepEvent]
    ) -> None:
        light = self._rest + _LIGHT * (self._peak - self._rest)
        if force >= light:
            self._light = None
        elif self._light is None:
            self._light = _crossing(before, time, force, light)
        if force >= level:
            self._fell = None
        elif self._fell is None:
            self._fell = _crossing(before, time, force, level)
        if self._fell is not None and time - self._fell >= _SHORTEST_SWING:
            off = self._fell
            if self._presses_on and self._light is not None:
                off = min(off, self._light + _AFTER_LIGHT)
            events.append(StepEvent("off", off, time - off))
            self.loaded = False
            self._light = None
            self._fell = None
            self._rose = None

    def _while_lifted(
        self, before: tuple[float, float], time: float, force: float, level: float, span: float, events: list[StepEvent]
    ) -> None:
        if force < level:
            self._rose = None
            self._rests.append(force)
            if len(self._rests) == _FOLLOWED:
                self._rest = sum(self._rests) / _FOLLOWED
                self._spread = (sum((value - self._rest) ** 2 for value in self._rests) / _FOLLOWED) ** 0.5
            return
        if self._rose is None:
            self._rose = _crossing(before, time, force, level)
        contact = self._rest + max(_CONTACT * span, _CONTACT_NOISE * self._spread, _STRIKE * _LEAST_PEAK)
        if force >= contact and self._peak >= _LEAST_PEAK:
            events.append(StepEvent("strike", self._rose, time - self._rose))
            self.loaded = True


def _crossing(before: tuple[float, float], time: float, force: float, level: float) -> float:
    """Time in s at which the force between two readings is at a level."""
    step = force - before[1]
    share = 1.0 if step == 0.0 else (level - before[1]) / step
    return before[0] + min(max(share, 0.0), 1.0) * (time - before[0])
