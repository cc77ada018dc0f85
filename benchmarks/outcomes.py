"""Make the tables of outcomes: `python benchmarks/outcomes.py MINUTES [TABLE...]`.

Runs what the tables (by default all) still lack, a row of TABLE.csv a run, the most informative runs first, and writes
the tables. `... drop TABLE...` first drops the rows of other commits; `... report [TABLE...]` only writes the tables;
`... again COUNT [TABLE...]` runs so many random rows once more and lists those with another outcome or figure: another
processor may differ in the last digits. A row's commit is what is checked out, so run it in a worktree that does not
change: `git worktree add ../tables`. Several processes can share the work by tables. Robots that are not built in come
from `PLANTAR_REAL_DATA`; without it their rows wait.
"""

import csv
import os
import random
import sys
import time
from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType

from introduced_robots import introduce
from resumable import Benchmark, Case, add_row, commit, differences, latest, rows_of, run_row, wanted

TABLES = ("push_steps", "unknown_ground", "introduced_robots")
TABLES += ("walks", "guide", "balance", "reactive_options", "survival_map", "grounds", "speed", "parts")


def missing(script: ModuleType) -> Iterator[tuple[int, Case, tuple[str, int]]]:
    """Runs that a table lacks, each with its rank; those of robots without a file are left out."""
    lacks = script.missing() if hasattr(script, "missing") else wanted(script.BENCHMARK)
    return (job for job in lacks if not job[1].file or Path(job[1].file).exists())


def drop_other_commits(benchmark: Benchmark, made: str) -> int:
    """Keep only the rows of a commit; return how many are dropped."""
    rows = rows_of(benchmark.path)
    kept = [r for r in rows if r["commit"] == made]
    if rows:
        with benchmark.path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(kept)
    return len(rows) - len(kept)


def run(scripts: Sequence[ModuleType], minutes: float) -> None:
    """Run what is missing for some minutes; a run that has begun is ended."""
    began, made, done = time.monotonic(), commit(), 0
    while True:
        # Asked again now and then: what a bisection lacks depends on what it has found.
        jobs = sorted(((job, s) for s in scripts for job in missing(s)), key=lambda found: found[0][0])
        if not jobs:
            return
        for i, ((_, case, job), script) in enumerate(jobs[:50]):
            if time.monotonic() > began + 60.0 * minutes:
                return
            row = add_row(script.BENCHMARK, case, job, made)
            done += 1
            hours = (len(jobs) - i - 1) * (time.monotonic() - began) / done / 3600.0
            outcome = f"{row['completed']} {row['failed']}".strip()
            place = f"[{len(jobs) - i - 1} to come, {hours:.1f} h]"
            print(
                f"{place} {script.__name__}: {case.name} {case.robot} {job[0]} {job[1]}: {outcome}",
                file=sys.stderr,
                flush=True,
            )


def again(scripts: Sequence[ModuleType], count: int) -> bool:
    known = {}
    for script in scripts:
        cases = {(c.name, c.robot): c for c in script.BENCHMARK.cases if not c.file or Path(c.file).exists()}
        rows = [r for r in latest(rows_of(script.BENCHMARK.path)) if (r["case"], r["robot"]) in cases]
        known |= {(script.__name__, i): (script.BENCHMARK, cases[r["case"], r["robot"]], r) for i, r in enumerate(rows)}
    drawn = random.Random(0).sample(sorted(known), min(count, len(known)))
    held = same = 0
    for i, key in enumerate(drawn):
        benchmark, case, row = known[key]
        job = (row.get("plant") or "exact", int(row["seed"]))
        other = differences(row, run_row(benchmark, case, job, row["commit"]) | {"plant": row.get("plant", "")})
        held += not {"completed", "failed"} & set(other)
        same += not other
        outcome = f"differs in {', '.join(other)}" if other else "the same"
        place = f"[{len(drawn) - i - 1} to come]"
        print(f"{place} {key[0]}: {case.name} {case.robot} {row['seed']}: {outcome}", file=sys.stderr, flush=True)
    figures = f"{same} of them in every figure; drawn from {len(known)}"
    print(f"{held} of {len(drawn)} rows have the same outcome at {commit()}, {figures}")
    return held == len(drawn)


def main(arguments: Sequence[str]) -> None:
    first, names = (arguments[0], arguments[1:]) if arguments else ("", ())
    count, names = (names[0], names[1:]) if first == "again" and names else ("", names)
    names = names or TABLES
    odd = [name for name in names if name not in TABLES]
    known = first in ("drop", "report") or first.replace(".", "", 1).isdigit() or (first == "again" and count.isdigit())
    if odd or not known:
        sys.exit(
            f"outcomes.py: minutes, `drop`, `report` or `again COUNT`, then tables of {', '.join(TABLES)}; "
            f"got {list(arguments)}"
        )
    scripts = [import_module(name) for name in names]
    if first == "drop":
        for script in scripts:
            print(f"{script.__name__}: {drop_other_commits(script.BENCHMARK, commit())} rows dropped")
        return
    if first != "report" and (data := os.environ.get("PLANTAR_REAL_DATA")):
        introduce(Path(data))
    if first == "again":
        sys.exit(not again(scripts, int(count)))
    if first != "report":
        run(scripts, float(first))
    for script in scripts:
        getattr(script, "report", script.BENCHMARK.report)()


if __name__ == "__main__":
    main(sys.argv[1:])
