"""Outcomes of scenes over seeds: a row a run, appended as it ends, never changed.

A case is counted on plants drawn within what ordinary care leaves (`plant=random`, `level=2`), and where a table says
so on the controller's exact model, too. Seeds are drawn from the commit, so that no version of the code has met them
before, and the first draw is published. A table keeps the rows of the commits that are listed under it.
"""

import csv
import hashlib
import os
import resource
import subprocess
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import mean, median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import markdown_table

FOLDER = Path(__file__).parent

FEW = 4
"""So many seeds of each case come first."""

PLANTS: dict[str, tuple[str, ...]] = {
    "ordinary": ("plant=random", "plant.level=2"),
    "exact": (),
    "own": (),
}
"""Settings of each plant that a case is counted on; "own" is for cases that are about the plant."""

DRAWN = ("ordinary", "own")
"""Plants that differ from the controller's model."""


class Case(NamedTuple):
    """Runs of one scene that differ in their seed alone.

    Attributes:
        settings: Settings of the scene.
        seeds: Number drawn from the commit, for each plant.
        aside: Whether it is for comparison only; its runs come last.
        file: File of a robot that is not built in, or empty.
        plants: Names of the plants that it is counted on.
        kind: What simulates it, `Simulation` or one made of it, where that is not the plain one.
    """

    name: str
    scene: str
    robot: str
    settings: tuple[str, ...]
    seeds: int
    aside: bool = False
    file: str = ""
    plants: tuple[str, ...] = ("ordinary",)
    kind: Callable[..., Any] | None = None


Row = dict[str, str]
"""A run, as text by column."""

Figure = str | Callable[[Any, dict[str, Any]], Any]
"""Where a column's value is in a run's summary ("final.tilt_deg"), or what computes it from simulation and summary."""

Cell = Callable[[list[Row]], str]
"""What makes a table's cell from the rows of a case."""


@dataclass(frozen=True)
class Benchmark:
    """What one script counts, and how its table shows it.

    Attributes:
        name: Of its .csv and .md file; the CSV begins with case, robot, plant, seed, completed, failed and commit.
        columns: Its columns after those.
        shown: Cells of a case's line after the counts, by their heads.
        note: Sentence under the table.
        recorded: Whether the summary's "recording" is the path of the run's recording.
    """

    name: str
    columns: Mapping[str, Figure]
    cases: Sequence[Case]
    shown: Mapping[str, Cell] = field(default_factory=dict)
    note: str = ""
    recorded: bool = False
    folder: Path = FOLDER

    @property
    def path(self) -> Path:
        return self.folder / f"{self.name}.csv"

    def report(self) -> None:
        """Write the table between its markers in the page: a line a case with runs."""
        rows = rows_of(self.path)
        sides = {"completed": DRAWN}
        if any("exact" in case.plants for case in self.cases):
            sides["on the exact plant"] = ("exact",)
        lines = []
        for case in self.cases:
            mine = [r for r in rows if (r["case"], r["robot"]) == (case.name, case.robot)]
            if mine:
                cells = [cell(of_now(mine)) for cell in self.shown.values()]
                counts = (counted(mine, plants) for plants in sides.values())
                lines.append((case.name, case.robot, *counts, *cells))
        table = markdown_table(("case", "robot", *sides, *self.shown), lines)
        write_table(self.folder / f"{self.name}.md", [table, "", f"{self.note} {origin(self)}".strip()])


def figures(benchmark: Benchmark, simulation: Any, summary: dict[str, Any]) -> dict[str, Any]:
    """The values of a run in a benchmark's own columns; what the summary lacks is empty."""
    found = {}
    for name, figure in benchmark.columns.items():
        value: Any = summary
        if callable(figure):
            value = figure(simulation, summary)
        else:
            for part in figure.split("."):
                value = value.get(part, "") if isinstance(value, dict) else ""
        found[name] = "" if value is None else value
    return found


def values(rows: Sequence[Row], column: str, scale: float = 1.0) -> list[float]:
    """The numbers of a column, without runs that have none."""
    return [scale * float(r[column]) for r in rows if r.get(column) not in (None, "", "None", "nan")]


def shown(column: str, form: str = "{median:.3g}", scale: float = 1.0, completed: bool = False) -> Cell:
    """A cell with `median`, `least`, `most` and `mean` of a column over the runs, or over the completed ones alone."""

    def cell(rows: list[Row]) -> str:
        kept = [r for r in rows if r["completed"] == "True" or not completed]
        found = values(kept, column, scale)
        if not found:
            return "-"
        return form.format(median=median(found), least=min(found), most=max(found), mean=mean(found))

    return cell


SPREAD = "{median:.3g} ({least:.3g} to {most:.3g})"


def failed(rows: list[Row]) -> str:
    """The criteria that runs failed by, the most frequent first."""
    found = Counter(" ".join(r["failed"] for r in rows).split()).most_common()
    return ", ".join(f"{name} {n}" for name, n in found) or "-"


def fallen(rows: list[Row]) -> str:
    return str(sum(r["fell"] in ("True", "1") for r in rows))


def largest_impact(simulation: Any, out: Mapping[str, Any]) -> float:
    """Of a run's landings, in body weights; 0 without."""
    return round(max(out["impacts_N"] or [0.0]) / float(simulation.body.weight), 3)


