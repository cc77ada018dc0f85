"""Count the experiments on h1-body: `python benchmarks/companion_body.py FOLDER [CASE...]`, or `FOLDER report`.

Each case is a sweep in FOLDER, on seeds from 1000 on that nothing was tuned on; stopped, it goes on where it was. With
`report` the rows go to companion_body.csv, the counts between the markers of companion_body.md.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from statistics import median
from typing import NamedTuple

from resumable import write_table

from sim.sweep import Sweep, run_sweep

HERE = Path(__file__).parent
FIRST = 1000


class Case(NamedTuple):
    """A sweep.

    Attributes:
        scene: The scene.
        what: What is different; empty for the scene itself.
        settings: Its settings.
        seeds: How many seeds.
    """

    scene: str
    what: str = ""
    settings: tuple[str, ...] = ()
    seeds: int = 20

    @property
    def folder(self) -> str:
        """Name of its folder."""
        return self.scene + "".join(f"-{s.replace('=', '-')}" for s in self.settings)


CASES = (
    Case("feather"),
    Case("nociception"),
    Case("pressure"),
    Case("stove"),
    Case("multi-contact"),
    Case("hug"),
    Case("lean"),
    Case("feather", "without proximity", ("proximity=false",), 5),
    Case("nociception", "without the reflex", ("reflex=false",), 5),
    Case("nociception", "priorities that jump", ("smooth=false",), 5),
    Case("pressure", "by force instead of pressure", ("by_pressure=false",), 5),
    Case("stove", "without temperature", ("control.temperature=false",), 5),
    Case("multi-contact", "without skin", ("control.skin=false",), 5),
    Case("hug", "without skin", ("control.skin=false",), 5),
    Case("lean", "without the forearm's skin", ("control.skin=false",), 5),
)

COLUMNS: dict[str, tuple[str, ...]] = {
    "hug": ("compliance_min", "cop_margin_min_mm", "tilt_max_deg", "most_active"),
    "multi-contact": ("compliance_min", "cop_margin_min_mm", "tilt_max_deg", "most_active"),
    "pressure": ("speed_ratio", "area_ratio", "cop_margin_min_mm"),
    "feather": ("distance_min_mm", "moved_mm", "cop_margin_min_mm"),
    "stove": ("temperature_max", "retreat_mm", "cop_margin_min_mm"),
    "nociception": ("threshold_ratio", "torque_jump", "moved_mm", "cop_margin_min_mm"),
    "lean": ("beyond_mm", "reach_error_mm", "tilt_max_deg"),
}
"""Figures of each scene in the table, as its experiment calls them."""


def run(folder: Path, scenes: list[str]) -> None:
    """Run what is missing.

    Args:
        folder: Folder of the sweeps.
        scenes: Folders of the cases to run; all where empty.
    """
    for case in CASES:
        if not scenes or case.folder in scenes:
            sweep = Sweep(case.scene, seeds=case.seeds, settings=case.settings, first_seed=FIRST)
            result = run_sweep(sweep, folder / case.folder)
            print(case.folder, result["points"][0]["completed"], "of", case.seeds, flush=True)


def report(folder: Path) -> None:
    """Gather the rows and write the table."""
    gathered, lines = [], ["| scene | completed | median (least to most) over the seeds |", "|---|---|---|"]
    for case in sorted(CASES, key=lambda c: list(COLUMNS).index(c.scene)):
        path = folder / case.folder / "results.csv"
        if not path.exists():
            continue
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            kept = {name: row[name] for name in COLUMNS[case.scene]}
            gathered.append([case.folder, row["seed"], row["completed"], json.dumps(kept), row["reasons"]])
        done = sum(r["completed"] == "True" for r in rows)
        told = "; ".join(f"{name} {_range(rows, name)}" for name in COLUMNS[case.scene])
        name = f"`{case.scene}`, {case.what}" if case.what else f"`{case.scene}`"
        lines.append(f"| {name} | {done}/{len(rows)} | {told} |")
    with (HERE / "companion_body.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("case", "seed", "completed", "figures", "reasons"))
        writer.writerows(gathered)
    write_table(HERE / "companion_body.md", lines)


def _range(rows: list[dict[str, str]], column: str) -> str:
    """Median and range over the runs that have it."""
    values = [float(r[column]) for r in rows if r[column] not in ("", "None")]
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})" if values else "-"


if __name__ == "__main__":
    place = Path(sys.argv[1])
    if sys.argv[2:] == ["report"]:
        report(place)
    else:
        run(place, sys.argv[2:])
