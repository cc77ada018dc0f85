"""Packets of a sole's firmware (`plantar/shoes/firmware/sole.c`) on serial ports.

Little endian: "PL", version 1, side, sequence (16 bits), time in us (32), number of taxels (16), a value each (16), and
CRC-16/CCITT-FALSE of all before it. Values are counts until the layout's calibration makes newtons of them.
"""

import binascii
import struct
from collections.abc import Iterable, Iterator, Mapping
from functools import partial

import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.live.serial_port import port_stream
from plantar.live.source import LiveSource
from plantar.sensing.reading import Reading

_HEAD = struct.Struct("<2sBBHIH")
_START = b"PL\x01"
_WRAP = 1 << 32  # us
_MOST = 16 * 32  # taxels: rows and columns that one firmware reads


def packets_of(chunks: Iterable[bytes], soles: Mapping[Side, SoleLayout]) -> Iterator[Arrival]:
    """Yields readings of packets in `chunks` of bytes as they come, for some `soles`; an empty chunk is silence (None).

    What is no packet is a fault "garbled", once for bytes that follow each other; packets that the sender counted and
    that did not come are one "dropped".
    """
    rest = b""
    skipped = 0
    clocks = {side: _Clock() for side in soles}
    for chunk in chunks:
        if not chunk:
            yield None
            continue
        rest += chunk
        while True:
            start = rest.find(_START)
            if start < 0:
                start = max(0, len(rest) - len(_START) + 1)
                skipped += start
                rest = rest[start:]
                break
            skipped += start
            rest = rest[start:]
            if len(rest) < _HEAD.size:
                break
            _, _, number, sequence, time, count = _HEAD.unpack_from(rest)
            side = SIDES[number % len(SIDES)]
            size = _HEAD.size + 2 * count
            ours = number < len(SIDES) and side in soles and count == len(soles[side])
            possible = ours or count <= _MOST
            if possible and len(rest) < size + 2:
                break
            if not possible or not _checked(rest, size):
                # Bytes that look like the beginning of a packet, or one that changed on its way.
                skipped += 1
                rest = rest[1:]
                continue
            if not ours:
                wanted = ", ".join(f"{len(sole)} of the {one} sole" for one, sole in soles.items())
                yield Fault("garbled", f"a packet holds {count} values of side {number}; allowed: {wanted}")
                rest = rest[size + 2 :]
                continue
            if skipped:
                yield Fault("garbled", f"{skipped} bytes are no packet, or one with a wrong check sum")
                skipped = 0
            missing = clocks[side].missing(sequence, time)
            if missing:
                yield Fault("dropped", f"{missing} packets of the {side} sole before number {sequence} did not come")
            values = np.frombuffer(rest, "<u2", count, _HEAD.size).astype(np.float64)
            yield side, Reading(clocks[side].seconds(), values)
            rest = rest[size + 2 :]
    if rest or skipped:
        yield Fault("cut", f"{len(rest) + skipped} bytes at the end are no whole packet")


def _checked(packet: bytes, size: int) -> bool:
    return binascii.crc_hqx(packet[:size], 0xFFFF) == int.from_bytes(packet[size : size + 2], "little")


class _Clock:
    """Sequence and time of a sender, whose counters wrap, and begin again where it restarts."""

    def __init__(self) -> None:
        self._sequence: int | None = None
        self._time = 0
        self._turns = 0

    def missing(self, sequence: int, time: int) -> int:
        """Packets that were counted since the last one and did not come; none after a restart."""
        before = self._sequence
        self._sequence = sequence
        # Packets come in order, so a time that is less by no more than half of the counter is of a restart.
        back = 0 < self._time - time <= _WRAP // 2
        if self._time - time > _WRAP // 2:
            self._turns += 1
        elif back:
            self._turns = 0
        self._time = time
        return 0 if before is None or back else (sequence - before - 1) % (1 << 16)

    def seconds(self) -> float:
        """Time of the last packet, in s since the sender's start."""
        return 1e-6 * (self._time + self._turns * _WRAP)


SOURCE = LiveSource(
    "packets",
    "Packets of soles' firmware on serial ports: packets:DEVICE@BAUD, or two with a comma between",
    partial(port_stream, "packets", packets_of, "counts"),
)
