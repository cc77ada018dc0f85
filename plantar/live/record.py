"""Record a live source, and show what comes."""

import math
import os
from collections.abc import Callable, Iterator
from itertools import chain
from typing import Any

import numpy as np

from plantar.common.arguments import instance
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.live.source import LiveStream, device_errors
from plantar.percepts.percept import Percept
from plantar.recordings.recorder import Recorder
from plantar.sensing.reading import Reading

_SHOWN = 0.2  # s of the source's time between two lines of what comes
_EARLY = 1.0  # s by which the second sole's readings may lie before the first one


def record(
    stream: LiveStream,
    path: str | os.PathLike[str],
    seconds: float = math.inf,
    show: Callable[[float, str], object] | None = None,
) -> dict[str, Any]:
    """Record forces from the first reading's time on into a file that reads up to its last half second at any time,
    until the stream ends, `seconds` of it have passed, or Ctrl-C.

    `stream` from `plantar.live.source.open_live`; `path`: the MCAP recording, replaced once a reading has come;
    `seconds`: above 0; `show`: receives the share of `seconds`, and load and center of pressure of each sole as text.
    Returns `seconds` recorded, and the `frames`, `rate_hz` and largest gap `gap_max_s` of each of the `feet`.
    """
    if not seconds > 0.0:
        raise InputError(f"cannot record {seconds} s; allowed: above 0")
    readings = _readings(stream)
    if (first := next(readings, None)) is None:
        raise InputError("no reading came from the source")
    start = instance(first[1], Reading, "reading").time
    shown = -math.inf
    latest = 0.0
    times: dict[Side, list[float]] = {side: [] for side in stream.soles}
    seen: dict[Side, Reading] = {}
    with Recorder(
        path, {"source": "live", "kind": stream.kind}, {str(s): sole for s, sole in stream.soles.items()}
    ) as recorder:
        skins = {side: recorder.channel(f"/skin/{side}", [("force", len(s))]) for side, s in stream.soles.items()}
        try:
            for side, reading in chain([first], readings):
                if side not in times:
                    raise InputError(f"a reading is of a sole {side!r}; allowed: {', '.join(times)}")
                now = reading.time - start
                before = times[side]
                last = before[-1] if before else -_EARLY
                if now <= last:
                    raise InputError(
                        f"the {side} sole got {reading.time:.13g} s after {start + max(last, 0.0):.13g} s; "
                        "allowed: times that go on, of both soles by one clock"
                    )
                if now < 0.0:
                    continue  # from before the first reading, with which the recording begins
                if now > seconds:
                    break
                skins[side].write(now, reading.force)
                before.append(now)
                seen[side] = reading
                latest = max(latest, now)
                if show is not None and now >= shown + _SHOWN:
                    show(now / seconds, "  ".join([f"{now:.1f} s", *(_text(s, stream, seen[s]) for s in seen)]))
                    shown = now
        except KeyboardInterrupt:
            pass  # the usual end of a recording
    return {"seconds": round(latest, 3), "feet": {side: _summary(when) for side, when in times.items() if when}}


def _readings(stream: LiveStream) -> Iterator[tuple[Side, Reading]]:
    with device_errors("the source cannot be read"):  # not around what is written
        yield from stream.readings


def _text(side: Side, stream: LiveStream, reading: Reading) -> str:
    percept = Percept(stream.soles[side], reading)
    place = percept.position_cop_in_sole
    load = f"{side} {percept.vertical_force:.0f} N"
    return load if place is None else f"{load} at {round(1e3 * place[0])}, {round(1e3 * place[1])} mm"


def _summary(times: list[float]) -> dict[str, float | None]:
    rate, gap = (round(1.0 / steps.mean(), 3), round(steps.max(), 4)) if len(steps := np.diff(times)) else (None, None)
    return {"frames": len(times), "rate_hz": rate, "gap_max_s": gap}
