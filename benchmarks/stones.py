"""Count walks over stones that each carry a part of the sole: `python benchmarks/outcomes.py MINUTES stones`.

Each ablation gets the first ten of the seeds: the same ground
and noise with one thing off.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("steps_taken", "tilt_max_deg", "replans", "at_torque_limit", "foothold_error_p95_m")
SEEDS, FEW = 60, 10
VARIANTS: list[tuple[str, tuple[str, ...]]] = [
    ("as it is", ()),
    ("steps keep their times", ("control.step_timing=false",)),
    ("footholds not looked at", ("footholds=off",)),
]
CASES = [
    Case(name, "stones", robot, settings, FEW if settings else SEEDS, bool(settings))
    for name, settings in VARIANTS
    for robot in ("h1", "hrp2kai")
]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    return {
        **{name: out[name] for name in COLUMNS if name in out},
        "at_torque_limit": out["torque_limit"]["share_of_time"],
        "foothold_error_p95_m": out.get("footholds", {}).get("centroid_error_m", {}).get("p95", ""),
    }


BENCHMARK = Benchmark(FOLDER / "stones.csv", COLUMNS, CASES, figures)


def report() -> None:
    """Write the table between its markers in stones.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| walk | robot | {HEADS} | time with a joint at its torque limit: median and most of a run | "
        "centroid error, 95 % of a run [mm] |",
        "|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name and r["robot"] == case.robot]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        good = [r for r in mine if r["completed"] == "True"]
        shares = [100.0 * float(r["at_torque_limit"]) for r in good]
        errors = [1e3 * float(r["foothold_error_p95_m"]) for r in good if r["foothold_error_p95_m"]]
        held = f"{median(shares):.1f} %, {max(shares):.1f} %" if shares else "-"
        found = f"{median(errors):.1f}" if errors else "-"
        lines.append(f"| {case.name} | {case.robot} | {cells} | {held} | {found} |")
    write_table(FOLDER / "stones.md", [*lines, "", origin(BENCHMARK)])
