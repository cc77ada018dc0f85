"""Count the scene in which a hand leads h1 by its arm: `python benchmarks/outcomes.py MINUTES guide`.

Each ablation gets the first four of the seeds.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
FIGURES = ("moved_m", "arm_yielded_m", "arm_turned_deg", "feet_followed_m", "feet_astray_m", "largest_force_N")
COLUMNS = ("fell", "steps_taken", "steps_planned", "toward", "set_out_s", *FIGURES)
SEEDS, FEW = 20, 4
STIFF = ("arm.spring=8", "arm.damper=0.15", "arm.gain=0")
LINES: list[tuple[str, tuple[str, ...], bool]] = [
    ("led by its arm", (), False),
    ("an arm that does not give way", STIFF, True),
    ("nobody feels the hand", ("sensing.body_skin=false",), True),
    ("felt, but the steps stay", ("confidence=1", "yielding=0"), True),
]
CASES = [Case(name, "guide", "h1", settings, FEW if aside else SEEDS, aside) for name, settings, aside in LINES]


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


def report() -> None:
    """Write the table between its markers in guide.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| what | robot | {HEADS} | fell | failed criteria | hand went [m] | arm gave way [m] | joint turned [deg] | "
        "feet followed [m] | to a side [m] | largest force [N] |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        fell = sum(r["fell"] == "True" for r in mine)
        failed: dict[str, int] = {}
        for name in " ".join(r["failed"] for r in mine).split():
            failed[name] = failed.get(name, 0) + 1
        told = ", ".join(f"{name} {n}" for name, n in sorted(failed.items(), key=lambda f: -f[1])) or "-"
        numbers = " | ".join(spread([float(r[name]) for r in mine]) for name in FIGURES)
        lines.append(f"| {case.name} | {case.robot} | {cells} | {fell} | {told} | {numbers} |")
    backward = sum(r["toward"] == "backward" for r in rows)
    text = f"{backward} of {len(rows)} runs are backward. {origin(BENCHMARK)}"
    write_table(FOLDER / "guide.md", [*lines, "", f"Medians, with the least and the most. {text}"])


def spread(values: list[float]) -> str:
    """Median, least and most of a column, for the table."""
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})"
