"""Outcomes of scenes over seeds, by runs that may be stopped: a row a run, appended as it ends, never changed.

A case is counted on two sets of seeds: those from 0 on, which gains and thresholds were chosen by, and fresh ones from
1000 on, which nothing was ever tuned on. Every row names the commit that it was made at. Where a seed has more rows
than one, the last one counts.
"""

from __future__ import annotations

import csv
import os
import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

__all__ = [
    "FEW",
    "FRESH",
    "Benchmark",
    "Case",
    "add_row",
    "commit",
    "count",
    "differences",
    "latest",
    "origin",
    "rows_of",
    "run_row",
    "wanted",
    "write_table",
]

FRESH = 1000
"""The first of the seeds that nothing was tuned on."""

FEW = 4
"""So many seeds of either set come early of a case that is there for comparison only."""


class Case(NamedTuple):
    """Runs of one scene that differ in their seed alone.

    Attributes:
        name: Name.
        scene: Scene.
        robot: Robot.
        settings: Settings of the scene.
        seeds: How many seeds from 0 on.
        aside: Whether it is there for comparison only, as the walk without the feature; its runs come last.
        file: File of a robot that is not built in; empty for one that is.
        fresh: How many seeds from 1000 on.
    """

    name: str
    scene: str
    robot: str
    settings: tuple[str, ...]
    seeds: int
    aside: bool = False
    file: str = ""
    fresh: int = 10


class Benchmark(NamedTuple):
    """What one script counts.

    Attributes:
        path: The CSV file; its first columns are case, robot, seed, completed, failed and commit.
        columns: Its columns after those.
        cases: What to run.
        figures: Values of those columns from a simulation that has run, and its summary.
        recorded: Whether `figures` wants the run's recording, whose path is then the summary's "recording".
    """

    path: Path
    columns: tuple[str, ...]
    cases: Sequence[Case]
    figures: Callable[[Any, dict[str, Any]], dict[str, Any]]
    recorded: bool = False


def commit() -> str:
    """Short name of the commit that is checked out."""
    folder = Path(__file__).parent
    found = subprocess.run(["git", "rev-parse", "--short=7", "HEAD"], cwd=folder, capture_output=True, text=True)
    return found.stdout.strip() or "unknown"


def rows_of(path: Path) -> list[dict[str, str]]:
    """All rows, in the order in which they were made."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def latest(rows: Iterable[dict[str, str]]) -> list[dict[str, str]]:
    """The row that counts of each run."""
    return list({(r["case"], r["robot"], r["seed"]): r for r in rows}.values())


def wanted(benchmark: Benchmark) -> Iterator[tuple[int, Case, int]]:
    """Runs that are missing, each with its rank: the lower, the more it tells.

    Ten fresh seeds of all cases come first, then all the others, then cases for comparison.
    """
    done = {(r["case"], r["robot"], int(r["seed"])) for r in rows_of(benchmark.path)}
    for case in benchmark.cases:
        for first, seeds in ((FRESH, case.fresh), (0, case.seeds)):
            for i in range(seeds):
                if (case.name, case.robot, first + i) not in done:
                    yield rank(case, first, i), case, first + i


def rank(case: Case, first: int, i: int) -> int:
    """Place in the order of runs of a case's i-th seed, counted from `first`."""
    if case.aside:
        return (60 if i < FEW else 80) + i
    return i if first == FRESH else 10 + i


def run_row(benchmark: Benchmark, case: Case, seed: int, made: str) -> dict[str, Any]:
    """Run a case with one seed.

    Args:
        benchmark: What it belongs to.
        case: The case.
        seed: The seed.
        made: Name of the commit.

    Returns:
        Its row.
    """
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    simulation = Simulation(load_scene(case.scene, case.settings, case.file or case.robot), seed)
    with TemporaryDirectory() as folder:
        recording = Path(folder, "run.mcap") if benchmark.recorded else None
        summary = simulation.run(record=recording)
        found = benchmark.figures(simulation, {**summary, "recording": recording})
    return {
        "case": case.name,
        "robot": case.robot,
        "seed": seed,
        "completed": summary["completed"],
        "failed": " ".join(r["criterion"] for r in summary["reasons"]),
        "commit": made,
        **found,
    }


def add_row(benchmark: Benchmark, case: Case, seed: int, made: str) -> dict[str, Any]:
    """`run_row`, appended to the benchmark's file."""
    row = run_row(benchmark, case, seed, made)
    columns = ("case", "robot", "seed", "completed", "failed", "commit", *benchmark.columns)
    new = not benchmark.path.exists()
    with benchmark.path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerow(row)
        file.flush()
        os.fsync(file.fileno())
    return row


def differences(row: dict[str, str], again: dict[str, Any]) -> list[str]:
    """Columns in which a row and what it comes to when it is run again are not the same text; times of a machine, and
    the commit, are left out."""
    timed = ("_us", "real_time_factor", "commit")
    texts = {k: "" if again.get(k) is None else str(again[k]) for k in row}
    return [k for k in row if row[k] != texts[k] and not k.endswith(timed)]


def count(rows: Sequence[dict[str, str]], fresh: bool) -> str:
    """How many runs were completed of those on fresh seeds, or on the others, for a table."""
    mine = [r for r in latest(rows) if (int(r["seed"]) >= FRESH) == fresh]
    return f"{sum(r['completed'] == 'True' for r in mine)}/{len(mine)}" if mine else "-"


def origin(benchmark: Benchmark, missing: int | None = None) -> str:
    """Which commits the rows that count were made at, and how many are still to come, for under a table.

    Args:
        benchmark: What is counted.
        missing: How many runs are missing, where the benchmark's cases do not tell.
    """
    rows = latest(rows_of(benchmark.path))
    made: dict[str, int] = {}
    for r in rows:
        made[r["commit"]] = made.get(r["commit"], 0) + 1
    text = ", ".join(f"{n} of {c}" for c, n in sorted(made.items(), key=lambda m: -m[1]))
    left = sum(1 for _ in wanted(benchmark)) if missing is None else missing
    return f"Runs by commit: {text or 'none'}. Still to be run: {left or 'none'}."


def write_table(path: Path, lines: Sequence[str], name: str = "table") -> None:
    """Put lines between a text's markers <!-- name --> and <!-- end -->."""
    text = path.read_text(encoding="utf-8")
    before, marker, rest = text.partition(f"<!-- {name} -->\n")
    after = rest.partition("<!-- end -->\n")[2]
    path.write_text(before + marker + "\n".join(lines) + f"\n<!-- end -->\n{after}", encoding="utf-8")
