"""A stream goes on after faulty input: each fault is counted, times go on, forces that cannot be are missing."""

import math

import numpy as np
import pytest

from plantar import InputError, grid_layout, mirrored
from plantar.live import CheckedStream, Fault, LiveStream
from plantar.live.arrival import LiveEvent, LiveReading
from plantar.sensing.reading import Reading

SOLE = grid_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], pitch=(0.05, 0.05), side="left")
SOLES = {"left": SOLE, "right": mirrored(SOLE)}


class Clock:
    """Arrival times that a test sets."""

    def __init__(self, monkeypatch):
        self.now = 1000.0
        monkeypatch.setattr("plantar.live.checked_stream.clock.monotonic", lambda: self.now)


@pytest.fixture
def clock(monkeypatch):
    return Clock(monkeypatch)


def at(time, side="left", force=None):
    return side, Reading(time, np.full(len(SOLE), time if force is None else force))


def times(stream, side="left"):
    return [reading.time for found, reading in stream.readings if found == side]


def paced(clock, arrivals):
    """Arrivals at stated times."""
    for now, arrival in arrivals:
        clock.now = now
        yield arrival


def counted(stream):
    return {kind: count for kind, count in stream.faults.items() if count}


def test_what_is_no_reading_is_counted_and_the_stream_goes_on():
    good = [at(0.01 * k) for k in range(10)]
    bad = [Fault("garbled", "line 3"), Fault("blank", "line 4"), at(0.04), None, Fault("crc", "packet 9")]
    stream = CheckedStream(LiveStream(SOLES, iter([*good[:5], *bad, *good[5:]])))
    assert times(stream) == pytest.approx([0.01 * k for k in range(10)])
    assert counted(stream) == {"garbled": 1, "blank": 1, "repeated": 1, "crc": 1}


@pytest.mark.parametrize("value", [math.inf, -math.inf, 1e308, 2e5])
def test_a_force_that_cannot_be_is_missing(value):
    force = np.ones(len(SOLE))
    force[2] = value
    force[3] = math.nan
    stream = CheckedStream(LiveStream(SOLES, iter([("left", Reading(0.0, force))])))
    ((_, reading),) = stream.readings
    assert np.isnan(reading.force).tolist() == [k in (2, 3) for k in range(len(SOLE))]
    assert counted(stream) == {"impossible": 1}
    strict = CheckedStream(LiveStream(SOLES, iter([("left", Reading(0.0, force))])), strict=True)
    with pytest.raises(InputError, match="on taxel 2 at 0 s; allowed: up to 100000 N"):
        list(strict.readings)


def test_a_time_that_cannot_be_is_left_out():
    stream = CheckedStream(LiveStream(SOLES, iter([at(0.0), at(1e99), at(0.01)])))
    assert times(stream) == [0.0, 0.01]
    assert counted(stream) == {"impossible": 1}


def test_a_single_reading_far_from_the_others_is_left_out(clock):
    order = [*range(20), 9000, *range(20, 40), -9000, *range(40, 60)]
    stream = CheckedStream(LiveStream(SOLES, paced(clock, [(0.01 * k, at(0.01 * n)) for k, n in enumerate(order)])))
    assert times(stream) == pytest.approx([0.01 * k for k in range(60)])
    assert counted(stream) == {"out_of_place": 2}


def test_readings_that_come_late_or_twice(clock):
    order = [0, 1, 2, 3, 4, 5, 6, 8, 7, 9, 9, 8, 10, 14, 11, 12, 13, 15]
    stream = CheckedStream(LiveStream(SOLES, paced(clock, [(0.01 * k, at(0.01 * n)) for k, n in enumerate(order)])))
    items = [item for item in stream.items if isinstance(item, LiveReading)]
    late = [item.reading.time for item in items if item.late]
    assert late == pytest.approx([0.07, 0.11, 0.12, 0.13])
    assert sorted(item.reading.time for item in items) == pytest.approx([0.01 * k for k in range(16)])
    assert counted(stream) == {"repeated": 2, "late": 4, "gap": 1}


def test_other_forces_at_the_same_time_are_kept():
    stream = CheckedStream(LiveStream(SOLES, iter([at(0.0), at(0.01, force=1.0), at(0.01, force=2.0), at(0.02)])))
    assert times(stream) == [0.0, 0.01, 0.01, 0.02]
    assert counted(stream) == {"same_time": 1}


