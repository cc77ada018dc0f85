"""Many runs of a scene, each appended to results.csv at once: a stopped sweep continues."""

import os
import signal
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from plantar.common.workers.cluster_workers import ClusterWorkers
from plantar.common.workers.local_workers import LocalWorkers
from plantar.errors import InputError, WorkerError
from plantar.plotting import save_figure
from plantar.sim.sweep.figures import figures_of
from plantar.sim.sweep.inputs import inputs_of
from plantar.sim.sweep.plan import Key, Plan, Rows, key_of
from plantar.sim.sweep.results import open_results
from plantar.sim.sweep.task import JOB, Task, columns_of

Progress = Callable[[float, str], None]
_SIGNALS = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM"}


class SweepStopped(KeyboardInterrupt):
    """The signal `number` ended a sweep; `kept` names what is kept."""

    def __init__(self, number: int, kept: str = "no run was begun") -> None:
        super().__init__(f"stopped by {_SIGNALS.get(signal.Signals(number), number)}: {kept}")
        self.number = number


@dataclass
class StopNote:
    """The first signal that asked for a stop, or 0."""

    number: int = 0

    def take(self, number: int, frame: Any) -> None:
        """Handle a signal `number` in any `frame`."""
        self.number = self.number or number


@contextmanager
def stop_noted() -> Iterator[StopNote]:
    """Only note both signals during this, in the main thread: a row is written whole, then the sweep ends."""
    note = StopNote()
    before: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        # Who ignores a signal (nohup, a shell's background) goes on ignoring it.
        before = {n: signal.getsignal(n) for n in _SIGNALS if signal.getsignal(n) not in (signal.SIG_IGN, None)}
    try:
        for number in before:
            signal.signal(number, note.take)
        yield note
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run_sweep(
    plan: Plan,
    folder: str | os.PathLike[str],
    *,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Run what results.csv in a `folder` (made if needed) lacks of a `plan`, append each run, and draw figures.

    `workers` is the number of processes on this machine, `scheduler` a Dask scheduler's address to use instead.
    `progress` gets fraction done and text. Returns the plan's `found` for all rows, and "runs", "resumed", "files".

    An InputError if folder, scheduler or inputs fail; a WorkerError if workers do, and SweepStopped after Ctrl-C or
    SIGTERM, which name the kept rows.
    """
    if workers < 1:
        raise InputError(f"number of workers is {workers}; allowed: 1 or more")
    folder = Path(folder)
    checked = plan.checked
    points = checked.points()
    columns = columns_of(checked.opened(points[0]))
    inputs = {robot: inputs_of(checked.scene, robot) for robot in dict.fromkeys(map(checked.robot_of, points))}
    with (
        stop_noted() as note,
        open_results(folder, plan.identity(), inputs, checked.axes, columns) as table,
        closing(LocalWorkers(workers, JOB) if scheduler is None else ClusterWorkers(scheduler, JOB)) as pool,
    ):
        before = len(table.rows)
        tasks = _Tasks(plan, inputs, table.rows)
        try:
            for task, row in pool.rows(iter(tasks), lambda: note.number != 0):
                values, seed = tasks.keys[task]
                table.append({**dict(zip(checked.axes, values, strict=True)), "seed": seed, **row})
                if progress is not None:
                    progress(*plan.progress(table.rows))
            if note.number:
                raise SweepStopped(note.number)
        except (SweepStopped, InputError, WorkerError) as error:
            kept = f"kept {plan.progress(table.rows)[1]} in {table.path}; the same command goes on from there"
            if isinstance(error, SweepStopped):
                raise SweepStopped(error.number, kept) from None
            raise type(error)(f"{error}: {kept}") from None
        found = plan.found(table.rows)
        figures = [
            str(save_figure(figure, folder / f"{name}.png"))
            for name, figure in figures_of(plan, found, table.rows).items()
        ]
        ran = len(table.rows) - before
    return {**found, "runs": ran, "resumed": tasks.count - ran, "files": [str(table.path), *figures]}


class _Tasks:
    """A plan's runs without a row, as tasks; None while the next depends on rows to come."""

    def __init__(self, plan: Plan, inputs: Mapping[str, Mapping[str, str]], rows: Rows) -> None:
        self._plan = plan
        self._inputs = inputs
        self._rows = rows
        self.keys: dict[Task, Key] = {}
        self.count = 0

    def __iter__(self) -> Iterator[Task | None]:
        checked = self._plan.checked
        for run in self._plan.runs(self._rows):
            if run is None:
                yield None
                continue
            self.count += 1
            if key_of(*run) in self._rows:
                continue
            point, seed = run
            robot = checked.robot_of(point)
            inputs = tuple(self._inputs[robot].items())
            task = Task(_anywhere(checked.scene), _anywhere(robot), (*checked.settings, *point), seed, inputs)
            self.keys[task] = key_of(*run)
            yield task


def _anywhere(name: str) -> str:
    return str(Path(name).absolute()) if Path(name).suffix == ".toml" else name
