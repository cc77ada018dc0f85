"""Skin against ankle force-torque sensors in the scene `balance`: the table of balance.md, and balance.png.

`python benchmarks/outcomes.py MINUTES balance` runs what is missing in balance.csv and writes the table; `python
benchmarks/balance.py` draws both ZMPs of one run.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from statistics import median
from typing import Any

from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("fell", "recovered", "zmp_off_max_m", "slowest_recovery_s", "rms_m", "max_m", "zmp_margin_min_m")
COLUMNS += ("tilt_max_deg",)
CASES = [
    Case(source.replace("_", "-"), "balance", robot, (f"zmp_source={source}",), 20)
    for robot in ("h1", "hrp2kai")
    for source in ("skin", "force_torque")
]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    balance = out["balance"]
    zmps, times = balance["skin_against_force_torque"], [p["recovered_s"] for p in balance["pushes"]]
    return {
        "fell": out["fell"],
        "recovered": balance["recovered"],
        "zmp_off_max_m": balance["zmp_off_max_m"],
        "slowest_recovery_s": "" if None in times else max(times),
        "rms_m": zmps["rms_m"],
        "max_m": zmps["max_m"],
        "zmp_margin_min_m": out["zmp_margin_min_m"],
        "tilt_max_deg": out["tilt_max_deg"],
    }


def report() -> None:
    """Write the table between its markers in balance.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| robot | feedback | {HEADS} | recovered | ZMP off, most | slowest recovery "
        "| RMS difference | largest difference |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["robot"] == case.robot and r["case"] == case.name]
        runs = of_now(mine)

        def of(column: str, scale: float, digits: int, runs: list[dict[str, str]] = runs) -> str:
            values = [scale * float(r[column]) for r in runs if r[column]]
            return f"{median(values):.{digits}f} ({max(values):.{digits}f})"

        recovered = sum(int(r["recovered"]) for r in runs)
        lines.append(
            f"| `{case.robot}` | {case.name} | {counted(mine)} | {recovered} of "
            f"{6 * len(runs)} | {of('zmp_off_max_m', 1e3, 0)} mm | {of('slowest_recovery_s', 1.0, 2)} s "
            f"| {of('rms_m', 1e3, 2)} mm | {of('max_m', 1e3, 1)} mm |"
        )
    write_table(FOLDER / "balance.md", [*lines, "", origin(BENCHMARK)])


def picture() -> None:
    """Draw the ZMPs of skin and ankles over time."""
    from plantar.plotting import save_figure
    from plantar.recordings.recording import read_mcap
    from plantar.sim.figures.zmp_figure import draw_zmps
    from plantar.sim.run.runner import run_scene
    from plantar.sim.run.scene import load_scene

    with tempfile.TemporaryDirectory() as folder:
        run_scene(load_scene("balance"), 3, record=Path(folder) / "run.mcap")
        save_figure(draw_zmps(read_mcap(Path(folder) / "run.mcap")), FOLDER / "balance.png")


BENCHMARK = Benchmark(FOLDER / "balance.csv", COLUMNS, CASES, figures)

if __name__ == "__main__":
    picture()
