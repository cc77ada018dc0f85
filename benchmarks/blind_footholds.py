"""The four rows of every trial of `plantar bench footholds`, with intervals, in a limited time.

    python benchmarks/blind_footholds.py                          100 runs of ours a trial, 30 of each other row
    python benchmarks/blind_footholds.py --minutes 25             as many of them as 25 minutes of a core allow
    python benchmarks/blind_footholds.py --page                   page and picture of the rows that there are

Runs alternate among trials and policies, so that whatever time allows is even: ours gets ten runs where another row
gets three. The table goes on where it was left, unless it is of another commit: `--fresh` begins it again.
"""

import argparse
import csv
import math
import time
from collections import Counter
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from resumable import FOLDER, commit, rows_of

from plantar.bench.intervals import wilson_interval
from plantar.bench.kind import BenchOptions, Case
from plantar.bench.tables import markdown_table
from plantar.sim.bench.footholds.foothold_run import TRIALS
from plantar.sim.bench.footholds.measure_footholds import FOOTHOLDS
from plantar.sim.bench.footholds.policy import BASELINES

TABLE = FOLDER / "blind_footholds.csv"
OURS = "plantar"
PAGE = """# Blind footholds

Made by `python benchmarks/blind_footholds.py`, on h1, at {commit}: {runs}.
The first seeds are taken, each with all trials. Difficulties are in units of the robot and rise by factors of 2, all
shown. The rows of a trial differ by what the policy measures alone: `zero` is the action 0, `net-force` the built-in
controller by one force a sole, `ankles` by force-torque sensors, `plantar` by taxels and proximity.

![Walks completed as stones, slopes, steps and pushes grow harder, by what the soles sense](blind_footholds.png)

"""
SHOWN = {
    "stones": "smallest stone [share of a sole]",
    "slopes": "slope [degrees]",
    "steps": "step up or down [legs]",
    "push": "push [m/s over sqrt(g leg)]",
}
"""Kinds of trial of the picture, in which what is sensed matters, and their difficulty."""
COLOUR = {OURS: ("polygon", "taxels"), "ankles": ("left", "ankle force-torque"), "net-force": ("right", "net force")}


def wanted(ours: int, others: int) -> Iterator[Case]:
    """Cases in the order in which they are run."""
    by_seed: dict[int, list[Case]] = {}
    for name in BASELINES:
        for case in FOOTHOLDS.cases(BenchOptions(policy=Path(name), seeds=ours if name == OURS else others)):
            by_seed.setdefault(int(case.key[-1]), []).append(case)
    for seed in range(ours):
        yield from (case for case in by_seed[seed] if case.key[0] == OURS)
        for other in range(math.ceil(seed * others / ours), math.ceil((seed + 1) * others / ours)):
            yield from (case for case in by_seed[other] if case.key[0] != OURS)


def count(cases: Iterator[Case], minutes: float, made: str) -> None:
    """Add the rows that are missing, until the processor time is used."""
    names = [*FOOTHOLDS.keys, *FOOTHOLDS.columns, "commit"]
    rows = rows_of(TABLE)
    other = {row["commit"] for row in rows} - {made}
    if other:
        raise SystemExit(f"{TABLE.name} has rows of {', '.join(sorted(other))}, not of {made}; --fresh replaces them")
    done = {tuple(row[key] for key in FOOTHOLDS.keys) for row in rows}
    new = not TABLE.exists()
    with TABLE.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names, lineterminator="\n")
        if new:
            writer.writeheader()
        began = time.process_time()
        for case in cases:
            if time.process_time() - began > 60.0 * minutes:
                return
            if case.key in done:
                continue
            for row in case.measure():
                writer.writerow({**dict(zip(FOOTHOLDS.keys, case.key, strict=True)), **row, "commit": made})
            file.flush()


def page() -> str:
    """The page of the table's rows, trial by trial."""
    rows = rows_of(TABLE)
    order = {name: i for i, name in enumerate(BASELINES)}
    trials = {(t.kind, f"{t.value:g}"): i for i, t in enumerate(TRIALS)}
    rows.sort(key=lambda row: (trials[row["kind"], row["value"]], order[row["policy"]]))
    (table,) = FOOTHOLDS.find(rows, BenchOptions()).tables
    counts: dict[str, Any] = {name: Counter() for name in BASELINES}
    for row in rows:
        counts[row["policy"]][row["kind"], row["value"]] += 1
    runs = ", ".join(f"{_range(c.values())} runs of `{name}`" for name, c in counts.items() if c)
    return PAGE.format(commit=rows[0]["commit"], runs=runs) + markdown_table(table.head, table.rows)


def picture() -> None:
    """The rows' shares of completed walks over difficulty, with Wilson's intervals at 95 %."""
    from plantar.plotting import COLOURS, new_figure, save_figure

    rows = rows_of(TABLE)
    figure, axes = new_figure(11.0, 3.4, 1, len(SHOWN), sharey=True, grid=True)
    for axis, (kind, difficulty) in zip(axes, SHOWN.items(), strict=True):
        grades = sorted({float(r["value"]) for r in rows if r["kind"] == kind}, reverse=kind == "stones")
        for place, (policy, (colour, label)) in enumerate(COLOUR.items()):
            shares, ends = [], []
            for value in grades:
                mine = [r for r in rows if (r["policy"], r["kind"], float(r["value"])) == (policy, kind, value)]
                done = sum(r["completed"] == "True" for r in mine)
                low, high = wilson_interval(done, len(mine))
                shares.append(100.0 * done / len(mine))
                ends.append((shares[-1] - 100.0 * low, 100.0 * high - shares[-1]))
            at = [i + 0.08 * (place - 1) for i in range(len(grades))]  # beside each other, so that intervals are seen
            spread = [[max(e[side], 0.0) for e in ends] for side in (0, 1)]
            axis.errorbar(at, shares, spread, color=COLOURS[colour], label=label, marker="o", ms=4, capsize=2)
        axis.set_xticks(range(len(grades)), [f"{value:g}" for value in grades])
        axis.set_xlabel(difficulty)
    axes[0].set_ylabel("walks completed [%]")
    axes[-1].legend(loc="upper right", fontsize="small")
    save_figure(figure, TABLE.with_suffix(".png"))


def _range(counts: Collection[int]) -> str:
    low, high = min(counts), max(counts)
    return str(low) if low == high else f"{low} to {high}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ours", type=int, default=100)
    parser.add_argument("--others", type=int, default=30)
    parser.add_argument("--minutes", type=float, default=1e9, help="processor time")
    parser.add_argument("--commit", help="of the code, where it is no checkout")
    parser.add_argument("--fresh", action="store_true", help="begin the table again")
    parser.add_argument("--page", action="store_true", help="only write the page")
    options = parser.parse_args()
    if options.fresh:
        TABLE.unlink(missing_ok=True)
    if not options.page:
        count(wanted(options.ours, options.others), options.minutes, options.commit or commit())
    TABLE.with_suffix(".md").write_text(page(), encoding="utf-8")
    picture()


if __name__ == "__main__":
    main()
