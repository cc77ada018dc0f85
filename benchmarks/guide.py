"""Count the scene in which a hand leads h1 by its arm: `python benchmarks/guide.py [MINUTES]`.

Rows go to guide.csv, one a run; stopped, it goes on where it was. Fresh seeds only, from 1000 on, which nothing was
tuned on; each ablation gets the first four of them. `... report` writes the table.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

from resumable import Benchmark, Case, latest, rows_of, run_for, write_table

FOLDER = Path(__file__).parent
FIGURES = ("moved_m", "arm_yielded_m", "arm_turned_deg", "feet_followed_m", "feet_astray_m", "largest_force_N")
COLUMNS = ("fell", "steps_taken", "steps_planned", "toward", "set_out_s", *FIGURES)
SEEDS, FEW = range(1000, 1020), 4
STIFF = ("arm.spring=8", "arm.damper=0.15", "arm.gain=0")
LINES: list[tuple[str, tuple[str, ...], bool]] = [
    ("led by its arm", (), False),
    ("an arm that does not give way", STIFF, True),
    ("nobody feels the hand", ("sensing.body_skin=false",), True),
    ("felt, but the steps stay", ("confidence=1", "yielding=0"), True),
]
CASES = [Case(name, "guide", "h1", settings, 0, aside=aside) for name, settings, aside in LINES]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    told = out["guide"]
    found = {"fell": out["fell"], "steps_taken": out["steps_taken"], "steps_planned": out["steps_planned"]}
    return {
        **found,
        "toward": told["direction"],
        "set_out_s": told["set_out_s"],
        **{name: told[name] for name in FIGURES},
    }


BENCHMARK = Benchmark(FOLDER / "guide.csv", COLUMNS, CASES, figures)


def missing() -> Iterator[tuple[int, Case, int]]:
    """Runs that are missing, each with its rank: seed by seed over all cases, comparisons between them."""
    done = {(r["case"], int(r["seed"])) for r in rows_of(BENCHMARK.path)}
    for case in CASES:
        for i, seed in enumerate(SEEDS):
            if (case.name, seed) not in done and not (case.aside and i >= FEW):
                yield (4 * i + 10 if case.aside else i), case, seed


def report() -> None:
    """Write the table between its markers in guide.md."""
    rows = latest(rows_of(BENCHMARK.path))
    lines = [
        "| what | completed | fell | failed criteria | hand went [m] | arm gave way [m] | joint turned [deg] | "
        "feet followed [m] | to a side [m] | largest force [N] |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name]
        if not mine:
            continue
        good, fell = (sum(r[name] == "True" for r in mine) for name in ("completed", "fell"))
        failed: dict[str, int] = {}
        for name in " ".join(r["failed"] for r in mine).split():
            failed[name] = failed.get(name, 0) + 1
        told = ", ".join(f"{name} {n}" for name, n in sorted(failed.items(), key=lambda f: -f[1])) or "-"
        numbers = " | ".join(spread([float(r[name]) for r in mine]) for name in FIGURES)
        lines.append(f"| {case.name} | {good}/{len(mine)} | {fell} | {told} | {numbers} |")
    backward = sum(r["toward"] == "backward" for r in rows)
    commits = ", ".join(sorted({r["commit"] for r in rows}))
    text = f"{len(rows)} runs, {backward} of them backward, at {commits}. Still to be run: {sum(1 for _ in missing())}."
    write_table(FOLDER / "guide.md", [*lines, "", f"Medians, with the least and the most. {text}"])


def spread(values: list[float]) -> str:
    """Median, least and most of a column, for the table."""
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


if __name__ == "__main__":
    if sys.argv[1:] != ["report"]:
        run_for(BENCHMARK, missing(), float(sys.argv[1]) if len(sys.argv) > 1 else 1e6)
    report()
