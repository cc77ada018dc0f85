"""Bring-ups of sound robots: `bring_ups.py ROWS.csv COUNT [ROBOT.toml]...`.

Each is a drawn plant of level 3, of the built-in robots and of those in the given files in turn; a row for each, so
that a stopped count goes on. Prints how many were refused, with Wilson's interval at 95 %, and what of.
"""

import csv
import hashlib
import sys
from pathlib import Path

from resumable import append_row

from plantar.bench.intervals import wilson_interval
from plantar.gait.safety.bring_up.bring_up import BringUp
from plantar.sim.run.bring_up import check_before_walk
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

COLUMNS = ("number", "robot", "passed", "findings")


def checked(robot: str, number: int) -> BringUp:
    """Check the robot of a name or file on the plant of a number."""
    seed = int.from_bytes(hashlib.sha256(f"bring-up {number}".encode()).digest()[:4], "big")
    return check_before_walk(Simulation(load_scene("flat", ["steps=2", "plant=random", "level=3"], robot), seed))


def main(arguments: list[str]) -> None:
    path = Path(arguments[0])
    robots = ["h1", "hrp2kai", *arguments[2:]]
    rows = list(csv.DictReader(path.open(newline="", encoding="utf-8"))) if path.exists() else []
    for number in range(len(rows), int(arguments[1])):
        robot = robots[number % len(robots)]
        checks = checked(robot, number)
        name = Path(robot).parent.name or robot
        row = {"number": str(number), "robot": name, "passed": str(checks.passed)}
        row["findings"] = "; ".join(map(str, checks.findings))
        append_row(path, COLUMNS, row)
        rows.append(row)
    refused = [row for row in rows if row["passed"] != "True"]
    low, high = wilson_interval(len(refused), len(rows))
    print(f"{len(refused)} of {len(rows)} refused ({100 * low:.1f} to {100 * high:.1f} %)")
    for row in refused:
        print(f"{row['number']} {row['robot']}: {row['findings']}")


if __name__ == "__main__":
    main(sys.argv[1:])
