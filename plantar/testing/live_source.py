"""What a live source has to keep."""

from itertools import islice

import numpy as np

from plantar.errors import PlantarError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Fault
from plantar.live.source import LiveSource, LiveStream

_IMPOSSIBLE = "no such address \x00"


def check_live_source(source: LiveSource, address: str, layout: SoleLayout | None, count: int = 100) -> list[str]:
    """What a live source lacks, a sentence each; empty if nothing.

    Args:
        source: The source.
        address: One that it can open, at which readings come.
        layout: Of its soles, or None.
        count: Readings that are looked at.

    Returns:
        The sentences.
    """
    lacks = []
    try:
        source.open(_IMPOSSIBLE, layout)
        lacks.append("an address that cannot be is opened; expected an InputError")
    except (PlantarError, OSError):
        pass
    except Exception as error:  # of every kind: that is what is looked for
        lacks.append(f"an address that cannot be raises {type(error).__name__}; expected an InputError")
    stream = source.open(address, layout)
    if not isinstance(stream, LiveStream):
        return [*lacks, f"open() returns a {type(stream).__name__}; expected a LiveStream"]
    latest = dict.fromkeys(stream.soles, -np.inf)
    for arrival in islice(stream.readings, count):
        if arrival is None or isinstance(arrival, Fault):
            continue
        side, reading = arrival
        if side not in stream.soles:
            return [*lacks, f"a reading is of {side!r}, of which the stream states no sole"]
        if len(reading.force) != len(stream.soles[side]):
            return [*lacks, f"a reading has {len(reading.force)} forces, its sole {len(stream.soles[side])} taxels"]
        if not reading.time > latest[side]:
            return [*lacks, f"times of the {side} sole do not rise: {reading.time:g} s after {latest[side]:g} s"]
        latest[side] = reading.time
    if all(np.isinf(time) for time in latest.values()):
        lacks.append("no reading comes")
    return lacks
