"""Many runs: a scene over a grid of settings and seeds, on this machine's cores or on a Dask cluster.

Every finished run is a row that is appended to results.csv at once, so a sweep that was stopped goes on where it was.
"""

from __future__ import annotations

import csv
import itertools
import json
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import parent_process
from pathlib import Path
from typing import Any

from plantar.errors import DependencyError, InputError, PlantarError
from plantar.plotting import COLOURS, new_figure, save_figure
from sim.robots import load_robot
from sim.scene import load_scene

__all__ = ["Sweep", "figures_of", "run_one", "run_sweep"]

Progress = Callable[[float, str], None]

_COLUMNS = (
    "completed",
    "fell",
    "steps_planned",
    "steps_taken",
    "sim_time_s",
    "real_time_factor",
    "tilt_max_deg",
    "zmp_margin_min_m",
    "impact_median_N",
    "impact_max_N",
    "position_error_m",
    "heading_error_deg",
    "com_error_max_m",
    "control_p99_us",
    "replans",
    "foothold_error_p95_m",
    "area_ratios",
    "zmp_margins_mm",
    "error",
)


@dataclass(frozen=True)
class Sweep:
    """What a sweep runs.

    Attributes:
        scene: Name or file of the scene.
        grid: For each setting the values to try, as texts.
        seeds: Number of seeds, from 0.
        robot: Robot to use instead of the scene's, or None.
        settings: Settings that hold for all runs.
    """

    scene: str
    grid: tuple[tuple[str, tuple[str, ...]], ...] = ()
    seeds: int = 1
    robot: str | None = None
    settings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.seeds < 1:
            raise InputError(f"number of seeds is {self.seeds}; allowed: 1 or more")
        names = [name for name, _ in self.grid]
        if len(set(names)) != len(names):
            raise InputError(f"a grid names the same key twice: {', '.join(names)}")
        for name, values in self.grid:
            if len(set(values)) != len(values):
                raise InputError(f"a grid gives '{name}' the same value twice: {', '.join(values)}")
        for settings in self.points():  # every point is checked before the first run
            load_robot(load_scene(self.scene, [*self.settings, *settings], self.robot).robot)

    @classmethod
    def from_texts(
        cls, scene: str, grid: Sequence[str], seeds: int, robot: str | None = None, settings: Sequence[str] = ()
    ) -> Sweep:
        """A sweep from the command line's texts.

        Args:
            scene: Name or file of the scene.
            grid: Texts of the form "key=a,b,c".
            seeds: Number of seeds.
            robot: Robot to use instead of the scene's.
            settings: Texts of the form "key=value" that hold for all runs.

        Returns:
            The checked sweep.

        Raises:
            InputError: If a grid text is not of that form.
            SceneError: If a setting is unknown or not allowed.
            RobotError: If the robot is unknown or its file not valid.
        """
        axes = []
        for text in grid:
            key, equals, values = text.partition("=")
            found = tuple(v.strip() for v in values.split(",") if v.strip())
            if not equals or not key.strip() or not found:
                raise InputError(f"grid {text!r} is not of the form key=a,b,c")
            axes.append((key.strip(), found))
        return cls(scene, tuple(axes), seeds, robot, tuple(settings))

    def points(self) -> list[tuple[str, ...]]:
        """Settings of every grid point."""
        axes = [[f"{name}={value}" for value in values] for name, values in self.grid]
        return list(itertools.product(*axes))

    def tasks(self) -> Iterator[tuple[tuple[str, ...], int]]:
        """Settings and seed of every run: all points for one seed before the next, so that a part shows the whole."""
        for seed in range(self.seeds):
            for point in self.points():
                yield point, seed


