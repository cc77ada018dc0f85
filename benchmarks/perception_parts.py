"""What the geometry of T 4.2 would add to a walk: `python benchmarks/perception_parts.py MINUTES`, or `... report`.

Both robots walk over partial footholds, blocks and slopes as they do by default, and with one part of the perception
done as T draws it: by virtual wrench, hull of active cells, a rectangle in the concave outline, or height contours.
Ten seeds, sha256("perception i"), on plants within what ordinary care leaves. A row of perception_parts.csv a run.
"""

import hashlib
import sys
import time
from collections.abc import Callable, Sequence
from statistics import median
from types import MethodType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from resumable import (
    FOLDER,
    Benchmark,
    Case,
    Row,
    add_row,
    commit,
    largest_impact,
    latest,
    origin,
    rows_of,
    write_table,
)

from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import markdown_table
from plantar.common.sides import SIDES
from plantar.gait.contact.ankle_reach import borne_part
from plantar.gait.contact.foot_contacts import FootContacts
from plantar.geometry.inscribed import inscribed_rectangle, rectangle_in_outline
from plantar.geometry.outline import concave_outline
from plantar.geometry.polygon import area
from plantar.percepts.sole_pose import polygon_in_world
from plantar.sensing.proximity import height_contours
from plantar.sim.run.runner import Simulation

ROBOTS = ("h1", "hrp2kai")
SEEDS = [int(hashlib.sha256(f"perception {i}".encode()).hexdigest()[:7], 16) for i in range(10)]
SCENES = {
    "obstacle": ("settle=0.3",),
    "tilt": ("settle=0.3",),
    "stones": ("steps=6", "settle=0.3"),
    "partial-front": ("settle=0.3",),
    "beam": ("steps=6", "settle=0.3"),
    "feasibility-2": ("settle=0.3",),
    "feasibility-3": ("settle=0.3",),
}
DEFAULT = "as it is"
LANDINGS = ("obstacle", "tilt", "stones", "partial-front", "beam")
PARTIAL = ("stones", "partial-front", "beam")
REFUSALS = ("obstacle", "tilt", "feasibility-2", "feasibility-3")


def _on_rectangle(simulation: Simulation, rectangle: Callable[[Any], NDArray[np.float64]]) -> None:
    """Let a rectangle of what a partial foothold is found by bound the ZMP; the VRP stays over its centroid."""
    contacts = simulation.controller.footing.contacts
    taken = contacts._taken

    def bounded(self: FootContacts, side: Any, state: Any) -> Any:
        found = taken(side, state)
        foot = self._feet[side]
        corners = rectangle(foot.contact)
        if foot.support is None or found.whole or len(corners) < 3 or area(corners) <= 0.0:
            return found
        place = state.positions_sole[side]
        turn = state.rotations_sole[side]
        foot.borne = borne_part(corners, self._reach)
        foot.support = polygon_in_world(foot.borne, turn, place)
        foot.alone = polygon_in_world(self._within_limits(side, foot.borne, -turn[2, :2], True), turn, place)
        return found

    contacts._taken = MethodType(bounded, contacts)


def _carrying(contact: Any) -> NDArray[np.bool_]:
    """Cells (n,) that are over the nearest ground where it was seen, those that carried where not."""
    if contact.seen and contact._believed is not None:
        depth = contact._depth
        return np.asarray(np.isfinite(depth) & (depth <= contact.settings.step_down))
    return np.asarray(contact._carried)


class InscribedRectangle(Simulation):
    """The ZMP stays in the largest rectangle of the contact polygon (T 4.4.4)."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        _on_rectangle(self, lambda contact: inscribed_rectangle(contact.polygon_in_sole))


class OutlineRectangle(Simulation):
    """The ZMP stays in the largest rectangle of the concave outline of the cells that carry (T 4.2.5, 4.4.4)."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        _on_rectangle(self, lambda contact: rectangle_in_outline(concave_outline(contact.layout, _carrying(contact))))


