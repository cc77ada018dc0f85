"""Many runs: a scene over a grid of settings and seeds, on this machine's cores or on a Dask cluster.

Every finished run is a row that is appended to results.csv at once, so a sweep that was stopped goes on where it was.
"""

from __future__ import annotations

import signal
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from plantar.errors import InputError, WorkerError
from plantar.plotting import COLOURS, new_figure, save_figure
from sim.sweep.cluster import ClusterWorkers
from sim.sweep.inputs import inputs_of
from sim.sweep.plan import Sweep
from sim.sweep.results import Key, Results, open_results
from sim.sweep.stopping import StopNote, SweepStopped, stop_noted
from sim.sweep.task import Row, Task, columns_of, criteria_of
from sim.sweep.workers import LocalWorkers, Workers

__all__ = ["figures_of", "run_sweep"]

Progress = Callable[[float, str], None]

_WIDEST = 40.0  # inches of a figure
_PAUSE = 0.2  # s: how soon a signal is seen where no row comes


def run_sweep(
    sweep: Sweep,
    folder: Path,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Run what is not in results.csv yet, append each run as it ends, and draw the figures.

    Args:
        sweep: What to run.
        folder: Folder of results.csv; made if needed. A folder of another sweep is refused.
        workers: Processes on this machine.
        scheduler: Address of a Dask scheduler that runs them instead.
        progress: Called with the fraction done and a text.

    Returns:
        "points": for each grid point its settings, runs, completed, how many runs failed each criterion ("reasons"),
        and the errors of runs that could not be; "runs", "resumed", "files".

    Raises:
        InputError: If the folder cannot be written, holds the results of another sweep, or another process writes to
            it; if no scheduler answers; if a file that runs depend on has changed since the sweep began, also where
            it began earlier or a worker runs.
        WorkerError: If the workers cannot go on. What was kept is in the text.
        SweepStopped: A KeyboardInterrupt after Ctrl-C or SIGTERM that says what was kept.
    """
    if workers < 1:
        raise InputError(f"number of workers is {workers}; allowed: 1 or more")
    axes = [name for name, _ in sweep.grid]
    columns = columns_of(sweep.opened(sweep.points()[0]))
    robots = {point: sweep.robot_of(point) for point in sweep.points()}
    inputs = {robot: inputs_of(sweep.scene, robot) for robot in dict.fromkeys(robots.values())}
    with (
        stop_noted() as note,
        _workers(workers, scheduler) as pool,
        open_results(folder, sweep.identity(), inputs, axes, columns) as results,
    ):
        keys = {_key(point, seed): (point, seed) for point, seed in sweep.tasks()}
        tasks = {
            Task(
                scene=_anywhere(sweep.scene),
                robot=_anywhere(robots[point]),
                settings=(*sweep.settings, *point),
                seed=seed,
                inputs=tuple(inputs[robots[point]].items()),
            ): key
            for key, (point, seed) in keys.items()
            if key not in results.rows
        }
        resumed = done = len(keys) - len(tasks)
        try:
            with note.held():
                for task, row in _rows_of(tasks, pool, note):
                    values, seed = tasks[task]
                    empty = dict.fromkeys(columns, "")
                    results.append({**empty, **dict(zip(axes, values, strict=True)), "seed": seed, **row})
                    done += 1
                    if progress is not None:
                        progress(done / len(keys), f"{done} of {len(keys)} runs")
            points = [_point(sweep, point, results) for point in sweep.points()]
            figure = save_figure(figures_of(points, sweep.scene), folder / "completed.png")
        except (KeyboardInterrupt, InputError, WorkerError) as error:
            kept = f"kept {done} of {len(keys)} rows in {results.path}; the same command goes on from there"
            if isinstance(error, KeyboardInterrupt):
                raise SweepStopped(note.number or signal.SIGINT, kept) from None
            raise type(error)(f"{error}: {kept}") from None
    return {
        "points": points,
        "runs": len(tasks),
        "resumed": resumed,
        "files": [str(results.path), str(figure)],
    }


@contextmanager
def _workers(count: int, scheduler: str | None) -> Iterator[Workers]:
    pool = LocalWorkers(count) if scheduler is None else ClusterWorkers(scheduler)
    try:
        yield pool
    finally:
        pool.close()


def _rows_of(tasks: Iterable[Task], pool: Workers, note: StopNote) -> Iterator[tuple[Task, Row]]:
    """Run tasks, as many at a time as there is room for, until all have given their rows or a signal comes."""
    waiting = deque(tasks)
    running = 0
    while (waiting or running) and not note.number:
        while waiting and pool.room > 0:
            pool.submit(waiting.popleft())
            running += 1
        for task, row in pool.finished(_PAUSE):
            running -= 1
            yield task, row


def _anywhere(name: str) -> str:
    """A scene's or robot's name or file as a worker in another folder finds it."""
    return str(Path(name).absolute()) if Path(name).suffix == ".toml" else name


def _values(point: Sequence[str]) -> dict[str, str]:
    """Values of a grid point by their settings."""
    return {name: value for name, _, value in (setting.partition("=") for setting in point)}


def _key(point: Sequence[str], seed: int) -> Key:
    return tuple(_values(point).values()), seed


def _point(sweep: Sweep, point: Sequence[str], results: Results) -> dict[str, Any]:
    """What a grid point came to over its seeds."""
    rows = [results.rows[_key(point, seed)] for seed in sweep.seed_range]
    return {
        "settings": _values(point),
        "runs": len(rows),
        "completed": sum(r["completed"] == "True" for r in rows),
        "reasons": dict(Counter(criterion for r in rows for criterion in criteria_of(r)).most_common()),
        "errors": [r["error"] for r in rows if r["error"]],
    }


def figures_of(points: Sequence[dict[str, Any]], scene: str) -> Any:
    """Bars of completed runs for every grid point.

    Args:
        points: "points" of `run_sweep`'s result.
        scene: Name for the title.

    Returns:
        The figure.
    """
    figure, axis = new_figure(min(max(5.0, 1.2 + 1.05 * len(points)), _WIDEST), 4.0)
    names = ["\n".join(f"{k}={v}" for k, v in p["settings"].items()) or scene for p in points]
    shares = [100.0 * p["completed"] / p["runs"] if p["runs"] else 0.0 for p in points]
    bars = axis.bar(range(len(points)), shares, color=COLOURS["polygon"])
    if 1.05 * len(points) < _WIDEST:
        axis.bar_label(bars, [f"{p['completed']}/{p['runs']}" for p in points], fontsize=8)
        axis.set_xticks(range(len(points)), names, fontsize=7)
    else:  # no room for words
        axis.set_xlabel("grid point, counted from 0 in the order of the settings")
    axis.set_ylim(0.0, 110.0)
    axis.set_ylabel("completed runs [%]")
    axis.set_title(f"scene '{scene}'")
    return figure
