"""What runs tasks, as futures."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from typing import Any

from plantar.errors import PlantarError

Task = Any
Row = Any
"""What a task is, which is hashable, and what comes of it: both are sent to other processes."""

_PAUSE = 0.2  # s: how soon a signal is seen where no row comes
_END = object()

TRIES = 3
"""How often a task is begun before its row reports that its workers died."""


@dataclass(frozen=True)
class Job:
    """What workers do with tasks.

    `run`: importable function of a task that returns its row; `failed`: of a reason, the row of a task whose workers
    died; `load`: importable function without arguments that loads what `run` needs, so that what dies later died of
    its task.
    """

    run: Callable[[Any], Row]
    failed: Callable[[str], Row]
    load: Callable[[], object] = bool


class Workers(ABC):
    """Runs tasks."""

    def __init__(self) -> None:
        self._running: dict[Future[Row], Task] = {}
        self._error: PlantarError | None = None

    @property
    def room(self) -> int:
        """How many more tasks can be taken."""
        return self._capacity() - len(self._running)

    def rows(
        self, tasks: Iterator[Task | None], stopped: Callable[[], bool] = lambda: False
    ) -> Iterator[tuple[Task, Row]]:
        """Yields tasks and rows as they end, until there are none or `stopped`.

        `tasks`: in the order they begin, each asked for when there is room; None while the next depends on rows to
        come. Errors as of `finished`.
        """
        more = True
        while not stopped():
            while more and self.room > 0:
                task = next(tasks, _END)
                if task is None:
                    break
                if task is _END:
                    more = False
                else:
                    self.submit(task)
            if not self._running and self._error is None:
                return
            yield from self.finished(_PAUSE)

    def submit(self, task: Task) -> None:
        """Begin a task."""
        self._running[self._begin(task)] = task

    def finished(self, timeout: float) -> Sequence[tuple[Task, Row]]:
        """Wait for a task's end, or a time in s; return ended tasks with rows.

        Raises:
            WorkerError: If the workers cannot go on.
            PlantarError: If no run is possible.
        """
        if self._error is None:
            done = wait(self._running, timeout, FIRST_COMPLETED).done
            rows = [found for future in done for found in self._taken(future)]
            if rows:
                return rows
        if self._error is not None:
            raise self._error
        self._check()
        return []

    def _taken(self, future: Future[Row]) -> list[tuple[Task, Row]]:
        task = self._running.pop(future)
        try:
            return [(task, row) for row in self._outcome(task, future)]
        except PlantarError as error:  # raised after the rows that have come
            self._error = error
            return []

    @abstractmethod
    def close(self) -> None:
        """End the workers at once."""

    @abstractmethod
    def _capacity(self) -> int:
        """How many tasks may run."""

    @abstractmethod
    def _begin(self, task: Task) -> Future[Row]: ...

    @abstractmethod
    def _outcome(self, task: Task, future: Future[Row]) -> Sequence[Row]:
        """The row of an ended task; none where it was begun again."""

    @abstractmethod
    def _check(self) -> None:
        """Raise a WorkerError if no row will come any more."""
