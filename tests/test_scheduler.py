"""A worker that dies of a test costs that test: the others run once each, and the run ends."""

import random
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("xdist")

from .scheduler import FilesAtOnce


class Worker:
    """Runs what it is sent; like xdist's, it begins a test only when it knows of the next, or is to end."""

    def __init__(self, tests: list[str]):
        self.gateway = SimpleNamespace(id="w")
        self.tests = tests
        self.queue: list[int] = []
        self.shutting_down = False

    def send_runtest_some(self, indices: list[int]) -> None:
        self.queue += indices

    def shutdown(self) -> None:
        self.shutting_down = True

    @property
    def goes_on(self) -> bool:
        return len(self.queue) > 1 or (self.shutting_down and bool(self.queue))


def started(scheduler: FilesAtOnce, tests: list[str]) -> Any:
    """A worker that has yet to collect the tests."""
    worker: Any = Worker(tests)
    scheduler.add_node(worker)
    return worker


@pytest.mark.parametrize("seed", range(20))
def test_each_test_runs_once_whichever_of_them_kill_their_worker(seed):
    draw = random.Random(seed)
    tests = [f"file_{i}.py::test_{k}" for i in range(draw.randint(2, 9)) for k in range(draw.randint(1, 4))]
    deadly = set(draw.sample(tests, min(len(tests), draw.randint(0, 4))))
    config: Any = SimpleNamespace(option=SimpleNamespace(loadscopereorder=False), getvalue=lambda _: ["popen"] * 2)
    scheduler = FilesAtOnce(config)
    workers = [started(scheduler, tests) for _ in range(2)]
    for worker in workers:
        scheduler.add_node_collection(worker, tests)
    scheduler.schedule()
    collecting: list[Any] = []
    ran: list[str] = []
    crashed: list[str | None] = []
    while going := [worker for worker in workers if worker.goes_on or worker in collecting]:
        worker = draw.choice(going)
        if worker in collecting:
            collecting.remove(worker)
            scheduler.add_node_collection(worker, tests)
            scheduler.schedule()
            continue
        number = worker.queue.pop(0)
        ran.append(tests[number])
        if tests[number] not in deadly:
            scheduler.mark_test_complete(worker, number)
            continue
        workers.remove(worker)
        crashed.append(scheduler.remove_node(worker))
        workers.append(started(scheduler, tests))
        collecting.append(workers[-1])
    assert sorted(ran) == sorted(tests)
    assert set(crashed) == deadly
    assert scheduler.tests_finished
    assert all(worker.shutting_down for worker in workers)
