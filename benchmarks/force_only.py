"""Count walks by the forces of taxels alone: `python benchmarks/outcomes.py MINUTES force_only`.

Nothing sees the ground (`footholds=force`), and the taxels are an elastic layer, which the fit of edges does not know
(`sensing.taxels=elastic`). Fresh seeds only, 1000 to 1019, which nothing was tuned on; ablations get the first four of
them.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from resumable import FEW, HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

FOLDER = Path(__file__).parent
COLUMNS = ("steps_taken", "sim_time_s", "tilt_max_deg", "replans", "foothold_error_median_m", "foothold_error_p95_m")
SEEDS = 20
FORCE = ("footholds=force", "sensing.taxels=elastic")
ERRORS = ("plant.taxel_gain=0.15", "plant.crosstalk=0.1")
# name, scene, settings
WALKS: list[tuple[str, str, tuple[str, ...]]] = [
    ("`partial-rear`", "partial-rear", ()),
    ("`beam` 12 cm, +-80 mm", "beam", ("terrain.width=0.52 sole", "offset_range=0.347 sole")),
    ("`beam` 8 cm, +-60 mm", "beam", ("terrain.width=0.348 sole", "offset_range=0.26 sole")),
    ("`beam` 6 cm, +-40 mm", "beam", ("terrain.width=0.26 sole", "offset_range=0.174 sole")),
]
EVERY = tuple(name for name, _, _ in WALKS)
BEAM, REAR = (EVERY[2],), (EVERY[0],)
# what differs, settings, whether for comparison only, walks
VARIANTS: list[tuple[str, tuple[str, ...], bool, tuple[str, ...]]] = [
    ("", FORCE, False, EVERY),
    (", taxel errors", (*FORCE, *ERRORS), False, EVERY),
    (", no memory", (*FORCE, "contact.remember=false"), True, BEAM),
    (", not probing", (*FORCE, "landing.probing=false"), True, BEAM),
    (", not levelled", (*FORCE, "landing.levelling=0"), True, REAR),
    (", on springs", ("footholds=force",), True, BEAM + REAR),
    (", on a half-space", (*FORCE, "sensing.layer=10"), True, BEAM + REAR),
]
ROBOTS = ("h1", "hrp2kai")
CASES = [
    Case(f"{name}{what}", scene, robot, (*settings, *more), FEW if aside else SEEDS, aside)
    for name, scene, settings in WALKS
    for what, more, aside, walks in VARIANTS
    if name in walks
    for robot in ROBOTS
]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    error = out.get("footholds", {}).get("centroid_error_m", {})
    return {
        **{name: out[name] for name in COLUMNS if name in out},
        "foothold_error_median_m": error.get("median", ""),
        "foothold_error_p95_m": error.get("p95", ""),
    }


BENCHMARK = Benchmark(FOLDER / "force_only.csv", COLUMNS, CASES, figures)


def report() -> None:
    """Write the table between its markers in force_only.md."""
    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| walk | robot | {HEADS} | steps of those that were not | centroid error, median of a run [mm] |",
        "|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name and r["robot"] == case.robot]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        short = ", ".join(sorted((r["steps_taken"] for r in mine if r["completed"] != "True"), key=int))
        errors = [1e3 * float(r["foothold_error_median_m"]) for r in mine if r["foothold_error_median_m"]]
        middle = f"{median(errors):.1f}" if errors else "-"
        lines.append(f"| {case.name} | {case.robot} | {cells} | {short or '-'} | {middle} |")
    write_table(FOLDER / "force_only.md", [*lines, "", origin(BENCHMARK)])
