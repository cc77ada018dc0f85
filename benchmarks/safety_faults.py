"""What faults of time, sensors and ticks do, with the safety shell and without: `safety_faults.py [ROWS.json]`.

Each fault begins after 4 s on flat ground, in a separate control loop, and is watched for 1.4 s. ROWS.json keeps the
runs, so that a stopped benchmark continues.
"""

import json
import sys
from pathlib import Path

from resumable import write_table

from plantar.bench.tables import markdown_table
from plantar.sim.bench.stress.faults import FAULTS

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "gait" / "safety"))
from fault_run import run_with_fault

CASES = (
    ("h1 walks", "h1", True, True),
    ("h1 stands", "h1", False, True),
    ("hrp2kai walks", "hrp2kai", True, True),
    ("hrp2kai stands", "hrp2kai", False, True),
    ("h1 walks, no shell", "h1", True, False),
)


def run(fault: str, robot: str, walking: bool, shell: bool) -> list[object]:
    """Largest move of a target, state, time to it and whether the robot is on its feet; or the error."""
    try:
        seen = run_with_fault(robot, walking, fault, shell=shell)
    except Exception as error:
        return [type(error).__name__]
    return [round(seen.jump, 2), seen.state, round(seen.after, 3), seen.upright]


def shown(row: list[object]) -> str:
    if len(row) == 1:
        return str(row[0])
    jump, state, after, upright = row
    how = "goes on" if state is None else f"{state} after {after} s"
    return f"{jump}x, {how if upright else 'falls'}"


def table(rows: dict[str, list[object]]) -> str:
    names = [name for name, *_ in CASES]
    lines = [(fault, *(shown(rows[f"{name}: {fault}"]) for name in names)) for fault in FAULTS]
    return markdown_table(("fault", *names), lines)


def main(arguments: list[str]) -> None:
    path = Path(arguments[0]) if arguments else None
    rows: dict[str, list[object]] = json.loads(path.read_text()) if path is not None and path.exists() else {}
    for name, *case in CASES:
        for fault in FAULTS:
            key = f"{name}: {fault}"
            if key not in rows:
                rows[key] = run(fault, *case)
                if path is not None:
                    path.write_text(json.dumps(rows))
    write_table(Path(__file__).with_suffix(".md"), [table(rows)])


if __name__ == "__main__":
    main(sys.argv[1:])
