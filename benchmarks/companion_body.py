"""Count the experiments on h1-body: `python benchmarks/companion_body.py FOLDER [CASE...]`, or `FOLDER report`.

Each case is a sweep in FOLDER on fresh seeds from 1000 on, continued where it was stopped. With `report` the rows go to
companion_body.csv, the counts between the markers of companion_body.md.
"""

import json
import sys
from pathlib import Path

from resumable import write_table
from sweep_cases import SweepCase, completed, median_and_range, rows_of_cases, run_cases, write_rows

from plantar.bench.tables import markdown_table

HERE = Path(__file__).parent
CASES = (
    SweepCase("feather"),
    SweepCase("nociception"),
    SweepCase("pressure"),
    SweepCase("stove"),
    SweepCase("multi-contact"),
    SweepCase("hug"),
    SweepCase("lean"),
    SweepCase("feather", "without proximity", ("proximity=false",), 5),
    SweepCase("nociception", "without the reflex", ("reflex=false",), 5),
    SweepCase("nociception", "priorities that jump", ("smooth=false",), 5),
    SweepCase("pressure", "by force instead of pressure", ("by_pressure=false",), 5),
    SweepCase("stove", "without temperature", ("control.temperature=false",), 5),
    SweepCase("multi-contact", "without skin", ("control.skin=false",), 5),
    SweepCase("hug", "without skin", ("control.skin=false",), 5),
    SweepCase("lean", "without the forearm's skin", ("control.skin=false",), 5),
)

COLUMNS: dict[str, tuple[str, ...]] = {
    "hug": ("yield_least", "yield_median", "cop_margin_min_mm", "most_active"),
    "multi-contact": ("yield_least", "yield_median", "cop_margin_min_mm", "most_active"),
    "pressure": ("speed_ratio", "area_ratio", "cop_margin_min_mm"),
    "feather": ("distance_min_mm", "moved_mm", "cop_margin_min_mm"),
    "stove": ("temperature_max", "retreat_mm", "cop_margin_min_mm"),
    "nociception": ("threshold_ratio", "torque_jump", "moved_mm", "cop_margin_min_mm"),
    "lean": ("beyond_mm", "reach_error_mm", "tilt_max_deg"),
}
"""Figures of each scene in the table, as its experiment calls them."""


def report(folder: Path) -> None:
    gathered, lines = [], []
    for case, rows in rows_of_cases(sorted(CASES, key=lambda c: list(COLUMNS).index(c.scene)), folder):
        for row in rows:
            kept = {name: row[name] for name in COLUMNS[case.scene]}
            gathered.append([case.folder, row["seed"], row["completed"], json.dumps(kept), row["reasons"]])
        shown = "; ".join(f"{name} {median_and_range(rows, name)}" for name in COLUMNS[case.scene])
        name = f"`{case.scene}`, {case.what}" if case.what else f"`{case.scene}`"
        lines.append((name, completed(rows), shown))
    write_rows(HERE / "companion_body.csv", ("case", "seed", "completed", "figures", "reasons"), gathered)
    head = ("scene", "completed", "median (least to most) over the seeds")
    write_table(HERE / "companion_body.md", [markdown_table(head, lines)])


if __name__ == "__main__":
    place = Path(sys.argv[1])
    if sys.argv[2:] == ["report"]:
        report(place)
    else:
        run_cases([case for case in CASES if not sys.argv[2:] or case.folder in sys.argv[2:]], place)