def processor_time() -> float:
    """In s, of this process and its finished workers."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def commit() -> str:
    found = subprocess.run(["git", "rev-parse", "--short=7", "HEAD"], cwd=FOLDER, capture_output=True, text=True)
    return found.stdout.strip() or "unknown"


def rows_of(path: Path) -> list[Row]:
    """All rows, in the order in which they were made."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def latest(rows: Iterable[Row]) -> list[Row]:
    """The row that counts of each run."""
    return list({(r["case"], r["robot"], r["plant"], r["seed"]): r for r in rows}.values())


def drawn_seeds(made: str, count: int) -> list[int]:
    """The first seeds that a commit draws: the same for all cases, so that those that are compared share them."""
    digests = (hashlib.sha256(f"{made} {i}".encode()).digest() for i in range(count))
    return [int.from_bytes(digest[:4], "big") for digest in digests]


def wanted(benchmark: Benchmark, made: str | None = None) -> Iterator[tuple[int, Case, tuple[str, int]]]:
    """Runs that are missing at a commit, each with its rank, the lower the sooner, and its plant and seed."""
    done = {(r["case"], r["robot"], r["plant"], int(r["seed"])) for r in rows_of(benchmark.path)}
    seeds = drawn_seeds(made or commit(), max((case.seeds for case in benchmark.cases), default=0))
    for case in benchmark.cases:
        for plant in case.plants:
            for i, seed in enumerate(seeds[: case.seeds]):
                if (case.name, case.robot, plant, seed) not in done:
                    yield rank(case, plant, i), case, (plant, seed)


def rank(case: Case, plant: str, i: int) -> int:
    """Place in the order of runs of a case's i-th seed: a few of all first, comparisons last, drawn plants sooner."""
    return 2 * i + (plant == "exact") + 100 * case.aside + (1000 if i >= FEW else 0)


def run_row(benchmark: Benchmark, case: Case, run: tuple[str, int], made: str) -> dict[str, Any]:
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    plant, seed = run
    settings = (*case.settings, *PLANTS[plant])
    simulation = (case.kind or Simulation)(load_scene(case.scene, settings, case.file or case.robot), seed)
    with TemporaryDirectory() as folder:
        recording = Path(folder, "run.mcap") if benchmark.recorded else None
        summary = simulation.run(record=recording)
        found = figures(benchmark, simulation, {**summary, "recording": recording})
    return {
        "case": case.name,
        "robot": case.robot,
        "plant": plant,
        "seed": seed,
        "completed": summary["completed"],
        "failed": " ".join(r["criterion"] for r in summary["reasons"]),
        "commit": made,
        **found,
    }


def add_row(benchmark: Benchmark, case: Case, run: tuple[str, int], made: str) -> dict[str, Any]:
    """`run_row`, appended to the benchmark's file."""
    row = run_row(benchmark, case, run, made)
    columns = ("case", "robot", "plant", "seed", "completed", "failed", "commit", *benchmark.columns)
    older = rows_of(benchmark.path)
    if older and tuple(older[0]) != columns:
        with benchmark.path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns, restval="", extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows(older)
    append_row(benchmark.path, columns, row)
    return row


def append_row(path: Path, columns: Sequence[str], row: Mapping[str, Any]) -> None:
    """Append a row to a CSV file, which is made with its heads where it is missing; what a row lacks stays empty."""
    new = not path.exists()
    with path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerow(row)
        file.flush()
        os.fsync(file.fileno())


def differences(row: Row, again: dict[str, Any]) -> list[str]:
    """Columns in which a row and its repetition differ as texts, without times of a machine and the commit."""
    timed = ("_us", "real_time_factor", "commit")
    texts = {k: "" if again.get(k) is None else str(again[k]) for k in row}
    return [k for k in row if row[k] != texts[k] and not k.endswith(timed)]


def counted(rows: Sequence[Row], plants: Sequence[str] = DRAWN) -> str:
    """Completed runs on some kinds of plants, with Wilson's interval at 95 % in percent."""
    mine = [r["completed"] == "True" for r in latest(rows) if r["plant"] in plants]
    low, high = wilson_interval(sum(mine), len(mine))
    return f"{sum(mine)}/{len(mine)} ({100 * low:.0f}-{100 * high:.0f})" if mine else "-"


def of_now(rows: Sequence[Row]) -> list[Row]:
    """The rows that a table's other columns sum up: those on drawn plants, or else all."""
    mine = latest(rows)
    return [r for r in mine if r["plant"] in DRAWN] or mine


def origin(benchmark: Benchmark) -> str:
    """Commits of the rows that count, for under a table."""
    made = Counter(r["commit"] for r in latest(rows_of(benchmark.path))).most_common()
    return f"Runs by commit: {', '.join(f'{n} of {name}' for name, n in made) or 'none'}."


def write_table(path: Path, lines: Sequence[str], name: str = "table") -> None:
    """Put lines between a text's markers <!-- name --> and <!-- end -->."""
    text = path.read_text(encoding="utf-8")
    before, marker, rest = text.partition(f"<!-- {name} -->\n")
    after = rest.partition("<!-- end -->\n")[2]
    path.write_text(before + marker + "\n".join(lines) + f"\n<!-- end -->\n{after}", encoding="utf-8")
