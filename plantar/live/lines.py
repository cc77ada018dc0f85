"""Lines of text on stdin, from any program that reads a device."""

import select
import sys
from collections.abc import Iterator
from io import UnsupportedOperation
from typing import Any, get_args

from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.line_reading import arrivals_of, soles_of
from plantar.live.source import QUIET, LiveSource, LiveStream
from plantar.recordings.pressure_recording import Kind

_MOST = 1 << 16  # bytes at a time


def _open(address: str, layout: SoleLayout | None) -> LiveStream:
    kind = next((kind for kind in get_args(Kind) if kind == (address or "robot")), None)
    if kind is None:
        ways = ", lines:".join(("lines", *get_args(Kind)))
        raise InputError(f"lines come on stdin, not from {address!r}; allowed: {ways}")
    soles = soles_of(layout, "a program on stdin")
    return LiveStream(soles, arrivals_of(_chunks(sys.stdin.buffer), soles), kind)


def _chunks(stream: Any) -> Iterator[bytes]:
    """Bytes as they come, none after half a second without any."""
    waits = _can_wait(stream)
    while True:
        if waits and not select.select([stream], [], [], QUIET)[0]:
            yield b""
            continue
        chunk: bytes = stream.read1(_MOST)
        if not chunk:
            return
        yield chunk


def _can_wait(stream: Any) -> bool:
    """Whether the system can tell if there is something to read: of no memory, and on Windows of no pipe."""
    try:
        return sys.platform != "win32" and int(stream.fileno()) >= 0
    except UnsupportedOperation:
        return False


SOURCE = LiveSource("lines", "Lines on stdin: side, time in s, force of each taxel in N", _open)
