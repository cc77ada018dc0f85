"""Workers that are processes of this machine, one task at a time each."""

import os
import signal
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from multiprocessing import get_context, resource_tracker
from typing import Any

from plantar.common.workers.workers import TRIES, Job, Row, Task, Workers
from plantar.errors import PlantarError, WorkerError

_STARTS = 3  # workers in a row that end before they are ready: no other will do better


class _Worker:
    """An executor of one process: where that dies, it is known in which run."""

    def __init__(self, ended: Any, load: Callable[[], object]) -> None:
        context = get_context("spawn")
        self.executor = ProcessPoolExecutor(1, context, initializer=_end_when_closed, initargs=(ended,))
        self._loaded = self.submit(load)

    @property
    def ready(self) -> bool:
        """Whether it has loaded what a run needs."""
        return self._loaded.done() and self._loaded.exception() is None

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        with _interrupts_held():  # a process may be started
            return self.executor.submit(function, *arguments)


class LocalWorkers(Workers):
    """At most `count` processes of this machine that do a job; a dead one's task starts again."""

    def __init__(self, count: int, job: Job) -> None:
        super().__init__()
        self._count = count
        self._job = job
        self._idle: list[_Worker] = []
        self._busy: dict[Future[Row], _Worker] = {}
        self._deaths: Counter[Task] = Counter()
        self._false_starts = 0
        # Every worker waits for the end of this pipe, which comes when it is closed or this process dies.
        self._ended, self._open = get_context("spawn").Pipe(duplex=False)

    def close(self) -> None:
        self._open.close()
        for worker in (*self._idle, *self._busy.values()):
            worker.executor.shutdown(cancel_futures=True)
        self._ended.close()

    def _capacity(self) -> int:
        return self._count

    def _check(self) -> None:
        """A process that ends is seen at its run."""

    def _begin(self, task: Task) -> Future[Row]:
        try:
            while True:
                worker = self._idle.pop() if self._idle else _Worker(self._ended, self._job.load)
                with suppress(BrokenProcessPool):  # it died while it was idle
                    future = worker.submit(self._job.run, task)
                    self._busy[future] = worker
                    return future
        except OSError as error:
            raise WorkerError(f"no worker process can be started ({error.strerror})") from None

    def _outcome(self, task: Task, future: Future[Row]) -> Sequence[Row]:
        worker = self._busy.pop(future)
        try:
            row = future.result()
        except BrokenProcessPool:
            return self._died(task, worker)
        except PlantarError:
            raise
        except ImportError as error:
            raise WorkerError(f"a worker cannot load what it needs: {error}") from None
        self._idle.append(worker)
        self._false_starts = 0
        return [row]

    def _died(self, task: Task, worker: _Worker) -> Sequence[Row]:
        if worker.ready:
            self._deaths[task] += 1
        else:
            self._false_starts += 1
        if self._false_starts == _STARTS:
            raise WorkerError("worker processes end before they are ready")
        if self._deaths[task] == TRIES:
            return [
                self._job.failed(f"the worker died in this run, {TRIES} times of {TRIES} (as when memory runs out)")
            ]
        self.submit(task)
        return []


def _end_when_closed(pipe: Any) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the sweep ends this one
    os.environ["MUJOCO_GL"] = "disable"  # no pictures here; looking for a display starts a process that outlives a kill

    def watch() -> None:
        with suppress(EOFError, OSError):
            pipe.recv()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Start a process with Ctrl-C blocked: no traceback while it loads."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # multiprocessing's own process; starting it later would undo the mask
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
