"""Lines of a microcontroller on a serial port; opened again when it was unplugged."""

import os
import select
import time
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from typing import Any

from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.live.line_reading import arrivals_of, soles_of
from plantar.live.source import QUIET, LiveSource, LiveStream

_BAUD = 115200
_MOST = 1 << 16  # bytes at a time


def _open(address: str, layout: SoleLayout | None) -> LiveStream:
    path, _, rate = address.partition("@")
    if not path or not (rate.isdecimal() or not rate):
        raise InputError(f"serial port {address!r}; allowed: serial:DEVICE, or serial:DEVICE@{_BAUD}")
    baud = int(rate or _BAUD)
    soles = soles_of(layout, address)
    port = _opened(path, baud)
    arrivals = _arrivals(path, baud, port, lambda chunks: arrivals_of(chunks, soles))
    next(arrivals)
    return LiveStream(soles, arrivals)


def _opened(path: str, baud: int) -> int:
    """File descriptor of a port that passes bytes on as they are; InputError for a rate that it does not have."""
    try:
        termios: Any = import_module("termios")
        tty: Any = import_module("tty")
    except ImportError:
        raise InputError("serial ports are read on Linux and macOS; allowed: a program's output by lines") from None
    speed = getattr(termios, f"B{baud}", None)
    if speed is None:
        known = sorted(int(name[1:]) for name in dir(termios) if name[0] == "B" and name[1:].isdecimal())
        raise InputError(f"serial port at {baud} baud; allowed: {', '.join(str(rate) for rate in known if rate)}")
    port = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        tty.setraw(port, termios.TCSANOW)
        settings = termios.tcgetattr(port)
        settings[2] |= termios.CLOCAL | termios.CREAD
        settings[4] = speed
        settings[5] = speed
        termios.tcsetattr(port, termios.TCSANOW, settings)
    except termios.error as error:
        os.close(port)
        raise InputError(f"{path}: no serial port ({error.args[-1]})") from None
    return port


def _arrivals(path: str, baud: int, port: int, arrivals: Any) -> Iterator[Arrival]:
    try:
        yield None  # begun here, so that closing it closes the port
    except GeneratorExit:
        os.close(port)
        raise
    while True:
        try:
            yield from arrivals(_chunks(port))
            why = "it was closed"
        except OSError as error:
            why = error.strerror or str(error)
        yield Fault("lost", f"{path} went away: {why}")
        found = None
        while found is None:
            time.sleep(QUIET)
            yield None
            with suppress(OSError, InputError):
                found = _opened(path, baud)
        port = found


def _chunks(port: int) -> Iterator[bytes]:
    """Bytes as they come, none after half a second without any; ends where the port is closed."""
    try:
        while True:
            if not select.select([port], [], [], QUIET)[0]:
                yield b""
                continue
            chunk = os.read(port, _MOST)
            if not chunk:
                return
            yield chunk
    finally:
        os.close(port)


SOURCE = LiveSource("serial", f"Lines on a serial port: serial:DEVICE@BAUD, {_BAUD} baud if not given", _open)
