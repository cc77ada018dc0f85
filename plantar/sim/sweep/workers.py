"""Worker processes on this machine, one run at a time each."""

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import connection, get_context, parent_process, resource_tracker
from typing import Any, Protocol

from plantar.errors import PlantarError, WorkerError
from plantar.sim.sweep.task import Row, Task, failed, run_task

TRIES = 3
"""How often a run is begun before its row reports that its workers died."""

_STARTS = 3  # workers in a row that end before they are ready: no other will do better


class Workers(Protocol):
    """What runs the tasks of a sweep."""

    @property
    def room(self) -> int:
        """How many more tasks can be taken."""

    def submit(self, task: Task) -> None:
        """Begin a task."""

    def finished(self, timeout: float) -> Sequence[tuple[Task, Row]]:
        """Wait for a task's end, or a time in s; return ended tasks with rows."""

    def close(self) -> None:
        """End the workers at once."""


class LocalWorkers(Workers):
    """At most `count` processes that `run` tasks by an importable function; a dead one's task starts again."""

    def __init__(self, count: int, run: Callable[[Task], Row] = run_task) -> None:
        self._count = count
        self._run = run
        self._workers: list[_Worker] = []
        self._deaths: dict[Task, int] = {}
        self._false_starts = 0
        self._error: PlantarError | None = None

    @property
    def room(self) -> int:
        return self._count - sum(w.task is not None for w in self._workers)

    def submit(self, task: Task) -> None:
        for worker in self._workers:
            if worker.task is None:
                worker.begin(task)
                return
        try:
            worker = _Worker(self._run)
        except OSError as error:
            raise WorkerError(f"no worker process can be started ({error.strerror})") from None
        self._workers.append(worker)
        worker.begin(task)

    def finished(self, timeout: float) -> Sequence[tuple[Task, Row]]:
        if self._error is not None:
            raise self._error
        rows: list[tuple[Task, Row]] = []
        busy = {w.connection: w for w in self._workers if w.task is not None}
        for ready in connection.wait(list(busy), timeout):
            worker = busy[ready]  # type: ignore[index]
            task = worker.task
            assert task is not None
            try:
                kind, answer = worker.connection.recv()
            except (EOFError, OSError):
                rows += self._replace(worker, task)
                continue
            if kind == "ready":
                worker.ready = True
                self._false_starts = 0
            elif kind == "error":
                self._error = answer
            else:
                worker.task = None
                rows.append((task, answer))
        if self._error is not None and not rows:
            raise self._error
        return rows

    def close(self) -> None:
        for worker in self._workers:
            worker.process.kill()
        for worker in self._workers:
            worker.process.join(2.0)
            worker.connection.close()
        self._workers = []

    def _replace(self, worker: "_Worker", task: Task) -> list[tuple[Task, Row]]:
        self._workers.remove(worker)
        how = worker.end()
        if worker.ready:
            self._deaths[task] = self._deaths.get(task, 0) + 1
        else:
            self._false_starts += 1
        if self._false_starts == _STARTS:
            self._error = WorkerError(f"worker processes end before they are ready ({how})")
        elif self._deaths.get(task, 0) == TRIES:
            return [(task, failed(f"the worker died in this run, {TRIES} times of {TRIES} ({how})"))]
        else:
            try:
                self.submit(task)
            except WorkerError as error:
                self._error = error
        return []


class _Worker:
    def __init__(self, run: Callable[[Task], Row]) -> None:
        context = get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, run), daemon=True)
        try:
            with _interrupts_held():
                self.process.start()
        finally:
            theirs.close()
        self.task: Task | None = None
        self.ready = False

    def begin(self, task: Task) -> None:
        self.task = task
        with suppress(OSError):  # it died while it was idle, which shows when it is asked for its answer
            self.connection.send(task)

    def end(self) -> str:
        self.connection.close()
        self.process.join(5.0)
        code = self.process.exitcode
        if code is not None and code < 0:
            name = signal.Signals(-code).name
            return f"{name}, as when memory runs out" if name == "SIGKILL" else name
        return f"exit code {code}"


def _serve(pipe: Any, run: Callable[[Task], Row]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the sweep ends this one
    _end_with_parent()
    os.environ["MUJOCO_GL"] = "disable"  # no pictures here; looking for a display starts a process that outlives a kill
    try:
        import plantar.sim.run.runner  # noqa: F401  the heavy part, so that what dies from here on died of its run
    except (ImportError, OSError) as error:
        pipe.send(("error", WorkerError(f"a worker cannot load what it needs: {error}")))
        return
    with suppress(EOFError, OSError):  # the sweep has ended
        pipe.send(("ready", None))
        while True:
            pipe.send(_answer(run, pipe.recv()))


def _answer(run: Callable[[Task], Row], task: Task) -> tuple[str, Row | PlantarError]:
    try:
        return "row", run(task)
    except PlantarError as error:
        return "error", error
    except ImportError as error:
        return "error", WorkerError(f"a worker cannot load what it needs: {error}")


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:

        def watch() -> None:
            parent.join()
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
