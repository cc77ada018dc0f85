"""Counts of scenes over fresh seeds: a case is a sweep in a folder, and all together are a table."""

import csv
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

from plantar.sim.sweep import Sweep, run_sweep

__all__ = ["FIRST", "Row", "SweepCase", "completed", "median_and_range", "rows_of_cases", "run_cases", "write_rows"]

FIRST = 1000
"""First of the seeds, which nothing was tuned on."""

Row = dict[str, str]
"""A run, as the sweep's table has it."""


class SweepCase(NamedTuple):
    """A sweep; `what` is different in it, or empty for the scene itself."""

    scene: str
    what: str = ""
    settings: tuple[str, ...] = ()
    seeds: int = 20

    @property
    def folder(self) -> str:
        return self.scene + "".join(f"-{s.replace('=', '-')}" for s in self.settings)


def run_cases(cases: Iterable[SweepCase], folder: Path) -> None:
    for case in cases:
        sweep = Sweep(case.scene, seeds=case.seeds, settings=case.settings, first_seed=FIRST)
        result = run_sweep(sweep, folder / case.folder)
        print(case.folder, result["points"][0]["completed"], "of", case.seeds, flush=True)


def rows_of_cases(cases: Iterable[SweepCase], folder: Path) -> Iterator[tuple[SweepCase, list[Row]]]:
    """Each case with runs, and its rows."""
    for case in cases:
        path = folder / case.folder / "results.csv"
        if not path.exists():
            continue
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        if rows:
            yield case, rows


def completed(rows: Sequence[Row]) -> str:
    """How many of the runs were completed, as 18/20."""
    return f"{sum(r['completed'] == 'True' for r in rows)}/{len(rows)}"


def median_and_range(rows: Iterable[Row], column: str) -> str:
    """Median and range of a figure over the runs."""
    values = [float(r[column]) for r in rows if r[column] not in ("", "None")]
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})" if values else "-"


def write_rows(path: Path, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)
