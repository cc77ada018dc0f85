"""Count the companion's force experiments: `python benchmarks/companion_force.py FOLDER`, or `... FOLDER report`.

Each case is a sweep in FOLDER, on seeds from 1000 on that nothing was tuned on; stopped, it goes on where it was. The
rows go to companion_force.csv, the counts between the markers of companion_force.md.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from statistics import median
from typing import NamedTuple

from resumable import write_table

from sim.sweep import Sweep, run_sweep

HERE = Path(__file__).parent
FIRST = 1000
COLUMNS = (
    *("completed", "force_rms_free_N", "force_rms_disturbed_N", "force_max_N", "contact_lost_s"),
    *("distance_error_max_mm", "person_nearest_m", "guided_m", "tilt_max_deg", "reasons"),
)


class Case(NamedTuple):
    """A sweep.

    Attributes:
        number: Which of A's experiments.
        what: What is different; empty for the experiment itself.
        settings: Its settings.
        seeds: How many seeds.
    """

    number: int
    what: str = ""
    settings: tuple[str, ...] = ()
    seeds: int = 20

    @property
    def folder(self) -> str:
        """Name of its folder."""
        return f"force-tracking-{self.number}" + "".join(f"-{s.replace('=', '-')}" for s in self.settings)


CASES = (
    *(Case(number) for number in (1, 2, 3, 4)),
    Case(1, "nothing fed forward", ("feed_forward=false",), 5),
    Case(1, "torques added, no priorities", ("priority=sum",), 5),
    Case(2, "no base avoidance", ("avoidance=false",), 5),
    Case(2, "hand not held between touches", ("guidance_stiffness=0",), 5),
    Case(3, "wrist that does not comply", ("wrist=false",), 5),
    Case(3, "nothing fed forward", ("feed_forward=false",), 5),
    Case(3, "torques added, no priorities", ("priority=sum",), 5),
    Case(4, "no base avoidance", ("avoidance=false",), 5),
)


def run(folder: Path) -> None:
    """Run what is missing."""
    for case in CASES:
        scene = f"force-tracking-{case.number}"
        sweep = Sweep(scene, seeds=case.seeds, settings=case.settings, first_seed=FIRST)
        result = run_sweep(sweep, folder / case.folder)
        print(case.folder, result["points"][0]["completed"], "of", case.seeds, flush=True)


def report(folder: Path) -> None:
    """Gather the rows and write the table."""
    names = ("experiment", "completed", "RMS error without [N]", "with interactions [N]", "largest force [N]")
    names += ("contact lost [s]", "distance off [mm]", "person nearest [m]")
    gathered, lines = [], [f"| {' | '.join(names)} |", "|---" * len(names) + "|"]
    for case in CASES:
        path = folder / case.folder / "results.csv"
        if not path.exists():
            continue
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        gathered += [{"case": case.folder, "seed": r["seed"], **{name: r[name] for name in COLUMNS}} for r in rows]
        name = f"{case.number}, {case.what}" if case.what else str(case.number)
        done = sum(r["completed"] == "True" for r in rows)
        parts = [_range(rows, column) for column in COLUMNS[1:7]]
        lines.append(f"| {name} | {done}/{len(rows)} | {' | '.join(parts)} |")
    with (HERE / "companion_force.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ("case", "seed", *COLUMNS), lineterminator="\n")
        writer.writeheader()
        writer.writerows(gathered)
    write_table(HERE / "companion_force.md", lines)


def _range(rows: list[dict[str, str]], column: str) -> str:
    """Median and range over the runs that have it."""
    values = [float(r[column]) for r in rows if r[column] not in ("", "None")]
    if not values or (not any(values) and column in ("force_max_N", "distance_error_max_mm")):
        return "-"
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


if __name__ == "__main__":
    place = Path(sys.argv[1])
    if sys.argv[2:] != ["report"]:
        run(place)
    report(place)
