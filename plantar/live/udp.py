"""Packets of lines by UDP; from this machine only, unless another address is given to listen at."""

import socket
import time
from collections.abc import Iterator, Mapping
from typing import Any

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.live.line_reading import reading_of, soles_of
from plantar.live.source import QUIET, LiveSource, LiveStream
from plantar.sensing.reading import Reading

_MOST = 1 << 16  # bytes of a packet
_BUFFER = 4 << 20  # bytes that the system keeps meanwhile, where it allows that many
_GONE = 1.0  # s without a reading after which another sender may take a sole over


def _open(address: str, layout: SoleLayout | None) -> LiveStream:
    host, port = host_and_port(address, "udp")
    soles = soles_of(layout, f"udp:{address}")
    family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
    device = socket.socket(family, kind, protocol)
    try:
        device.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
        device.bind(place)
    except OSError:
        device.close()
        raise
    arrivals = _arrivals(device, soles)
    next(arrivals)
    return LiveStream(soles, arrivals)


def host_and_port(address: str, name: str) -> tuple[str, int]:
    """Returns host, this machine if none is given, and port of an `address`; InputError names `name`."""
    host, _, port = address.rpartition(":")
    if not port.isdecimal() or not 0 < int(port) < 1 << 16:
        raise InputError(f"{name} has no port in {address!r}; allowed: {name}:PORT or {name}:HOST:PORT, 1 to 65535")
    return host.strip("[]") or "127.0.0.1", int(port)


def _arrivals(device: socket.socket, soles: Mapping[Side, SoleLayout]) -> Iterator[Arrival]:
    senders: dict[Side, tuple[Any, float]] = {}
    number = 0
    with device:
        device.settimeout(QUIET)
        yield None  # begun here, so that closing it closes the device
        while True:
            try:
                packet, sender = device.recvfrom(_MOST)
            except TimeoutError:
                yield None
                continue
            number += 1
            for line in packet.split(b"\n") if packet.count(b"\n") > 1 else (packet,):
                if line or not packet:
                    yield _from(sender, reading_of(line, soles, f"packet {number}"), senders)


def _from(
    sender: Any, arrival: tuple[Side, Reading] | Fault, senders: dict[Side, tuple[Any, float]]
) -> tuple[Side, Reading] | Fault:
    """What arrived, unless another sender's readings of that sole are coming."""
    if isinstance(arrival, Fault):
        return arrival
    side = arrival[0]
    now = time.monotonic()
    known, latest = senders.get(side, (sender, now))
    if sender != known and now < latest + _GONE:
        return Fault("stranger", f"{sender[0]} port {sender[1]} sent a {side} sole too; allowed: one sender a sole")
    senders[side] = (sender, now)
    return arrival


SOURCE = LiveSource("udp", "Lines in packets: udp:PORT of this machine, udp:0.0.0.0:PORT from anywhere", _open)
