"""Readings as lines: what is written is read, and any bytes are read without an error."""

import math
import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import grid_layout, mirrored
from plantar.live import Fault
from plantar.live.line_reading import LONGEST, arrivals_of, line_of, reading_of
from plantar.sensing.reading import Reading

SOLE = grid_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], pitch=(0.05, 0.05), side="left")
SOLES = {"left": SOLE, "right": mirrored(SOLE)}


def test_what_is_written_is_read():
    force = np.random.default_rng(0).normal(size=len(SOLE))
    force[3] = math.nan
    side, reading = reading_of(line_of("right", Reading(0.1 + 0.2, force)), SOLES, "line 1")
    assert (side, reading.time) == ("right", 0.1 + 0.2)
    assert np.array_equal(reading.force, force, equal_nan=True)


def test_lines_that_are_cut_anywhere_by_chunks():
    text = b"".join(line_of("left", Reading(0.01 * k, np.full(len(SOLE), 1.0 * k))) for k in range(20))
    for size in (1, 7, 100, len(text)):
        found = list(arrivals_of((text[k : k + size] for k in range(0, len(text), size)), SOLES))
        assert [reading.time for _, reading in found] == pytest.approx([0.01 * k for k in range(20)])


def test_a_line_without_end_is_dropped_in_flat_memory():
    def chunks():
        for _ in range(400):
            yield b"x" * 100_000
        yield b"\n" + line_of("left", Reading(0.0, np.ones(len(SOLE))))
        yield b"left,0.1,"

    tracemalloc.start()
    overlong, reading, cut = arrivals_of(chunks(), SOLES)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert overlong == Fault("garbled", f"line 1 is longer than {LONGEST} bytes")
    assert reading[0] == "left"
    assert cut.kind == "cut"
    assert peak < 8 * LONGEST


@given(st.lists(st.binary(max_size=200)))
def test_any_bytes_are_faults_or_readings(chunks):
    for arrival in arrivals_of(chunks, SOLES):
        assert arrival is None or isinstance(arrival, Fault) or isinstance(arrival[1], Reading)
