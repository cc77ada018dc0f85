"""The time of ticks grows by about a period, whatever a clock reports."""

import math
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from plantar import kernels
from plantar.kernels.safety import tick_clock
from plantar.kernels.safety.tick_clock import TickClock


@given(st.lists(st.floats(), min_size=1))
def test_time_is_monotone_and_no_tick_is_long(reported):
    clock = TickClock(0.005)
    times = [clock.time_of(value) for value in reported]
    for before, now in pairwise(times):
        if abs(now) < 1e9:  # of larger numbers a period is less than a bit
            assert 0.4 * 0.005 < now - before < 1.6 * 0.005


def test_a_sound_clock_is_taken_to_the_last_bit():
    clock = TickClock(0.005)
    assert all(clock.time_of(3.0 + 0.005 * i) == 3.0 + 0.005 * i for i in range(10_000))


def test_a_clock_that_began_before_the_walk_counts_from_zero():
    for first in (1.5e9, 2.0):
        clock = TickClock(0.005, latest=1.0)
        assert [round(clock.time_of(first + 0.005 * i), 4) for i in range(4)] == [0.0, 0.005, 0.01, 0.015]
    assert TickClock(0.005, latest=1.0).time_of(1.0) == 1.0
    assert TickClock(0.005, latest=1.0).time_of(-5.0) == 0.0


def test_a_clock_with_jitter_is_followed_and_one_that_stops_is_noted():
    clock = TickClock(0.005)
    for i in range(4000):
        time = clock.time_of(0.00505 * i + (0.008 if i % 2 else -0.008))  # and 1 % fast
    assert abs(time - 0.00505 * 3999) < 0.02
    for _ in range(30):
        clock.time_of(math.nan)
    assert clock.odd == 30


def test_a_late_tick_counts_those_before_it_that_were_missed():
    clock = TickClock(0.005)
    late = []
    for reported in (0.0, 0.005, 0.02, 0.025, 0.225, 0.23):  # two are missed, then a stall of 0.2 s
        clock.time_of(reported)
        late.append(clock.late)
    assert late == [0, 0, 2, 0, 39, 0]


@given(st.lists(st.one_of(st.floats(), st.floats(-0.02, 0.02)), min_size=1))
def test_compiled_and_interpreted_clock_agree(reported):
    clocks = [form.TickClock(0.005, 1.0) for form in (tick_clock, kernels.python_form("tick_clock"))]
    for k, value in enumerate(reported):
        time, expected = (clock.time_of(0.005 * k + value) for clock in clocks)
        assert time == expected
        assert clocks[0].odd == clocks[1].odd
        assert clocks[0].late == clocks[1].late
        assert clocks[0].jumped == clocks[1].jumped or math.isnan(clocks[1].jumped)
