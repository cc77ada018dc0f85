"""Outcomes of scenes over seeds, by runs that may be stopped: a row a run, appended as it ends, never changed.

A case is counted on two sets of seeds: those from 0 on, which gains and thresholds were chosen by, and ten from 1000
on, which nothing was ever tuned on. Every row names the commit that it was made at. Where a seed has more rows than
one, the last one counts.
"""

from __future__ import annotations

import csv
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

__all__ = [
    "FRESH",
    "OLD",
    "Benchmark",
    "Case",
    "add_row",
    "commit",
    "count",
    "latest",
    "origin",
    "rows_of",
    "run_for",
    "show",
    "wanted",
    "write_table",
]

FRESH = range(1000, 1010)
"""Seeds that nothing was tuned on."""

OLD = "4ef602d"
"""Rows of this commit are from before steps were counted by place, legs collided and joints kept their speed limits."""

AGAIN = 4
"""So many of an old case's first seeds are run again; all of them where a verdict changed."""

FEW = 4
"""So many fresh seeds a case gets that is there for comparison only."""


class Case(NamedTuple):
    """Runs of one scene that differ in their seed alone.

    Attributes:
        name: Name.
        scene: Scene.
        robot: Robot.
        settings: Settings of the scene.
        seeds: How many seeds from 0 on.
        aside: Whether it is there for comparison only, as the walk without the feature.
        file: File of a robot that is not built in; empty for one that is.
    """

    name: str
    scene: str
    robot: str
    settings: tuple[str, ...]
    seeds: int
    aside: bool = False
    file: str = ""


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

    Fresh seeds of all cases and old seeds once more come first, and all seeds of cases whose verdict changed; cases for
    comparison come last.
    """
    rows = rows_of(benchmark.path)
    verdicts: dict[tuple[str, str, int], list[tuple[str, bool]]] = {}
    for r in rows:
        key = (r["case"], r["robot"], int(r["seed"]))
        verdicts.setdefault(key, []).append((r["commit"], r["completed"] == "True"))
    for case in benchmark.cases:

        def runs(seed: int, case: Case = case) -> list[tuple[str, bool]]:
            return verdicts.get((case.name, case.robot, seed), [])

        def is_old(seed: int) -> bool:
            return all(made == OLD for made, _ in runs(seed))

        changed = any(len({good for _, good in runs(seed)}) > 1 for seed in range(case.seeds))
        later = 100 if case.aside else 0
        for i, seed in enumerate(FRESH):
            if not runs(seed) and not (case.aside and i >= FEW):
                yield later + i, case, seed
        for seed in range(case.seeds):
            never = not runs(seed) and not case.aside  # of a comparison some seeds are enough
            if is_old(seed) and (seed < AGAIN or (changed and runs(seed)) or never):
                yield later + (seed if seed < AGAIN or changed else 20 + seed), case, seed


def add_row(benchmark: Benchmark, case: Case, seed: int, made: str) -> dict[str, Any]:
    """Run a case with one seed and append its row.

    Args:
        benchmark: What it belongs to.
        case: The case.
        seed: The seed.
        made: Name of the commit.

    Returns:
        The row.
    """
    from sim.run.runner import Simulation
    from sim.run.scene import load_scene

    simulation = Simulation(load_scene(case.scene, case.settings, case.file or case.robot), seed)
    with TemporaryDirectory() as folder:
        recording = Path(folder, "run.mcap") if benchmark.recorded else None
        summary = simulation.run(record=recording)
        found = benchmark.figures(simulation, {**summary, "recording": recording})
    row = {
        "case": case.name,
        "robot": case.robot,
        "seed": seed,
        "completed": summary["completed"],
        "failed": " ".join(r["criterion"] for r in summary["reasons"]),
        "commit": made,
        **found,
    }
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


def run_for(benchmark: Benchmark, jobs: Iterable[tuple[Any, Case, int]], minutes: float) -> None:
    """Run what is missing for some minutes, the lowest rank first.

    Args:
        benchmark: What is counted.
        jobs: Runs that are missing, each with its rank.
        minutes: For how long; a run that has begun is ended.
    """
    end, made = time.monotonic() + 60.0 * minutes, commit()
    for _, case, seed in sorted(jobs, key=lambda job: job[0]):
        if time.monotonic() > end:
            break
        show(add_row(benchmark, case, seed, made))


def count(rows: Sequence[dict[str, str]], fresh: bool) -> str:
    """How many runs were completed of those on fresh seeds, or on the others, for a table.

    Old rows of which some seeds were run again are marked with how many; fresh seeds that are not run yet with a plus.
    """
    mine = [r for r in latest(rows) if (int(r["seed"]) >= FRESH.start) == fresh]
    if not mine:
        return "-"
    text = f"{sum(r['completed'] == 'True' for r in mine)}/{len(mine)}"
    if fresh:
        return text
    again = sum(r["commit"] != OLD for r in mine)
    return text if again == len(mine) else f"{text} ({again} again)" if again else f"{text} (old)"


def origin(benchmark: Benchmark) -> str:
    """Which commits the rows that count were made at, and how many fresh seeds are still to come, for under a table."""
    rows = latest(rows_of(benchmark.path))
    made: dict[str, int] = {}
    for r in rows:
        made[r["commit"]] = made.get(r["commit"], 0) + 1
    text = ", ".join(
        f"{n} of {c}{' or before' if c == OLD else ''}" for c, n in sorted(made.items(), key=lambda m: -m[1])
    )
    missing = [seed for _, _, seed in wanted(benchmark)]
    fresh = sum(seed >= FRESH.start for seed in missing)
    return f"Runs by commit: {text}. Still to be run: {fresh} on fresh seeds, {len(missing) - fresh} on the others."


def write_table(path: Path, lines: Sequence[str], name: str = "table") -> None:
    """Put lines between a text's markers <!-- name --> and <!-- end -->."""
    text = path.read_text(encoding="utf-8")
    before, marker, rest = text.partition(f"<!-- {name} -->\n")
    after = rest.partition("<!-- end -->\n")[2]
    path.write_text(before + marker + "\n".join(lines) + f"\n<!-- end -->\n{after}", encoding="utf-8")


def show(row: dict[str, Any]) -> None:
    """Say what came out of a run."""
    print(
        f"{row['case']} {row['robot']} {row['seed']}: {row['completed']} {row['failed']}", file=sys.stderr, flush=True
    )
