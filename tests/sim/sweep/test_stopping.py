"""A signal stops a sweep once, and never in the middle of a row."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator

import pytest

from plantar.sim.sweep.stopping import SweepStopped, stop_noted


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """Both signals with a handler, also where the tests run in a shell's background."""
    before = {n: signal.signal(n, signal.default_int_handler) for n in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_raised_at_once_or_after_what_must_not_be_interrupted(number: int) -> None:
    with pytest.raises(SweepStopped) as caught, stop_noted():
        os.kill(os.getpid(), number)
    assert caught.value.number == number
    whole = []

    def row() -> None:
        with stop_noted() as note, note.held():
            os.kill(os.getpid(), number)
            whole.append(note.number)

    with pytest.raises(SweepStopped):
        row()
    assert whole == [number]


def test_the_first_signal_counts_and_later_ones_do_not_disturb_its_end() -> None:
    done = False
    with stop_noted() as note:
        try:
            with note.held():
                os.kill(os.getpid(), signal.SIGTERM)
                os.kill(os.getpid(), signal.SIGINT)
        except SweepStopped as stop:
            os.kill(os.getpid(), signal.SIGINT)
            done = stop.number == signal.SIGTERM
    assert done
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)


def test_what_is_ignored_stays_ignored() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with stop_noted() as note, note.held():
        os.kill(os.getpid(), signal.SIGINT)
    assert note.number == 0


def test_another_thread_handles_no_signals() -> None:
    seen = []

    def sweep() -> None:
        with stop_noted() as note, note.held():
            seen.append(note.number)

    thread = threading.Thread(target=sweep)
    thread.start()
    thread.join()
    assert seen == [0]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
