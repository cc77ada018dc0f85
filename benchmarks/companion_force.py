"""Count the companion's force experiments: `python benchmarks/companion_force.py FOLDER`, or `... FOLDER report`.

Each case is a sweep in FOLDER on fresh seeds from 1000 on, continued where it was stopped. The rows go to
companion_force.csv, the counts between the markers of companion_force.md.
"""

import sys
from pathlib import Path

from resumable import write_table
from sweep_cases import Row, SweepCase, completed, median_and_range, rows_of_cases, run_cases, write_rows

from plantar.bench.tables import markdown_table

HERE = Path(__file__).parent
COLUMNS = (
    *("completed", "force_rms_free_N", "force_rms_disturbed_N", "force_max_N", "contact_lost_s"),
    *("distance_error_max_mm", "person_nearest_m", "guided_m", "tilt_max_deg", "reasons"),
)
SHOWN = {
    "force_rms_free_N": "RMS error without [N]",
    "force_rms_disturbed_N": "with interactions [N]",
    "force_max_N": "largest force [N]",
    "contact_lost_s": "contact lost [s]",
    "distance_error_max_mm": "distance off [mm]",
    "person_nearest_m": "person nearest [m]",
}
"""Figures in the table, and what they are called there."""

NAME = "force-tracking-"
CASES = (
    *(SweepCase(f"{NAME}{number}") for number in (1, 2, 3, 4)),
    SweepCase(f"{NAME}1", "nothing fed forward", ("feed_forward=false",), 5),
    SweepCase(f"{NAME}1", "torques added, no priorities", ("priority=sum",), 5),
    SweepCase(f"{NAME}2", "no base avoidance", ("avoidance=false",), 5),
    SweepCase(f"{NAME}2", "hand not held between touches", ("guidance_stiffness=0",), 5),
    SweepCase(f"{NAME}3", "wrist that does not comply", ("wrist=false",), 5),
    SweepCase(f"{NAME}3", "nothing fed forward", ("feed_forward=false",), 5),
    SweepCase(f"{NAME}3", "torques added, no priorities", ("priority=sum",), 5),
    SweepCase(f"{NAME}4", "no base avoidance", ("avoidance=false",), 5),
)


def report(folder: Path) -> None:
    gathered, lines = [], []
    for case, rows in rows_of_cases(CASES, folder):
        gathered += [[case.folder, row["seed"], *(row[name] for name in COLUMNS)] for row in rows]
        number = case.scene.removeprefix(NAME)
        name = f"{number}, {case.what}" if case.what else number
        lines.append((name, completed(rows), *(_figure(rows, column) for column in SHOWN)))
    write_rows(HERE / "companion_force.csv", ("case", "seed", *COLUMNS), gathered)
    write_table(HERE / "companion_force.md", [markdown_table(("experiment", "completed", *SHOWN.values()), lines)])


def _figure(rows: list[Row], column: str) -> str:
    """Median and range of a figure; 0 of both: no contact, or always one."""
    if column in ("force_max_N", "distance_error_max_mm") and not any(float(r[column] or 0.0) for r in rows):
        return "-"
    return median_and_range(rows, column)


if __name__ == "__main__":
    place = Path(sys.argv[1])
    if sys.argv[2:] != ["report"]:
        run_cases(CASES, place)
    report(place)
