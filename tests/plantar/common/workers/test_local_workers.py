"""Processes that run tasks and may die of them. A worker runs any function of its task: here small ones."""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import closing
from pkgutil import resolve_name
from typing import Any

import pytest

from plantar.common.workers.local_workers import LocalWorkers
from plantar.common.workers.workers import TRIES, Job
from plantar.errors import WorkerError

psutil = pytest.importorskip("psutil")
WAIT = 120.0


def failed(reason: str) -> dict[str, str]:
    """The row of a task whose workers died."""
    return {"error": reason}


def processes() -> list[Any]:
    """The workers of this process."""
    return [p for p in psutil.Process().children() if "spawn_main" in " ".join(p.cmdline())]


def answers(pool: LocalWorkers, count: int) -> Iterator[Any]:
    deadline = time.monotonic() + WAIT
    while count > 0:
        assert time.monotonic() < deadline
        for answer in pool.finished(0.2):
            count -= 1
            yield answer


def test_tasks_run_beside_one_another_and_no_more_than_there_is_room_for():
    with closing(LocalWorkers(2, Job(str, failed))) as pool:
        left = list(range(5))
        done = []
        while len(done) < 5:
            while left and pool.room:
                pool.submit(left.pop())
            assert len(processes()) <= 2
            done += list(pool.finished(0.2))
        assert sorted(done) == [(i, str(i)) for i in range(5)]
        assert pool.room == 2
    assert processes() == []


def test_a_run_that_kills_its_worker_is_tried_again_and_then_becomes_a_row():
    with closing(LocalWorkers(1, Job(os._exit, failed))) as pool:
        pool.submit(7)
        ((task, row),) = answers(pool, 1)
        assert task == 7
        assert f"{TRIES} times of {TRIES} (as when memory runs out)" in row["error"]
        assert pool.room == 1


def test_a_killed_worker_is_replaced_and_its_run_begins_again():
    with closing(LocalWorkers(1, Job(time.sleep, failed))) as pool:
        pool.submit(1.0)
        deadline = time.monotonic() + WAIT
        (worker,) = pool._busy.values()
        while not (pool.finished(0.05) or worker.ready):
            assert time.monotonic() < deadline
        (first,) = processes()
        first.send_signal(signal.SIGKILL)
        assert list(answers(pool, 1)) == [(1.0, None)]
        assert first.pid not in [p.pid for p in processes()]
        (idle,) = processes()
        idle.kill()  # while it has nothing to do
        pool.submit(0.0)
        assert list(answers(pool, 1)) == [(0.0, None)]


def test_closing_ends_workers_in_the_middle_of_a_run():
    pool = LocalWorkers(2, Job(time.sleep, failed))
    pool.submit(600.0)
    pool.submit(601.0)
    until = time.monotonic() + WAIT
    while len(processes()) < 2 and time.monotonic() < until:  # a process has its parent's command line at first
        time.sleep(0.01)
    assert len(processes()) == 2
    pool.close()
    assert processes() == []


def test_workers_that_cannot_begin_end_the_sweep(monkeypatch):
    """Their module search path leads nowhere, so that they end while they load."""
    monkeypatch.setattr("multiprocessing.spawn.get_command_line", lambda **_: ["/bin/false"])
    with closing(LocalWorkers(1, Job(str, failed))) as pool:
        pool.submit(0)
        with pytest.raises(WorkerError, match=r"end before they are ready"):
            list(answers(pool, 1))


def test_an_error_that_stops_all_runs_is_raised_after_the_rows_that_came():
    with closing(LocalWorkers(1, Job(resolve_name, failed))) as pool:
        pool.submit("json:__name__")
        assert list(answers(pool, 1)) == [("json:__name__", "json")]
        pool.submit("no_such_library")
        with pytest.raises(WorkerError, match=r"cannot load .*no_such_library"):
            list(answers(pool, 1))


def test_a_system_that_gives_no_process_is_one_line(monkeypatch):
    def no_more(*_: Any) -> None:
        raise BlockingIOError(11, "Resource temporarily unavailable")

    monkeypatch.setattr("multiprocessing.process.BaseProcess.start", no_more)
    with (
        closing(LocalWorkers(1, Job(str, failed))) as pool,
        pytest.raises(WorkerError, match=r"can be started .Resource"),
    ):
        pool.submit(0)