class ContourFoothold(Simulation):
    """A foothold is seen as the height contour of its nearest ground (T 4.2.7), not between lines."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        for side in SIDES:
            contact = self.controller.footing.contacts._feet[side].contact
            contact._from_sight = MethodType(_contour_edges, contact)


def _contour_edges(contact: Any) -> NDArray[np.float64] | None:
    looks = contact._sight.looks
    if not looks:
        return None
    if contact._edges_of != looks:
        contact._edges = np.empty((0, 3))
        contact._edges_of = looks
        step_down = contact.settings.step_down
        if contact._sight.shows(step_down):
            polygon = height_contours(contact.layout, contact._depth, [step_down])[0].polygon_in_sole
            after = np.roll(polygon, -1, axis=0) - polygon
            normal = np.column_stack([after[:, 1], -after[:, 0]]) / np.hypot(after[:, 0], after[:, 1])[:, None]
            lines = np.column_stack([normal, (normal * polygon).sum(axis=1)])
            least = (1.0 - contact.settings.full_ratio) * contact._whole_area
            cuts = [area(contact._fit.polygon(line[None])) < contact._whole_area - least for line in lines]
            contact._edges = lines[cuts]
    return contact._edges  # type: ignore[no-any-return]


PARTS: dict[str, tuple[tuple[str, ...], type[Simulation], tuple[str, ...]]] = {
    DEFAULT: ((), Simulation, tuple(SCENES)),
    "virtual force brakes the swing (T 4.26, 4.31)": (("compliance.law=wrench",), Simulation, LANDINGS),
    "virtual moment turns the sole (T 4.4.1)": (("ground_map.orientation=moment",), Simulation, LANDINGS),
    "hull of active cells bounds the ZMP (T 4.24)": (("contact.fit=false",), Simulation, PARTIAL),
    "inscribed rectangle bounds the ZMP (T 4.4.4)": ((), InscribedRectangle, PARTIAL),
    "rectangle in the concave outline bounds the ZMP (T 4.2.5)": ((), OutlineRectangle, PARTIAL),
    "height contour chooses the foothold (T 4.2.7)": ((), ContourFoothold, PARTIAL),
    "no height contour refuses before the touch (T 4.2.7)": (("feasibility.at=probe",), Simulation, REFUSALS),
}
"""What is done otherwise: settings, simulation, and the scenes in which it acts."""


def cases() -> list[Case]:
    found = []
    for name, (settings, kind, scenes) in PARTS.items():
        for scene in scenes:
            for robot in ROBOTS:
                found.append(Case(f"{scene}, {name}", scene, robot, (*SCENES[scene], *settings), len(SEEDS), kind=kind))
    return found


BENCHMARK = Benchmark(
    "perception_parts",
    {
        "fell": "fell",
        "zmp_margin_min_m": "zmp_margin_min_m",
        "impact_max": largest_impact,
        "impact_mean": lambda simulation, out: round(
            float(np.mean(out["impacts_N"] or [0.0])) / simulation.body.weight, 4
        ),
        "probes": lambda simulation, out: len(out.get("feasibility") or ()),
        "landings": lambda simulation, out: len(out["landings_s"]),
        "sim_time_s": "sim_time_s",
        "at_torque_limit": "torque_limit.share_of_time",
    },
    cases(),
)


def count(minutes: float) -> None:
    """Run what is missing for some minutes, the same seeds of all cases first."""
    end = time.monotonic() + 60.0 * minutes
    made = commit()
    done = {(r["case"], r["robot"], int(r["seed"])) for r in rows_of(BENCHMARK.path)}
    for seed in SEEDS:
        for case in BENCHMARK.cases:
            if (case.name, case.robot, seed) in done:
                continue
            if time.monotonic() > end:
                return
            row = add_row(BENCHMARK, case, ("ordinary", seed), made)
            print(case.name, case.robot, seed, row["completed"], row["failed"], file=sys.stderr, flush=True)


def change(whole: Sequence[Row], other: Sequence[Row], column: str, scale: float = 1.0) -> str:
    """Median, and quartiles, of a column's change over the runs that complete both ways."""
    known = {(r["case"].partition(",")[0], r["robot"], r["seed"]): r for r in whole if r["completed"] == "True"}
    found = []
    for row in other:
        before = known.get((row["case"].partition(",")[0], row["robot"], row["seed"]))
        if before and row["completed"] == "True":
            found.append(scale * (float(row[column]) - float(before[column])))
    if not found:
        return "-"
    low, high = np.percentile(found, [25, 75]).tolist()
    return f"{median(found):+.2g} ({low:+.2g} to {high:+.2g})"


def report() -> None:
    """Write the tables."""
    rows = latest(rows_of(BENCHMARK.path))
    lines = []
    changes = []
    for name, (_, _, scenes) in PARTS.items():
        mine = [r for r in rows if r["case"].endswith(f", {name}")]
        whole = [r for r in rows if r["case"] in {f"{scene}, {DEFAULT}" for scene in scenes}]
        cells = []
        for scene in SCENES:
            here = [r for r in mine if r["case"] == f"{scene}, {name}"]
            cells.append(f"{sum(r['completed'] == 'True' for r in here)}/{len(here)}" if here else "-")
        completed = sum(r["completed"] == "True" for r in mine)
        before = sum(r["completed"] == "True" for r in whole)
        low, high = wilson_interval(completed, len(mine))
        total = f"{completed}/{len(mine)} ({100 * low:.0f}-{100 * high:.0f})"
        lines.append((name, *cells, total, f"{before}/{len(whole)}"))
        if name != DEFAULT:
            changes.append(
                (
                    name,
                    change(whole, mine, "impact_max"),
                    change(whole, mine, "impact_mean"),
                    change(whole, mine, "zmp_margin_min_m", 1e3),
                    change(whole, mine, "landings"),
                    change(whole, mine, "sim_time_s"),
                )
            )
    page = FOLDER / "perception_parts.md"
    head = ("part", *(f"`{s}`" for s in SCENES), "all", "as it is, there")
    write_table(page, [markdown_table(head, lines), "", origin(BENCHMARK)])
    head = ("part", "largest impact [BW]", "mean impact [BW]", "smallest ZMP margin [mm]", "landings", "time [s]")
    write_table(page, [markdown_table(head, changes)], "changes")


def main(arguments: Sequence[str]) -> None:
    if len(arguments) != 1 or not (arguments[0] == "report" or arguments[0].replace(".", "", 1).isdigit()):
        sys.exit(f"perception_parts.py: minutes, or `report`; got {list(arguments)}")
    if arguments[0] != "report":
        count(float(arguments[0]))
    report()


if __name__ == "__main__":
    main(sys.argv[1:])