def run_one(scene: str, robot: str | None, settings: Sequence[str], seed: int) -> dict[str, Any]:
    """One run as a flat row; an error of the scenario becomes a row too.

    Args:
        scene: Name or file of the scene.
        robot: Robot to use instead of the scene's, or None.
        settings: "key=value" settings.
        seed: Seed.

    Returns:
        Values of the result columns.
    """
    from sim.runner import run_scene

    row: dict[str, Any] = dict.fromkeys(_COLUMNS, "")
    try:
        summary = run_scene(load_scene(scene, settings, robot), seed)
    except PlantarError as error:
        return row | {"completed": False, "error": str(error)}
    impacts = sorted(summary["impacts_N"])
    return (
        row
        | {name: summary[name] for name in _COLUMNS if name in summary}
        | {
            "impact_median_N": impacts[len(impacts) // 2] if impacts else "",
            "impact_max_N": impacts[-1] if impacts else "",
            "position_error_m": summary["final"]["position_error_m"],
            "heading_error_deg": summary["final"]["heading_error_deg"],
            "com_error_max_m": max(summary["estimate"]["com_error_max_m"]),
            "control_p99_us": summary["control_us"]["p99"],
            "foothold_error_p95_m": summary.get("footholds", {}).get("centroid_error_m", {}).get("p95", ""),
            # A value a landing, in their order.
            "area_ratios": " ".join(f"{v:g}" for v in summary["contact_area_ratio"]),
            "zmp_margins_mm": " ".join("-" if v is None else f"{1e3 * v:.1f}" for v in summary["zmp_margins_m"]),
        }
    )


def _end_with_parent() -> None:
    """End this worker when the sweep is killed; it would wait for tasks for ever."""
    parent = parent_process()
    if parent is not None:

        def watch() -> None:
            parent.join()
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _executor(workers: int, scheduler: str | None) -> Iterator[Executor]:
    if scheduler is None:
        from multiprocessing import get_context

        with ProcessPoolExecutor(workers, get_context("spawn"), initializer=_end_with_parent) as pool:
            yield pool
        return
    try:
        from distributed import Client
    except ImportError:
        raise DependencyError("distributed", "cluster") from None
    try:
        client = Client(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise InputError(f"no Dask scheduler answers at {scheduler}: {error}") from None
    with client:
        yield client.get_executor()


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
        "points": for each grid point its settings, runs, completed, and the errors of runs that could not be; "runs",
        "resumed", "files".

    Raises:
        InputError: If the folder cannot be written, or holds the results of another sweep.
    """
    if workers < 1:
        raise InputError(f"number of workers is {workers}; allowed: 1 or more")
    path, plan = folder / "results.csv", folder / "sweep.json"
    axes = [name for name, _ in sweep.grid]
    header = [*axes, "seed", *_COLUMNS]
    identity = {"scene": sweep.scene, "robot": sweep.robot, "settings": list(sweep.settings), "axes": axes}
    rows = _resume(path, plan, header, identity)
    done = {(tuple(f"{a}={r[a]}" for a in axes), int(r["seed"])) for r in rows}
    open_tasks = [t for t in sweep.tasks() if t not in done]
    resumed, total = len(rows), len(rows) + len(open_tasks)
    with path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, header)
        with _executor(min(workers, max(1, len(open_tasks))), scheduler) as pool:
            futures: dict[Future[dict[str, Any]], tuple[tuple[str, ...], int]] = {
                pool.submit(run_one, sweep.scene, sweep.robot, [*sweep.settings, *point], seed): (point, seed)
                for point, seed in open_tasks
            }
            for future in as_completed(futures):
                point, seed = futures[future]
                values = dict(s.split("=", 1) for s in point)
                row = {k: str(v) for k, v in {**values, "seed": seed, **future.result()}.items()}
                writer.writerow(row)
                file.flush()
                rows.append(row)
                if progress is not None:
                    progress(len(rows) / total, f"{len(rows)} of {total} runs")
    points = []
    for point in sweep.points():
        values = dict(s.split("=", 1) for s in point)
        mine = [r for r in rows if all(r[a] == values[a] for a in axes) and int(r["seed"]) < sweep.seeds]
        completed = sum(r["completed"] == "True" for r in mine)
        errors = [r["error"] for r in mine if r["error"]]
        points.append({"settings": values, "runs": len(mine), "completed": completed, "errors": errors})
    figure = save_figure(figures_of(points, sweep.scene), folder / "completed.png")
    return {"points": points, "runs": len(open_tasks), "resumed": resumed, "files": [str(path), str(figure)]}


def _resume(path: Path, plan: Path, header: list[str], identity: dict[str, Any]) -> list[dict[str, str]]:
    """Rows of an earlier part of the same sweep; starts the files where there are none."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if plan.exists() and path.exists():
            if json.loads(plan.read_text(encoding="utf-8")) != identity:
                raise InputError(f"{path.parent} holds the results of another sweep; choose another folder with -o")
            with path.open(newline="", encoding="utf-8") as file:
                rows = [r for r in csv.DictReader(file) if None not in r.values() and None not in r]
            # A run that was killed while it wrote may have left half a row: write back what is whole.
            with path.open("w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, header)
                writer.writeheader()
                writer.writerows(rows)
            return rows
        plan.write_text(json.dumps(identity) + "\n", encoding="utf-8")
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.DictWriter(file, header).writeheader()
        return []
    except (OSError, ValueError) as error:
        raise InputError(f"sweep folder {path.parent} cannot be used ({error}); choose another one with -o") from None


def figures_of(points: Sequence[dict[str, Any]], scene: str) -> Any:
    """Bars of completed runs for every grid point.

    Args:
        points: "points" of `run_sweep`'s result.
        scene: Name for the title.

    Returns:
        The figure.
    """
    figure, axis = new_figure(max(5.0, 1.2 + 1.05 * len(points)), 4.0)
    names = ["\n".join(f"{k}={v}" for k, v in p["settings"].items()) or scene for p in points]
    shares = [100.0 * p["completed"] / p["runs"] if p["runs"] else 0.0 for p in points]
    bars = axis.bar(range(len(points)), shares, color=COLOURS["polygon"])
    axis.bar_label(bars, [f"{p['completed']}/{p['runs']}" for p in points], fontsize=8)
    axis.set_xticks(range(len(points)), names, fontsize=7)
    axis.set_ylim(0.0, 110.0)
    axis.set_ylabel("completed runs [%]")
    axis.set_title(f"scene '{scene}'")
    return figure