@pytest.mark.parametrize("begin", [0.0, 777.0])
def test_a_device_that_begins_again_goes_on(clock, begin):
    """Off for 2 s: of each sole no reading is lost, both keep one clock, and times go on by what has passed."""
    arrivals = [(0.01 * k, at(50.0 + 0.01 * k, side)) for k in range(50) for side in SOLES]
    arrivals += [(2.49 + 0.01 * k, at(begin + 0.01 * k, side)) for k in range(50) for side in SOLES]
    stream = CheckedStream(LiveStream(SOLES, paced(clock, arrivals)))
    found = {side: [] for side in SOLES}
    events = []
    for item in stream.items:
        if isinstance(item, LiveReading):
            found[item.side].append(item.reading.time)
        elif isinstance(item, LiveEvent):
            events.append(item.text)
    expected = [50.0 + 0.01 * k for k in range(50)] + [52.49 + 0.01 * k for k in range(50)]
    assert found["left"] == found["right"] == pytest.approx(expected)
    assert counted(stream) == {"restart": 2}
    assert events[0].startswith(f"restart: the left sole's clock went from 50.49 s to {begin:g} s; it goes on at 52.49")


def test_a_pause_is_a_gap_with_its_time(clock):
    arrivals = [(0.01 * k, at(0.01 * k)) for k in [*range(30), *range(530, 560)]]
    stream = CheckedStream(LiveStream(SOLES, paced(clock, arrivals)))
    assert times(stream) == pytest.approx([0.01 * k for k in [*range(30), *range(530, 560)]])
    assert counted(stream) == {"gap": 1}


def test_a_pause_in_a_file_at_full_speed_is_a_gap(clock):
    stream = CheckedStream(LiveStream(SOLES, (at(0.01 * k) for k in [*range(30), *range(530, 560)])))
    assert times(stream) == pytest.approx([0.01 * k for k in [*range(30), *range(530, 560)]])
    assert counted(stream) == {"gap": 1}


def two_clocks(offset, rate_ppm, seconds, late=lambda: 0.0):
    """Readings of 100 Hz whose right times are `offset` s ahead, on a clock that is faster; (arrival, reading) each."""
    found = []
    for k in range(int(100 * seconds)):
        true = 0.01 * k
        found.append((true + late(), at(true)))
        found.append((true + 0.003 + late(), at((true + 0.003) * (1.0 + 1e-6 * rate_ppm) + offset, "right")))
    return sorted(found, key=lambda pair: pair[0])


@pytest.mark.parametrize("offset", [0.3, -0.3])
def test_clocks_that_differ_are_stated(clock, offset):
    late = np.random.default_rng(0).exponential
    stream = CheckedStream(LiveStream(SOLES, paced(clock, two_clocks(offset, 200.0, 60.0, lambda: late(0.002)))))
    events = [item.text for item in stream.items if isinstance(item, LiveEvent)]
    assert stream.clocks.offset == pytest.approx(offset + 200e-6 * 60.0, abs=1e-3)
    assert abs(stream.clocks.rate_ppm - 200.0) < max(5.0, 3.0 * stream.clocks.rate_error_ppm)
    place = "ahead of" if offset > 0.0 else "behind"
    assert any(f"the right sole's is 0.300 s {place} the left one's; not corrected" in text for text in events)


def test_clocks_that_agree_are_no_event(clock):
    stream = CheckedStream(LiveStream(SOLES, paced(clock, two_clocks(0.0, 0.0, 12.0))))
    assert not [item for item in stream.items if isinstance(item, LiveEvent)]
    assert stream.clocks.offset == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("offset", [0.3, -0.3])
def test_clocks_are_corrected_on_request(clock, offset):
    stream = CheckedStream(LiveStream(SOLES, paced(clock, two_clocks(offset, 500.0, 30.0))), correct=True)
    found = {side: [] for side in SOLES}
    for side, reading in stream.readings:
        found[side].append(reading.time)
    assert len(found["left"]) == len(found["right"]) == 3000
    assert (np.diff(found["right"]) > 0.0).all()
    wrong = np.array(found["right"]) - np.array(found["left"]) - 0.003
    assert np.abs(wrong).max() < 2e-3


def test_a_strict_stream_ends_at_a_step_back():
    stream = CheckedStream(LiveStream(SOLES, iter([at(0.2), at(0.1)])), strict=True)
    with pytest.raises(InputError, match=r"the left sole got 0.1 s after 0.2 s; allowed: times that go on"):
        list(stream.readings)


def test_any_order_of_times_ends_well():
    """Times of all kinds: never an error, never a time that goes back, never more readings than came."""
    random = np.random.default_rng(1)
    kinds = [0.01, 0.01, 0.01, 0.01, 0.0, -0.01, -5.0, 5.0, 1e4, -1e4, 1e9, -1e9]
    for _ in range(100):
        given = np.cumsum(random.choice(kinds, 300))
        stream = CheckedStream(LiveStream(SOLES, (at(time, side) for time in given for side in SOLES)))
        found = times(stream)
        assert 0 < len(found) <= 300
        assert (np.diff(found) >= 0.0).all()
        assert found[-1] - found[0] < 2e8
