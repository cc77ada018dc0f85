"""Lines of a microcontroller on a serial port; opened again when it was unplugged."""

import os
import select
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from importlib import import_module
from typing import Any

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.live.line_reading import arrivals_of, soles_of
from plantar.live.source import QUIET, LiveSource, LiveStream

_BAUD = 115200
_MOST = 1 << 16  # bytes at a time


Parse = Callable[[Iterable[bytes], Mapping[Side, SoleLayout]], Iterator[Arrival]]
"""Makes readings of some soles of chunks of bytes."""


def port_stream(source: str, parse: Parse, address: str, layout: SoleLayout | None) -> LiveStream:
    """Stream of a named `source` whose bytes come on the serial port at an `address`, DEVICE or DEVICE@BAUD."""
    path, baud = _device_and_rate(address, source)
    soles = soles_of(layout, address)
    port = _opened_port(path, baud)
    arrivals = _port_arrivals(path, baud, port, lambda chunks: parse(chunks, soles))
    next(arrivals)
    return LiveStream(soles, arrivals)


def _device_and_rate(address: str, source: str) -> tuple[str, int]:
    """Device and baud of an `address` of a named `source`; InputError if it is none."""
    path, _, rate = address.partition("@")
    if not path or not (rate.isdecimal() or not rate):
        raise InputError(f"serial port {address!r}; allowed: {source}:DEVICE, or {source}:DEVICE@{_BAUD}")
    return path, int(rate or _BAUD)


def _opened_port(path: str, baud: int) -> int:
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


def _port_arrivals(
    path: str, baud: int, port: int, arrivals: Callable[[Iterable[bytes]], Iterator[Arrival]]
) -> Iterator[Arrival]:
    """Yields what `arrivals` makes of the bytes of an opened port, opened again when it is lost; first None."""
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
                found = _opened_port(path, baud)
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


SOURCE = LiveSource(
    "serial",
    f"Lines on a serial port: serial:DEVICE@BAUD, {_BAUD} baud if not given",
    partial(port_stream, "serial", arrivals_of),
)
