"""Walks of robots that `plantar robot` introduced from their models: the table of introduced_robots.md.

`python benchmarks/outcomes.py MINUTES introduced_robots` makes the robots of `PLANTAR_REAL_DATA` and runs what is
missing.
"""

import subprocess
import sys
from itertools import product
from pathlib import Path
from statistics import median
from typing import Any

from resumable import FOLDER, Benchmark, Case, shown

MADE = FOLDER.parent / "out" / "introduced"
"""Folder of the robot files that are made."""

MODELS = {
    "JVRC-1": "robots/jvrc1/xml/jvrc1.xml",
    "OP3": "robots/robotis_op3/op3.xml",
    "Unitree H1": "robots/unitree_h1/h1.xml",
}
"""Model of each robot below `PLANTAR_REAL_DATA`."""

SCENES: dict[str, tuple[str, ...]] = {"flat": (), "push": ("push.dv=0.15",), "beam": (), "uneven": ()}
"""Scenes, shortest first, with their settings."""


def robot_file(name: str) -> Path:
    return MADE / name.replace(" ", "-") / "robot.toml"


def impacts(simulation: Any, out: dict[str, Any]) -> list[float]:
    return [force / simulation.body.weight for force in out["impacts_N"]] or [0.0]


BENCHMARK = Benchmark(
    "introduced_robots",
    {
        "fell": "fell",
        "steps_taken": "steps_taken",
        "tilt_final_deg": "final.tilt_deg",
        "tilt_max_deg": "tilt_max_deg",
        "impact_median": lambda simulation, out: round(median(impacts(simulation, out)), 3),
        "impact_max": lambda simulation, out: round(max(impacts(simulation, out)), 3),
        "torque_limit_share": "torque_limit.share_of_time",
    },
    [
        Case(scene, scene, name, settings, 1, file=str(robot_file(name)))
        for name, (scene, settings) in product(MODELS, SCENES.items())
    ],
    {
        "final tilt, most [deg]": lambda rows: shown("tilt_final_deg", "{most:.2f}")(
            [r for r in rows if r["fell"] == "False"]
        ),
        "impacts, median [BW]": shown("impact_median", "{median:.2f}"),
        "impacts, most [BW]": shown("impact_max", "{most:.2f}"),
        "at a torque limit, most [%]": shown("torque_limit_share", "{most:.1f}", 100.0),
    },
)


def introduce(data: Path) -> None:
    """Make the robot files again from the models in a folder, by the user's command; a trial may miss its aim."""
    for name, model in MODELS.items():
        command = [sys.executable, "-m", "plantar", "robot", str(data / model), "-o", str(robot_file(name).parent)]
        done = subprocess.run(command, cwd=FOLDER.parent, stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 1):
            done.check_returncode()
