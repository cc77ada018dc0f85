"""Runs of a benchmark that may be stopped: a row a run, appended as it ends; a run that is there is not repeated."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, NamedTuple

__all__ = ["Case", "rows_of", "run_missing", "write_table"]


class Case(NamedTuple):
    """Runs of one scene that differ in their seed alone."""

    name: str
    scene: str
    robot: str
    settings: tuple[str, ...]
    seeds: int


def rows_of(path: Path) -> list[dict[str, str]]:
    """Rows that are there already."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def run_missing(
    path: Path,
    columns: Sequence[str],
    cases: Sequence[Case],
    run: Callable[[Case, int], dict[str, Any]],
    workers: int = 2,
) -> list[dict[str, str]]:
    """Run every case over its seeds, first seeds first, and return all rows.

    Args:
        path: The CSV file; rows are appended, their first columns are case, robot and seed.
        columns: Its columns after those.
        cases: What to run.
        run: One run as a row.
        workers: Processes.
    """
    done = {(r["case"], r["robot"], int(r["seed"])) for r in rows_of(path)}
    jobs = [(c, k) for c in cases for k in range(c.seeds) if (c.name, c.robot, k) not in done]
    jobs.sort(key=lambda job: job[1])
    with path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ("case", "robot", "seed", *columns), lineterminator="\n")
        if not done:
            writer.writeheader()
        with ProcessPoolExecutor(workers) as pool:
            futures = {pool.submit(run, case, seed): (case, seed) for case, seed in jobs}
            for i, future in enumerate(as_completed(futures)):
                case, seed = futures[future]
                row = future.result()
                writer.writerow({"case": case.name, "robot": case.robot, "seed": seed, **row})
                file.flush()
                print(f"{i + 1}/{len(jobs)} {case.name} {case.robot} {seed}: {row['completed']}", file=sys.stderr)
    return rows_of(path)


def write_table(path: Path, lines: Sequence[str], name: str = "table") -> None:
    """Put lines between a text's markers <!-- name --> and <!-- end -->."""
    text = path.read_text(encoding="utf-8")
    before, marker, rest = text.partition(f"<!-- {name} -->\n")
    after = rest.partition("<!-- end -->\n")[2]
    path.write_text(before + marker + "\n".join(lines) + f"\n<!-- end -->\n{after}", encoding="utf-8")
