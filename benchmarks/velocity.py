"""Count walks at commanded velocities: `python benchmarks/outcomes.py MINUTES velocity`.

Both robots walk for 60 s at velocities that the seed draws anew every 6 s, with sensor noise, and are told to stop.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("speed_ratio", "turn_ratio", "walked_m", "turned_deg", "steps", "steps_after_stop", "tilt_deg", "wall_s")
CASES = [Case("wander", "wander", robot, (), 20) for robot in ("h1", "hrp2kai")]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    told = out["velocity"]
    return {
        **{name: told[name] for name in ("speed_ratio", "turn_ratio", "walked_m", "turned_deg", "steps_after_stop")},
        "steps": len(out["landings_s"]),
        "tilt_deg": out["tilt_max_deg"],
        "wall_s": out["wall_time_s"],
    }


BENCHMARK = Benchmark(FOLDER / "velocity.csv", COLUMNS, CASES, figures)


def report() -> None:
    """Write the table between its markers in velocity.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| robot | {HEADS} | speed / command | turn / command | steps after the stop | tilt [deg] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name and r["robot"] == case.robot]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        ranges = [_range([float(r[name]) for r in mine]) for name in ("speed_ratio", "turn_ratio")]
        most, tilt = max(int(r["steps_after_stop"]) for r in mine), max(float(r["tilt_deg"]) for r in mine)
        lines.append(f"| {case.robot} | {cells} | {ranges[0]} | {ranges[1]} | at most {most} | at most {tilt:.2f} |")
    write_table(FOLDER / "velocity.md", [*lines, "", origin(BENCHMARK)])


def _range(values: list[float]) -> str:
    return f"{median(values):.3f} ({min(values):.3f} to {max(values):.3f})"
