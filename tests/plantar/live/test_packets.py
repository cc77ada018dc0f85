"""Packets of a firmware: what arrives is what was sent, and what is none, lost, cut or of another sole is said."""

import binascii
import struct

import numpy as np
import pytest

from plantar import InputError, grid_layout, mirrored
from plantar.live import Fault, open_live
from plantar.live.packets import packets_of

SOLE = grid_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], pitch=(0.05, 0.05), side="left")
SOLES = {"left": SOLE, "right": mirrored(SOLE)}


def packet(sequence: int, time: int, side: int = 0, values=None) -> bytes:
    values = np.arange(len(SOLE)) + sequence % 100 if values is None else values
    head = struct.pack("<2sBBHIH", b"PL", 1, side, sequence % (1 << 16), time % (1 << 32), len(values))
    body = head + np.asarray(values, "<u2").tobytes()
    return body + struct.pack("<H", binascii.crc_hqx(body, 0xFFFF))


def arrivals(data: bytes, size: int = 7):
    found = list(packets_of([data[k : k + size] for k in range(0, len(data), size)], SOLES))
    return [a for a in found if not isinstance(a, Fault)], [a for a in found if isinstance(a, Fault)]


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_packets_of_both_soles_come_whole_however_they_are_cut(size):
    data = b"".join(packet(k, 10_000 * k, side) for k in range(20) for side in (0, 1))
    found, faults = arrivals(data, size)
    assert faults == []
    assert [side for side, _ in found[:4]] == ["left", "right", "left", "right"]
    assert [r.time for side, r in found if side == "right"] == pytest.approx([0.01 * k for k in range(20)])
    np.testing.assert_array_equal(found[6][1].force, np.arange(len(SOLE)) + 3)


def test_counters_wrap():
    times = [(1 << 32) - 15_000 + 10_000 * k for k in range(4)]
    found, faults = arrivals(b"".join(packet(65_534 + k, at) for k, at in enumerate(times)))
    assert faults == []
    assert np.diff([r.time for _, r in found]) == pytest.approx([0.01] * 3)


def test_a_restart_is_no_loss_and_its_times_begin_again():
    found, faults = arrivals(packet(40_000, 9_000_000) + packet(0, 1_000))
    assert faults == []
    assert [r.time for _, r in found] == [9.0, 0.001]


def test_what_is_lost_wrong_or_strange_is_said_and_the_rest_comes():
    wrong = bytearray(packet(1, 10_000))
    wrong[20] ^= 1
    strange = packet(3, 30_000, values=np.arange(5))
    data = (
        packet(0, 0) + bytes(wrong) + b"T12 400\n" + packet(2, 20_000) + strange + packet(6, 60_000) + packet(7, 0)[:-1]
    )
    found, faults = arrivals(data)
    assert [round(r.time, 3) for _, r in found] == [0.0, 0.02, 0.06]
    kinds = [fault.kind for fault in faults]
    assert kinds == ["garbled", "dropped", "garbled", "dropped", "cut"]
    assert "1 packets of the left sole before number 2 did not come" in faults[1].text
    assert f"holds 5 values of side 0; allowed: {len(SOLE)} of the left sole" in faults[2].text


def test_random_bytes_make_no_reading():
    noise = np.random.default_rng(1).integers(0, 256, 1 << 16, dtype=np.uint8).tobytes()
    found, faults = arrivals(noise, 4096)
    assert found == []
    assert faults
    found, _ = arrivals(noise + packet(0, 0), 4096)
    assert len(found) == 1


def test_an_address_that_is_none_is_refused():
    with pytest.raises(InputError, match="allowed: packets:DEVICE, or packets:DEVICE@115200"):
        open_live("packets:@x", SOLE)
    with pytest.raises(InputError, match="allowed: with --layout FILE"):
        open_live("packets:/dev/null")
