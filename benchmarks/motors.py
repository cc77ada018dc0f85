"""Walk scenes on stiff servos, on motors with gains, and by torque: the table of motors.md.

`python benchmarks/motors.py MINUTES [NAME=ROBOT.toml]...` works for so many minutes on what motors.csv lacks and writes
the table; stopped, it goes on where it was. Robots are h1, hrp2kai and the files given. Each run is one `plantar sim`
with a seed that the commit draws; the time of a control tick is of a computer with other work.
"""

import json
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

from resumable import append_row, commit, drawn_seeds, rows_of, write_table

from plantar.bench.tables import markdown_table

FOLDER = Path(__file__).parent
CSV = FOLDER / "motors.csv"
COLUMNS = ("robot", "drives", "scene", "seed", "completed", "failed", "tilt_deg", "impact", "tick_us", "commit")
DRIVES = {
    "torque, 150": ("drives=torque", "joint_stiffness=150"),
    "gains of 150": ("drives=own", "joint_stiffness=150"),
    "servo": ("drives=servo",),
    "torque, own gains": ("drives=torque",),
    "own gains": ("drives=own",),
    "gains of 300": ("drives=own", "joint_stiffness=300"),
}
SCENES: dict[str, tuple[str, ...]] = {
    "flat": (),
    "turn": (),
    "push": (),
    "stones": (),
    "uneven": ("steps=30",),
}


def walked(robot: str, drives: str, scene: str, seed: int) -> dict[str, object]:
    """The row of one run."""
    settings = [word for text in (*DRIVES[drives], *SCENES[scene]) for word in ("--set", text)]
    words = ["sim", scene, "--robot", robot, "--seed", str(seed), "--json", *settings]
    done = subprocess.run([sys.executable, "-m", "plantar", *words], capture_output=True, text=True, cwd=FOLDER.parent)
    if done.returncode not in (0, 1):
        return {"completed": False, "failed": done.stderr.strip().splitlines()[-1]}
    found = json.loads(done.stdout)
    impacts = sorted(found["impacts_N"])
    return {
        "completed": found["completed"],
        "failed": " ".join(r["criterion"] for r in found["reasons"]),
        "tilt_deg": found["tilt_max_deg"],
        "impact": impacts[len(impacts) // 2] if impacts else "",
        "tick_us": found["control_us"]["p50"],
    }


def run(minutes: float, robots: dict[str, str]) -> None:
    """Work on what is missing."""
    began, made = time.monotonic(), commit()
    seed = drawn_seeds(made, 1)[0]
    for drives, scene, name in product(DRIVES, SCENES, robots):
        if (name, drives, scene) in {(r["robot"], r["drives"], r["scene"]) for r in rows_of(CSV)}:
            continue
        if time.monotonic() > began + 60.0 * minutes:
            return
        row = {"robot": name, "drives": drives, "scene": scene, "seed": seed, "commit": made}
        append_row(CSV, COLUMNS, row | walked(robots[name], drives, scene, seed))


def report() -> None:
    """Write the table between its markers in motors.md."""
    rows = {(r["robot"], r["drives"], r["scene"]): r for r in rows_of(CSV)}
    lines = []
    for name, drives in dict.fromkeys((r[0], r[1]) for r in rows):
        cells = []
        for scene in SCENES:
            row = rows.get((name, drives, scene))
            if row is None:
                cells.append("")
            elif row["completed"] == "True":
                cells.append(f"yes, {float(row['tilt_deg']):.1f} deg, {float(row['impact']):.0f} N")
            else:
                cells.append(f"no: {row['failed']}")
        lines.append((name, drives, *cells))
    write_table(FOLDER / "motors.md", [markdown_table(("robot", "drives", *SCENES), lines)])


if __name__ == "__main__":
    run(float(sys.argv[1]), {"h1": "h1", "hrp2kai": "hrp2kai", **dict(word.split("=", 1) for word in sys.argv[2:])})
    report()
