"""Count how robots walk of which `plantar robot` had the model and nothing else: the table of introduced_robots.md.

`python benchmarks/outcomes.py MINUTES introduced_robots` introduces the robots of `PLANTAR_REAL_DATA` and runs what is
missing.
"""

from __future__ import annotations

import subprocess
import sys
from itertools import product
from pathlib import Path
from statistics import median
from typing import Any

from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
MADE = FOLDER.parent / "out" / "introduced"
"""Folder of the robot files that are made."""

MODELS = {
    "JVRC-1": "robots/jvrc1/xml/jvrc1.xml",
    "OP3": "robots/robotis_op3/op3.xml",
    "Unitree H1": "robots/unitree_h1/h1.xml",
}
"""Model of each robot below `PLANTAR_REAL_DATA`."""

SCENES: dict[str, tuple[str, ...]] = {"flat": (), "push": ("push.dv=0.15",), "beam": (), "uneven": ()}
"""Scenes, shortest first, with their settings: pushes of 0.15 m/s for every robot."""

SEEDS = 20

COLUMNS = ("fell", "steps_taken", "tilt_final_deg", "tilt_max_deg", "impact_median", "impact_max", "torque_limit_share")


def robot_file(name: str) -> Path:
    """Where the file of a robot is."""
    return MADE / name.replace(" ", "-") / "robot.toml"


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run; impacts in body weights."""
    impacts = [force / simulation.body.weight for force in out["impacts_N"]] or [0.0]
    limit = out.get("torque_limit") or {}
    return {
        "fell": out["fell"],
        "steps_taken": out["steps_taken"],
        "tilt_final_deg": out["final"]["tilt_deg"],
        "tilt_max_deg": out["tilt_max_deg"],
        "impact_median": round(median(impacts), 3),
        "impact_max": round(max(impacts), 3),
        "torque_limit_share": limit.get("share_of_time", 0.0),
    }


BENCHMARK = Benchmark(
    FOLDER / "introduced_robots.csv",
    COLUMNS,
    [
        Case(scene, scene, name, settings, SEEDS, file=str(robot_file(name)))
        for (scene, settings), name in product(SCENES.items(), MODELS)
    ],
    figures,
)


def introduce(data: Path) -> None:
    """Make the robot files anew by the command that a user has.

    Args:
        data: Folder that holds the models.
    """
    for name, model in MODELS.items():
        command = [sys.executable, "-m", "plantar", "robot", str(data / model), "-o", str(robot_file(name).parent)]
        subprocess.run(command, cwd=FOLDER.parent, check=True, stdout=subprocess.DEVNULL)


def report() -> None:
    """Write the table between its markers in introduced_robots.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| robot | scene | {HEADS} | final tilt, most | impacts, median and most | at a torque limit |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name, scene in product(MODELS, SCENES):
        mine = [r for r in rows if r["robot"] == name and r["case"] == scene]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        upright = [r for r in mine if r["fell"] == "False"]

        tilt = f"{max(float(r['tilt_final_deg']) for r in upright):.2f} deg" if upright else "all fell"

        def most(column: str, of: list[dict[str, str]] = mine) -> float:
            return max(float(r[column]) for r in of)

        lines.append(
            f"| {name} | `{scene}` | {cells} | {tilt} | "
            f"{median(float(r['impact_median']) for r in mine):.2f}, {most('impact_max'):.2f} | "
            f"{100.0 * most('torque_limit_share', mine):.1f} % |"
        )
    write_table(FOLDER / "introduced_robots.md", [*lines, "", origin(BENCHMARK)])
