"""Readings sent on by UDP, a line in a packet each, as source "udp" reads them."""

import socket
from contextlib import suppress
from weakref import finalize

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.live.line_reading import line_of
from plantar.live.sink import LiveSink, Send
from plantar.live.udp import host_and_port
from plantar.sensing.reading import Reading

_MOST = 65_000  # bytes of a packet


def _open(address: str) -> Send:
    host, port = host_and_port(address, "udp")
    family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
    device = socket.socket(family, kind, protocol)
    device.setblocking(False)

    def send(side: Side, reading: Reading) -> None:
        line = line_of(side, reading)
        if len(line) > _MOST:
            raise InputError(f"{len(reading.force)} forces do not fit into a packet; allowed: up to {_MOST} bytes")
        with suppress(OSError):  # a receiver that is not there, or too slow, holds up nothing
            device.sendto(line, place)

    finalize(send, device.close)
    return send


SINK = LiveSink("udp", "Lines in packets: udp:PORT of this machine, udp:HOST:PORT", _open)
