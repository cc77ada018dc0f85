"""Lines of text on stdin, from any program that reads a device: side, time in s, and the force of each taxel in N.

A line is "left,0.01,3.2,0,..."; a missing force is empty or nan.
"""

import math
import sys
from collections.abc import Iterator, Mapping
from typing import BinaryIO, get_args

from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.source import LiveSource, LiveStream
from plantar.recordings.pressure_recording import Kind, layout_for
from plantar.sensing.reading import Reading

_LONGEST = 1 << 20  # bytes of a line: 50,000 taxels


def _open(address: str, layout: SoleLayout | None) -> LiveStream:
    kind = next((kind for kind in get_args(Kind) if kind == (address or "robot")), None)
    if kind is None or layout is None:
        ways = ", lines:".join(("lines", *get_args(Kind)))
        raise InputError(f"lines come on stdin, for a sole that is known; allowed: {ways}, with --layout FILE")
    soles = {side: found for side in SIDES if (found := layout_for(side, layout)) is not None}
    return LiveStream(soles, _readings(sys.stdin.buffer, soles), kind)


def _readings(stream: BinaryIO, soles: Mapping[Side, SoleLayout]) -> Iterator[tuple[Side, Reading]]:
    for number, line in enumerate(iter(lambda: stream.readline(_LONGEST), b""), 1):
        if len(line) < _LONGEST and not line.endswith(b"\n"):
            return  # the program ended within a line: its last number may be cut
        name, *cells = line.decode("utf-8", "replace").strip().split(",")
        try:
            at, *force = (float(cell or math.nan) for cell in cells)
        except ValueError:
            raise InputError(f"line {number} holds no time and forces; allowed: side,time,force,force,...") from None
        side = next((known for known in soles if known == name), None)
        if side is None:
            raise InputError(f"line {number} begins with {name[:20]!r}; allowed: left, right")
        if len(force) != len(soles[side]):
            raise InputError(f"line {number} holds {len(force)} forces; allowed: {len(soles[side])}, one a taxel")
        yield side, Reading(at, force)


SOURCE = LiveSource("lines", "Lines on stdin: side, time in s, force of each taxel in N", _open)
