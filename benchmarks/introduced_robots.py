"""Count how robots walk of which `plantar robot` had the model and nothing else: the table of introduced_robots.md.

`python benchmarks/introduced_robots.py [MINUTES]` introduces the robots of `PLANTAR_REAL_DATA`, runs what is missing in
introduced_robots.csv, one run after the other, and writes the table; stopped, it goes on where it was. A row's commit
is what is checked out, so run it in a worktree that nobody changes. Names of robots or scenes after the minutes leave
the others out. `... introduced_robots.py report` writes the table.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from statistics import median
from typing import Any

from resumable import Benchmark, Case, latest, rows_of, run_for, write_table

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

SEEDS = range(1000, 1020)
"""Seeds that nothing was tuned on."""

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
        "torque_limit_share": limit.get("share_of_ticks", 0.0),
    }


BENCHMARK = Benchmark(
    FOLDER / "introduced_robots.csv",
    COLUMNS,
    [
        Case(scene, scene, name, settings, 0, file=str(robot_file(name)))
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
        command = [sys.executable, "cli.py", "robot", str(data / model), "-o", str(robot_file(name).parent)]
        subprocess.run(command, cwd=FOLDER.parent, check=True, stdout=subprocess.DEVNULL)


def missing(names: Sequence[str] = ()) -> Iterator[tuple[Case, int]]:
    """Runs that have no row yet, in the order of the cases.

    Args:
        names: Robots, scenes or both that are run; all where it names none.

    Yields:
        Case and seed.
    """
    done = {(r["case"], r["robot"], int(r["seed"])) for r in rows_of(BENCHMARK.path)}
    robots, scenes = set(names) & set(MODELS) or set(MODELS), set(names) & set(SCENES) or set(SCENES)
    for case, seed in product(BENCHMARK.cases, SEEDS):
        if case.robot in robots and case.name in scenes and (case.name, case.robot, seed) not in done:
            yield case, seed


def report() -> None:
    """Write the table between its markers in introduced_robots.md."""
    rows = latest(rows_of(BENCHMARK.path))
    lines = [
        "| robot | scene | completed | final tilt, most | impacts, median and most | at a torque limit |",
        "|---|---|---|---|---|---|",
    ]
    for name, scene in product(MODELS, SCENES):
        mine = [r for r in rows if r["robot"] == name and r["case"] == scene]
        if not mine:
            continue
        good = sum(r["completed"] == "True" for r in mine)
        upright = [r for r in mine if r["fell"] == "False"]

        tilt = f"{max(float(r['tilt_final_deg']) for r in upright):.2f} deg" if upright else "all fell"

        def most(column: str, of: list[dict[str, str]] = mine) -> float:
            return max(float(r[column]) for r in of)

        lines.append(
            f"| {name} | `{scene}` | {good}/{len(mine)} | {tilt} | "
            f"{median(float(r['impact_median']) for r in mine):.2f}, {most('impact_max'):.2f} | "
            f"{100.0 * most('torque_limit_share', mine):.1f} % |"
        )
    made = ", ".join(sorted({r["commit"] for r in rows}))
    write_table(FOLDER / "introduced_robots.md", [*lines, "", f"Runs were made at {made}; all are in the CSV file."])


def main(minutes: float, names: Sequence[str]) -> None:
    """Run what is missing for some minutes, and write the table."""
    odd = [n for n in names if n not in MODELS and n not in SCENES]
    if odd:
        sys.exit(f"no robot or scene is called '{odd[0]}'; there are {', '.join([*MODELS, *SCENES])}")
    data = os.environ.get("PLANTAR_REAL_DATA")
    if not data:
        sys.exit("PLANTAR_REAL_DATA is not set; it names the folder that holds the models")
    introduce(Path(data))
    run_for(BENCHMARK, ((rank, *job) for rank, job in enumerate(missing(names))), minutes)
    report()


if __name__ == "__main__":
    if sys.argv[1:] == ["report"]:
        report()
    else:
        main(float(sys.argv[1]) if len(sys.argv) > 1 else 1e6, sys.argv[2:])
