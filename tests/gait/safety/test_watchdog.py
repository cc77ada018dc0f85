"""Ticks that stop are noticed once."""

import time

import pytest

from plantar.errors import InputError
from plantar.gait.safety.watchdog import Watchdog


def wait_for(called, count):
    """Until it was called so often, however busy the machine is."""
    for _ in range(6000):
        if len(called) >= count:
            return
        time.sleep(0.01)


def test_ticks_that_stop_are_noticed_once_until_they_come_again():
    called: list[float] = []
    with Watchdog(0.1, lambda: called.append(time.monotonic())) as watchdog:
        time.sleep(0.3)
        assert called == []  # before the first tick there is nothing to watch
        watchdog.beat()
        begun = time.monotonic()
        wait_for(called, 1)
        time.sleep(0.3)
        assert len(called) == 1
        assert called[0] - begun >= 0.1
        watchdog.beat()
        wait_for(called, 2)
    assert watchdog.times == len(called) == 2


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan"), float("inf")])
def test_a_limit_that_is_none_is_refused(limit):
    with pytest.raises(InputError, match="limit of the watchdog"):
        Watchdog(limit, lambda: None)
