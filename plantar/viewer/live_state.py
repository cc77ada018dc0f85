"""What the page of a stream shows: forces, CoP, polygon and load of each sole, and measures of its steps."""

import math
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.layouts.layout import SoleLayout
from plantar.live.source import Unit
from plantar.live.step_detector import StepDetector, load_of
from plantar.percepts.percept import Percept
from plantar.recordings.pressure_recording import Kind
from plantar.sensing.reading import Reading

_STEPS = 10  # in the means
_LINES = 30  # of the log
_CUT = 20.0  # N with which a stream begins within a contact
_WALKED = 3.0  # s between two heel strikes, above which the feet do not walk


class LiveState:
    """The latest of each sole, and measures of its last steps.

    Args:
        soles: Layout of each side.
        kind: What measures: "robot", "insole", "platform" or "plate".
        unit: Of the forces; counts give no measures of steps.

    Attributes:
        time: Of the latest reading in s.
        log: Lines, the latest first.

    Example:
        >>> import numpy as np
        >>> from plantar import hex_layout
        >>> sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], side="left")
        >>> state = LiveState({"left": sole})
        >>> state.take("left", Reading(0.5, np.full(len(sole), 10.0)))
        >>> state.as_dict()["soles"]["left"]["load"]
        420.0
    """

    def __init__(self, soles: Mapping[Side, SoleLayout], kind: Kind = "robot", unit: Unit = "N") -> None:
        self.time = 0.0
        self.log: deque[str] = deque(maxlen=_LINES)
        self._soles = {side: _Sole(layout, kind) for side, layout in soles.items()}
        self._strikes: deque[float] = deque(maxlen=_STEPS + 1)
        self._unit = unit
        self._rows: list[list[str]] | None = None  # of the measures, until a contact begins or ends

    def take(self, side: Side, reading: Reading) -> None:
        """Take a reading.

        Args:
            side: Of the sole.
            reading: Its forces.
        """
        self.time = max(self.time, reading.time) if reading.time > self.time - 1.0 else reading.time
        sole = self._soles[side]
        strikes, changed = sole.take(reading)
        if changed:
            self._rows = None
        for at in strikes:
            if self._strikes and not 0.0 < at - self._strikes[-1] < _WALKED:
                self._strikes.clear()
            self._strikes.append(at)

    def note(self, text: str) -> None:
        """Put a line on top of the log, with the time.

        Args:
            text: The line.
        """
        self.log.appendleft(f"{self.time:.2f} s  {text}")

    def as_dict(self) -> dict[str, Any]:
        """Plain values for the page: forces in 0.1 N, null if missing; places in m; texts of the measures."""
        if self._rows is None:
            self._rows = self._measures() if self._unit == "N" else []
        return {
            "time": round(self.time, 4),
            "soles": {side: sole.as_dict() for side, sole in self._soles.items() if sole.reading is not None},
            "measures": self._rows,
            "log": list(self.log),
        }

    def _measures(self) -> list[list[str]]:
        found = [self._soles.get(side) for side in SIDES]
        strikes = np.diff(self._strikes)
        cadence = f"{60.0 / float(np.mean(strikes)):.0f} steps/min" if len(strikes) > 1 else "-"
        rows = [["Steps", *("-" if sole is None else str(sole.steps) for sole in found)]]
        for name, unit, digits in (("Contact time", "s", 2), ("Peak force", "N", 0), ("Impulse", "N s", 0)):
            means = [None if sole is None else sole.mean(name) for sole in found]
            rows.append([name, *("-" if mean is None else f"{mean:.{digits}f} {unit}" for mean in means)])
            left, right = means
            if left is not None and right is not None and left + right > 0.0:
                rows.append([f"{name}, symmetry index", f"{200.0 * (left - right) / (left + right):+.1f} %", ""])
        return [*rows, ["Cadence", cadence, ""]]


class _Sole:
    """One sole's latest reading, and its last contacts."""

    def __init__(self, layout: SoleLayout, kind: Kind) -> None:
        self.layout = layout
        self.reading: Reading | None = None
        self.steps = 0
        self._detector = StepDetector(kind)
        self._began: float | None = None
        self._load = math.nan
        self._peak = 0.0
        self._impulse = 0.0
        self._whole = True  # whether the contact that begins is not cut by the stream's beginning
        self._means: dict[str, deque[float]] = {
            name: deque(maxlen=_STEPS) for name in ("Contact time", "Peak force", "Impulse")
        }

    def take(self, reading: Reading) -> tuple[list[float], bool]:
        """Heel strikes in s that a reading settles, and whether it settles anything."""
        load = load_of(self.layout, reading)
        self._load = load
        if self.reading is None:
            self._whole = not load > _CUT
        step = 0.0 if self.reading is None else max(0.0, reading.time - self.reading.time)
        self.reading = reading
        if self._detector.loaded and not math.isnan(load):
            self._peak = max(self._peak, load)
            self._impulse += load * step
        strikes = []
        events = self._detector.take(reading.time, load)
        for event in events:
            if event.kind == "strike":
                self._began = event.time if self._whole else None
                self._whole = True
                self._peak = load
                self._impulse = 0.5 * load * event.delay
                strikes.append(event.time)
            elif self._began is not None:
                self.steps += 1
                for name, value in (
                    ("Contact time", event.time - self._began),
                    ("Peak force", self._peak),
                    ("Impulse", self._impulse),
                ):
                    self._means[name].append(value)
        return strikes, bool(events)

    def mean(self, name: str) -> float | None:
        known = self._means[name]
        return sum(known) / len(known) if known else None

    def as_dict(self) -> dict[str, Any]:
        assert self.reading is not None
        percept = Percept(self.layout, self.reading)
        cop = percept.position_cop_in_sole
        tenths = np.round(10.0 * self.reading.force)
        return {
            "force": [None if value != value else int(value) for value in tenths.tolist()],
            "load": None if math.isnan(self._load) else round(self._load, 1),
            "cop": None if cop is None else [round(value, 4) for value in cop.tolist()],
            "polygon": percept.support_polygon_in_sole.round(4).tolist(),
        }
