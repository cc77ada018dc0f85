"""Bytes of microcontrollers on serial ports, a port for both feet or one a foot; opened again when it was unplugged."""

import os
import select
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from importlib import import_module
from typing import Any

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.live.line_reading import arrivals_of, soles_of
from plantar.live.source import QUIET, LiveSource, LiveStream, Unit

_BAUD = 115200
_MOST = 1 << 16  # bytes at a time
_CLOSED = -1


Parse = Callable[[Iterable[bytes], Mapping[Side, SoleLayout]], Iterator[Arrival]]
"""Makes readings of some soles of chunks of bytes, and None of an empty one."""


def port_stream(source: str, parse: Parse, unit: Unit, address: str, layout: SoleLayout | None) -> LiveStream:
    """Stream of a named `source` whose bytes come on serial ports, and hold values in a `unit`.

    `address`: DEVICE or DEVICE@BAUD, or some of them with commas between where each foot has a port of its own.
    """
    places = [_device_and_rate(one, source) for one in address.split(",")]
    if len({path for path, _ in places}) < len(places):
        raise InputError(f"serial ports {address!r}; allowed: each of them once")
    soles = soles_of(layout, address)
    ports: list[_Port] = []
    try:
        for path, baud in places:
            ports.append(_Port(path, baud))
    except (OSError, InputError):
        for port in ports:
            port.close()
        raise
    arrivals = _arrivals(ports, lambda chunks: parse(chunks, soles))
    next(arrivals)
    return LiveStream(soles, arrivals, unit=unit)


def _device_and_rate(address: str, source: str) -> tuple[str, int]:
    """Device and baud of an `address` of a named `source`; InputError if it is none."""
    path, _, rate = address.partition("@")
    if not path or not (rate.isdecimal() or not rate):
        raise InputError(
            f"serial port {address!r}; allowed: {source}:DEVICE, or {source}:DEVICE@{_BAUD}, or two and a comma between"
        )
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


class _Port:
    """An opened port. InputError or OSError if it cannot be opened."""

    def __init__(self, path: str, baud: int) -> None:
        self.path = path
        self._baud = baud
        self._file = _opened_port(path, baud)
        termios: Any = import_module("termios")
        termios.tcflush(self._file, termios.TCIFLUSH)  # what a board sent while nobody listened is old
        self._tried = 0.0

    @property
    def is_open(self) -> bool:
        return self._file != _CLOSED

    def fileno(self) -> int:
        """File descriptor, for `select`."""
        return self._file

    def close(self) -> None:
        if self.is_open:
            os.close(self._file)
            self._file = _CLOSED

    def arrivals(self, parse: Callable[[Iterable[bytes]], Iterator[Arrival]]) -> Iterator[Arrival]:
        """Yields what comes, and None where that is all for now; goes on when a port that was lost is there again."""
        while True:
            why = "it was closed"
            try:
                yield from parse(self._chunks())
            except OSError as error:
                why = error.strerror or str(error)
            self.close()
            self._tried = time.monotonic()
            yield Fault("lost", f"{self.path} went away: {why}")
            while not self.is_open:
                yield None
                self._reopen()

    def _chunks(self) -> Iterator[bytes]:
        """Yields what has come, then an empty chunk, so that no port keeps others waiting; ends where it is closed."""
        while True:
            with suppress(BlockingIOError):
                chunk = os.read(self._file, _MOST)
                if not chunk:
                    return
                yield chunk
            yield b""

    def _reopen(self) -> None:
        if time.monotonic() < self._tried + QUIET:
            return
        self._tried = time.monotonic()
        with suppress(OSError, InputError):
            self._file = _opened_port(self.path, self._baud)


def _arrivals(ports: Sequence[_Port], parse: Callable[[Iterable[bytes]], Iterator[Arrival]]) -> Iterator[Arrival]:
    """Yields what comes on some ports, in turn, and None after half a second without any; first None."""
    readers = [port.arrivals(parse) for port in ports]
    owners: dict[Side, _Port] = {}
    try:
        yield None  # begun here, so that closing it closes the ports
        while True:
            ready = select.select([port for port in ports if port.is_open], [], [], QUIET)[0]
            if not ready:
                yield None
            for port, reader in zip(ports, readers, strict=True):
                if port.is_open and port not in ready:
                    continue
                for arrival in reader:
                    if arrival is None:
                        break
                    yield _of_one_port(arrival, port, owners)
    finally:
        for port in ports:
            port.close()


def _of_one_port(arrival: Arrival, port: _Port, owners: dict[Side, _Port]) -> Arrival:
    """What arrived on a port, unless its sole's readings come on another one that is there."""
    if arrival is None or isinstance(arrival, Fault):
        return arrival
    side = arrival[0]
    owner = owners.setdefault(side, port)
    if owner is port:
        return arrival
    if owner.is_open:
        return Fault("stranger", f"{port.path} sends a {side} sole, as {owner.path} does; allowed: one port a sole")
    owners[side] = port
    return arrival


SOURCE = LiveSource(
    "serial",
    f"Lines on serial ports: serial:DEVICE@BAUD, {_BAUD} baud if not given; two with a comma between",
    partial(port_stream, "serial", arrivals_of, "N"),
)
