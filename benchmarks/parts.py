"""What each part of the controller, and what the soles sense, is worth: `python benchmarks/outcomes.py MINUTES parts`.

Ten scenes on both robots, the same seeds, one thing left out.
"""

from collections.abc import Sequence
from statistics import median

import numpy as np
from resumable import FOLDER, Benchmark, Case, Row, largest_impact, latest, origin, rows_of, write_table

from plantar import Reading
from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import markdown_table
from plantar.sim.run.runner import Simulation

ROBOTS = ("h1", "hrp2kai")
SCENES = ("partial-third", "beam", "stones", "mixed", "obstacle", "feasibility-2", "tilt", "uneven", "slide-in", "push")
SEEDS = 10
NOTHING = "nothing"


class NetForce(Simulation):
    """Walks on soles that know their whole load alone: all taxels of a sole read the same."""

    def sense(self, k: int) -> None:
        before = self.sensors.readings
        super().sense(k)
        if self.sensors.readings is not before:
            self.sensors.readings = {
                side: Reading(r.time, np.full(len(r.force), r.force.mean()), r.proximity)
                for side, r in self.sensors.readings.items()
            }


LEFT_OUT: dict[str, tuple[str, ...] | type[Simulation]] = {
    NOTHING: (),
    "footholds, as the soles see them": ("control.footholds=off",),
    "proximity in footholds": ("control.footholds=force",),
    "VRP moved to the foothold": ("foothold.move_vrp=false",),
    "steps moved to the foothold": ("foothold.move_steps=false",),
    "preemptive foot compliance, and what needs it": (
        "control.pfc=false",
        "control.feasibility=off",
        "control.conform=false",
    ),
    "turning soles to the ground": ("control.conform=false",),
    "refusal of footholds": ("control.feasibility=off",),
    "moved steps": ("control.step_adjustment=false",),
    "timed steps": ("control.step_timing=false",),
    "momentum of the legs": ("control.leg_momentum=false",),
    "estimate of pushes": ("control.push_estimate=off",),
    "lean of the trunk": ("walk.lean=false",),
    "feedback of the DCM": ("control.feedback=false",),
    "taxels: net force of each sole": NetForce,
    "taxels: ankle force-torque": (
        "sensing.force_torque=true",
        "control.zmp_source=force_torque",
        "control.footholds=off",
        "control.feasibility=force_torque",
    ),
}
"""What is left out, and the settings or the simulation that leave it out."""


WIDTHS = {"0.64 sole": "0.43 sole", "0.48 sole": "0.32 sole", "0.4 sole": "0.27 sole", "0.32 sole": "0.21 sole"}
"""Widths of a beam, and how far to either side of the plan it may lie: two thirds of the width."""
SHARES = (0.7, 0.5, 0.4, 0.3, 0.2)
"""Of the sole that the third foothold carries, at its rear."""


def sweeps() -> dict[str, tuple[str, tuple[str, ...]]]:
    """Scene and settings of each ground of a geometric sweep."""
    beams = {f"beam of {w}": ("beam", (f"width={w}", f"offset_range={off}")) for w, off in WIDTHS.items()}
    return beams | {f"{100 * s:.0f} % of a sole": ("partial-third", (f"share={s}",)) for s in SHARES}


def cases() -> list[Case]:
    found = []
    for name, (scene, settings) in sweeps().items():
        for sees in ("skin", "off"):
            more = (*settings, f"control.footholds={sees}")
            found += [Case(f"{name}, {sees}", scene, robot, more, SEEDS) for robot in ROBOTS]
    for name, how in LEFT_OUT.items():
        settings, kind = (how, Simulation) if isinstance(how, tuple) else ((), how)
        for scene in SCENES:
            for robot in ROBOTS:
                found.append(Case(f"{scene}, {name}", scene, robot, settings, SEEDS, kind=kind))
    return found


BENCHMARK = Benchmark(
    "parts",
    {
        "fell": "fell",
        "zmp_margin_min_m": "zmp_margin_min_m",
        "impact_max": largest_impact,
        "at_torque_limit": "torque_limit.share_of_time",
    },
    cases(),
)


def changes(whole: Sequence[Row], without: Sequence[Row], column: str, scale: float) -> str:
    """Median change of a column by what is left out, over the runs that complete both ways."""
    key = ("case", "robot", "seed")
    good = {(r["case"].partition(",")[0], *(r[k] for k in key[1:])): r for r in whole if r["completed"] == "True"}
    found = []
    for row in without:
        other = good.get((row["case"].partition(",")[0], row["robot"], row["seed"]))
        if row["completed"] == "True" and other and row[column] and other[column]:
            found.append(scale * (float(row[column]) - float(other[column])))
    return f"{median(found):+.2g}" if found else "-"


def cell(rows: Sequence[Row]) -> str:
    return f"{sum(r['completed'] == 'True' for r in rows)}/{len(rows)}" if rows else "-"


def report() -> None:
    rows = latest(rows_of(BENCHMARK.path))
    whole = [r for r in rows if r["case"].endswith(f", {NOTHING}")]
    scenes = [s for s in SCENES if any(r["case"] == f"{s}, {NOTHING}" for r in rows)]
    lines, figures = [], []
    for name in LEFT_OUT:
        mine = [r for r in rows if r["case"].endswith(f", {name}")]
        if not mine:
            continue
        counts = [cell([r for r in mine if r["case"] == f"{scene}, {name}"]) for scene in scenes]
        lines.append((name, *counts, cell(mine)))
        low, high = wilson_interval(sum(r["completed"] == "True" for r in mine), len(mine))
        robots = [cell([r for r in mine if r["robot"] == robot]) for robot in ROBOTS]
        figures.append(
            (
                name,
                *robots,
                f"{100 * low:.0f} to {100 * high:.0f}",
                sum(r["fell"] in ("True", "1") for r in mine),
                changes(whole, mine, "impact_max", 1.0),
                changes(whole, mine, "zmp_margin_min_m", 1e3),
                changes(whole, mine, "at_torque_limit", 100.0),
            )
        )
    head = ["left out", *ROBOTS, "completed, interval [%]", "falls"]
    head += ["largest impact [BW]", "smallest ZMP margin [mm]", "time at a torque's limit [%]"]
    page = FOLDER / "parts.md"
    write_table(page, [markdown_table(("left out", *(f"`{s}`" for s in scenes), "all"), lines), "", origin(BENCHMARK)])
    write_table(page, [markdown_table(head, figures)], "figures")
    grounds = []
    for name in sweeps():
        by = [
            [r for r in rows if r["case"] == f"{name}, {sees}" and r["robot"] == robot]
            for sees in ("skin", "off")
            for robot in ROBOTS
        ]
        if any(by):
            grounds.append((name, *map(cell, by)))
    sides = [f"{robot}, {how}" for how in ("as the soles see it", "every foothold taken as whole") for robot in ROBOTS]
    write_table(page, [markdown_table(("ground", *sides), grounds)], "sweep")
