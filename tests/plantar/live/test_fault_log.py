"""Counts of faults, and what a flood leaves of events."""

import pytest

from plantar import InputError
from plantar.live.fault_log import ALLOWED_IN_STRICT, KINDS, FaultLog


def test_a_flood_leaves_ten_events_and_one_a_second():
    log = FaultLog()
    for k in range(10_000):
        log.note(0.001 * k, "garbled", f"line {k}")
    log.end(10.0)
    events = log.taken()
    assert log.counts["garbled"] == 10_000
    assert len(events) <= 21
    assert events[10].text.endswith(" more before)")


@pytest.mark.parametrize("kind", KINDS)
def test_what_ends_a_strict_stream(kind):
    log = FaultLog(strict=True)
    if kind in ALLOWED_IN_STRICT:
        log.note(0.0, kind, "text")
        assert log.counts[kind] == 1
    else:
        with pytest.raises(InputError, match="text"):
            log.note(0.0, kind, "text")
