"""Walks of a plant that differs from the controller's model: the table of plant.md.

All items of a carefully built robot are drawn together at level 2, in some walks with wear and poor ground:
`python benchmarks/outcomes.py MINUTES plant`.
"""

from collections.abc import Sequence

from resumable import FOLDER, Benchmark, Case, counted, failed, latest, origin, rows_of, write_table

from plantar.bench.tables import markdown_table
from plantar.sim.plant.settings import EVERYTHING, RANDOM

ROBOTS = ("h1", "hrp2kai")
TOGETHER = ("flat", "push", "beam", "beam-forward", "beam-yaw", "uneven", "tilt", "obstacle", "partial-front")
TOGETHER += ("partial-inner", "partial-outer", "partial-rear", "partial-third", "stones", "turn", "s-curve", "stop")
WORN = ("flat", "push", "beam", "turn", "stones")
DRAWN = {RANDOM: TOGETHER, EVERYTHING: WORN}
"""Walks by what is drawn; everything has wear and poor ground, too."""
SEEDS = {RANDOM: 5, EVERYTHING: 10}
COLUMNS = {
    **{name: name for name in ("fell", "steps_taken", "tilt_max_deg", "zmp_margin_min_m")},
    "position_error_m": "final.position_error_m",
    "heading_error_deg": "final.heading_error_deg",
    "com_error_max_m": lambda simulation, out: max(out["estimate"]["com_error_max_m"]),
}


def _together(scene: str, draw: str = RANDOM) -> str:
    return f"{'together' if draw == RANDOM else draw} at 2, {scene}"


CASES = [
    Case(_together(scene, draw), scene, robot, (f"plant={draw}",), SEEDS[draw], plants=("own",))
    for draw, scenes in DRAWN.items()
    for scene in scenes
    for robot in ROBOTS
]


def table_together(rows: Sequence[dict[str, str]]) -> str:
    """Completed runs with everything drawn together, by walk and robot, with Wilson's interval at 95 % in percent."""
    lines = []
    for draw, scenes in DRAWN.items():
        for scene in scenes:
            for robot in ROBOTS:
                mine = [r for r in rows if (r["case"], r["robot"]) == (_together(scene, draw), robot)]
                if mine:
                    lines.append((f"`{scene}`", f"`plant={draw}`", robot, counted(mine)[0], failed(mine)))
    return markdown_table(("walk", "plant", "robot", "completed", "failed"), lines)


def report() -> None:
    table = table_together(latest(rows_of(BENCHMARK.path)))
    write_table(FOLDER / "plant.md", [table, "", origin(BENCHMARK)], "together")


BENCHMARK = Benchmark("plant", COLUMNS, CASES)
