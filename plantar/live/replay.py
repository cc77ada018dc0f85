"""A recording's frames at their times, both feet on one clock."""

import time
from collections.abc import Iterator, Mapping

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.formats import read_recording
from plantar.layouts.layout import SoleLayout
from plantar.live.source import LiveSource, LiveStream
from plantar.recordings.pressure_recording import PressureRecording
from plantar.sensing.reading import Reading


def _open(address: str, layout: SoleLayout | None) -> LiveStream:
    if not address:
        raise InputError("replay needs a recording; allowed: replay:FILE")
    recording = read_recording(address, layout=layout)
    soles = {side: foot.layout for side, foot in recording.feet.items() if foot.layout is not None}
    if not soles:
        raise InputError(f"{address}: the places of its cells are not known; allowed: with --layout FILE")
    return LiveStream(soles, _readings(recording, soles), recording.kind, "counts" if recording.raw else "N")


def _readings(recording: PressureRecording, soles: Mapping[Side, SoleLayout]) -> Iterator[tuple[Side, Reading]]:
    began = time.monotonic()
    for k, at in enumerate((recording.time - recording.time[0]).tolist()):
        time.sleep(max(0.0, began + at - time.monotonic()))
        for side in soles:
            yield side, Reading(at, recording.feet[side].force[k])


SOURCE = LiveSource("replay", "A recording at its own pace: replay:FILE", _open)
