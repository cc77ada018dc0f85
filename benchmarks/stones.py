"""Count walks over stones that each carry a part of the sole: `python benchmarks/stones.py [MINUTES]`.

Rows go to stones.csv, one a run; stopped, it goes on where it was. Fresh seeds only, 1000 to 1059, which nothing was
tuned on; each ablation gets the first ten of them: the same ground and noise with one thing off. `... report` writes
the table.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

from resumable import Benchmark, Case, latest, rows_of, run_for, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("steps_taken", "tilt_max_deg", "replans", "at_torque_limit", "foothold_error_p95_m")
SEEDS, FEW = range(1000, 1060), 10
VARIANTS: list[tuple[str, tuple[str, ...]]] = [
    ("as it is", ()),
    ("steps keep their times", ("control.step_timing=false",)),
    ("footholds not looked at", ("footholds=off",)),
]
CASES = [
    Case(name, "stones", robot, settings, 0, aside=bool(settings))
    for name, settings in VARIANTS
    for robot in ("h1", "hrp2kai")
]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    return {
        **{name: out[name] for name in COLUMNS if name in out},
        "at_torque_limit": out["torque_limit"]["share_of_ticks"],
        "foothold_error_p95_m": out.get("footholds", {}).get("centroid_error_m", {}).get("p95", ""),
    }


BENCHMARK = Benchmark(FOLDER / "stones.csv", COLUMNS, CASES, figures)


def missing() -> Iterator[tuple[int, Case, int]]:
    """Runs that are missing, each with its rank: seed by seed over all cases, comparisons between them."""
    done = {(r["case"], r["robot"], int(r["seed"])) for r in rows_of(BENCHMARK.path)}
    for case in CASES:
        for i, seed in enumerate(SEEDS):
            if (case.name, case.robot, seed) not in done and not (case.aside and i >= FEW):
                yield (6 * i if case.aside else i), case, seed


def report() -> None:
    """Write the table between its markers in stones.md."""
    rows = latest(rows_of(BENCHMARK.path))
    lines = [
        "| walk | robot | completed | ticks with a joint at its torque limit: median and most of a run | "
        "centroid error, 95 % of a run [mm] |",
        "|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name and r["robot"] == case.robot]
        if not mine:
            continue
        good = [r for r in mine if r["completed"] == "True"]
        shares = [100.0 * float(r["at_torque_limit"]) for r in good]
        errors = [1e3 * float(r["foothold_error_p95_m"]) for r in good if r["foothold_error_p95_m"]]
        held = f"{median(shares):.1f} %, {max(shares):.1f} %" if shares else "-"
        found = f"{median(errors):.1f}" if errors else "-"
        lines.append(f"| {case.name} | {case.robot} | {len(good)}/{len(mine)} | {held} | {found} |")
    commits = sorted({r["commit"] for r in rows})
    lines += ["", f"Runs of {', '.join(commits)}. Still to be run: {sum(1 for _ in missing())}."]
    write_table(FOLDER / "stones.md", lines)


if __name__ == "__main__":
    if sys.argv[1:] != ["report"]:
        run_for(BENCHMARK, missing(), float(sys.argv[1]) if len(sys.argv) > 1 else 1e6)
    report()
