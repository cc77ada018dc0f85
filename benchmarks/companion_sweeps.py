"""Count the companion's experiments: `python benchmarks/companion_sweeps.py PAGE FOLDER [CASE...]`, PAGE body or force.

Each case is a sweep in FOLDER on fresh seeds from 1000 on, which nothing was tuned on, continued where it was stopped.
With `report` in place of cases the rows go to companion_PAGE.csv, the counts between the markers of companion_PAGE.md.
"""

import csv
import json
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

from resumable import FOLDER, Row, rows_of, write_table

from plantar.bench.tables import markdown_table
from plantar.sim.sweep import Sweep, run_sweep

FIRST = 1000


class SweepCase(NamedTuple):
    """A sweep; `what` is different in it, or empty for the scene itself."""

    scene: str
    what: str = ""
    settings: tuple[str, ...] = ()
    seeds: int = 20

    @property
    def folder(self) -> str:
        return self.scene + "".join(f"-{s.replace('=', '-')}" for s in self.settings)


BODY: dict[str, tuple[str, ...]] = {
    "hug": ("yield_least", "yield_median", "cop_margin_min_mm", "most_active"),
    "multi-contact": ("yield_least", "yield_median", "cop_margin_min_mm", "most_active"),
    "pressure": ("speed_ratio", "area_ratio", "cop_margin_min_mm"),
    "feather": ("distance_min_mm", "moved_mm", "cop_margin_min_mm"),
    "stove": ("temperature_max", "retreat_mm", "cop_margin_min_mm"),
    "nociception": ("threshold_ratio", "torque_jump", "moved_mm", "cop_margin_min_mm"),
    "lean": ("beyond_mm", "reach_error_mm", "tilt_max_deg"),
}
"""Figures of each scene on h1-body in the table, as its experiment calls them."""
BODY_CASES = (
    *map(SweepCase, BODY),
    SweepCase("feather", "without proximity", ("proximity=false",), 5),
    SweepCase("nociception", "without the reflex", ("reflex=false",), 5),
    SweepCase("nociception", "priorities that jump", ("smooth=false",), 5),
    SweepCase("pressure", "by force instead of pressure", ("by_pressure=false",), 5),
    SweepCase("stove", "without temperature", ("control.temperature=false",), 5),
    SweepCase("multi-contact", "without skin", ("control.skin=false",), 5),
    SweepCase("hug", "without skin", ("control.skin=false",), 5),
    SweepCase("lean", "without the forearm's skin", ("control.skin=false",), 5),
)
FORCE_COLUMNS = (
    *("completed", "force_rms_free_N", "force_rms_disturbed_N", "force_max_N", "contact_lost_s"),
    *("distance_error_max_mm", "person_nearest_m", "guided_m", "tilt_max_deg", "reasons"),
)
FORCE = {
    "force_rms_free_N": "RMS error without [N]",
    "force_rms_disturbed_N": "with interactions [N]",
    "force_max_N": "largest force [N]",
    "contact_lost_s": "contact lost [s]",
    "distance_error_max_mm": "distance off [mm]",
    "person_nearest_m": "person nearest [m]",
}
"""Figures of force tracking in the table, and what they are called there."""
NAME = "force-tracking-"
FORCE_CASES = (
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


def counted(cases: Iterable[SweepCase], folder: Path) -> Iterator[tuple[SweepCase, str, list[Row]]]:
    """Each case with runs, how many of them were completed, as 18/20, and its rows."""
    for case in cases:
        if rows := rows_of(folder / case.folder / "results.csv"):
            yield case, f"{sum(r['completed'] == 'True' for r in rows)}/{len(rows)}", rows


def spread(rows: Iterable[Row], column: str) -> str:
    """Median and range of a figure over the runs."""
    values = [float(r[column]) for r in rows if r[column] not in ("", "None")]
    if not values or (column in ("force_max_N", "distance_error_max_mm") and not any(values)):
        return "-"  # no figure; 0 of all: no contact, or always one
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


def write(page: str, columns: Sequence[str], rows: Iterable[Sequence[str]], table: str) -> None:
    with (FOLDER / f"companion_{page}.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([columns, *rows])
    write_table(FOLDER / f"companion_{page}.md", [table])


def report_body(folder: Path) -> None:
    gathered, lines = [], []
    for case, completed, rows in counted(sorted(BODY_CASES, key=lambda c: list(BODY).index(c.scene)), folder):
        columns = BODY[case.scene]
        for row in rows:
            kept = json.dumps({name: row[name] for name in columns})
            gathered.append([case.folder, row["seed"], row["completed"], kept, row["reasons"]])
        name = f"`{case.scene}`, {case.what}" if case.what else f"`{case.scene}`"
        lines.append((name, completed, "; ".join(f"{column} {spread(rows, column)}" for column in columns)))
    table = markdown_table(("scene", "completed", "median (least to most) over the seeds"), lines)
    write("body", ("case", "seed", "completed", "figures", "reasons"), gathered, table)


def report_force(folder: Path) -> None:
    gathered, lines = [], []
    for case, completed, rows in counted(FORCE_CASES, folder):
        gathered += [[case.folder, row["seed"], *(row[name] for name in FORCE_COLUMNS)] for row in rows]
        number = case.scene.removeprefix(NAME)
        name = f"{number}, {case.what}" if case.what else number
        lines.append((name, completed, *(spread(rows, column) for column in FORCE)))
    table = markdown_table(("experiment", "completed", *FORCE.values()), lines)
    write("force", ("case", "seed", *FORCE_COLUMNS), gathered, table)


PAGES: dict[str, tuple[Sequence[SweepCase], Callable[[Path], None]]] = {
    "body": (BODY_CASES, report_body),
    "force": (FORCE_CASES, report_force),
}

if __name__ == "__main__":
    (cases, report), place = PAGES[sys.argv[1]], Path(sys.argv[2])
    if sys.argv[3:] == ["report"]:
        report(place)
    else:
        for case in (case for case in cases if not sys.argv[3:] or case.folder in sys.argv[3:]):
            sweep = Sweep(case.scene, seeds=case.seeds, settings=case.settings, first_seed=FIRST)
            result = run_sweep(sweep, place / case.folder)
            print(case.folder, result["points"][0]["completed"], "of", case.seeds, flush=True)
