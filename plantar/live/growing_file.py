"""A file of lines that another program writes: read from its beginning, and followed as it grows."""

import os
import time
from collections.abc import Iterator

from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.line_reading import arrivals_of, soles_of
from plantar.live.source import QUIET, LiveSource, LiveStream

_MOST = 1 << 16  # bytes at a time
_EVERY = 0.01  # s between two looks


def _open(address: str, layout: SoleLayout | None) -> LiveStream:
    if not address:
        raise InputError("file needs a path; allowed: file:PATH")
    soles = soles_of(layout, address)
    with open(address, "rb"):
        pass  # one that is not there is an error now, not later
    return LiveStream(soles, arrivals_of(_chunks(address), soles))


def _chunks(path: str) -> Iterator[bytes]:
    """Bytes as they are written, none after half a second without any; of a file that is replaced, from its start."""
    whole = True  # so far the last line
    while True:
        with open(path, "rb", buffering=0) as stream:
            came = time.monotonic()
            while not _is_other(path, stream.fileno(), stream.tell()):
                if chunk := stream.read(_MOST):
                    came = time.monotonic()
                    whole = chunk.endswith(b"\n")
                    yield chunk
                elif time.monotonic() - came > QUIET:
                    came = time.monotonic()
                    yield b""
                else:
                    time.sleep(_EVERY)
        if not whole:
            yield b"\n"  # what the file held of a line does not go on in the next one


def _is_other(path: str, opened: int, position: int) -> bool:
    try:
        now = os.stat(path)
    except FileNotFoundError:
        return False  # it may be about to be replaced
    return not os.path.samestat(now, os.fstat(opened)) or now.st_size < position


SOURCE = LiveSource("file", "Lines of a growing file, as a program logs them: file:PATH", _open)
