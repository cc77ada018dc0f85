"""What a plant that differs from the controller's model does to walks: the tables of plant.md and plant.png.

Each item of `[plant]` is drawn alone at growing levels, and all of a carefully built robot together at level 2 in every
built-in walk, in some with wear and poor ground: `python benchmarks/outcomes.py MINUTES plant`. Items alone have 28
seeds a row: eight a cell at levels 2 and 3, and `FEW` below, where of 1,560 runs none failed.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from resumable import FEW, FOLDER, Benchmark, Case, counted, failed, latest, of_now, origin, rows_of, write_table

from plantar.bench.tables import markdown_table
from plantar.sim.plant.draw import RANGES
from plantar.sim.plant.settings import EVERYTHING, RANDOM, Plant

ROBOTS = ("h1", "hrp2kai")
LEVELS = (0.2, 0.5, 1.0, 2.0, 3.0)
FRESH_SEEDS = {3.0: 2 * FEW, 2.0: 2 * FEW, 1.0: FEW, 0.5: FEW, 0.2: FEW}
"""Seeds of an item alone by level, in the order in which they are run: the most telling first."""
ALONE = {"flat": (), "beam": (), "uneven": ("steps=20",)}
"""Walks in which each item is tried alone, with their settings."""
TOGETHER = ("flat", "push", "beam", "beam-forward", "beam-yaw", "uneven", "tilt", "obstacle", "partial-front")
TOGETHER += ("partial-inner", "partial-outer", "partial-rear", "partial-third", "stones", "turn", "s-curve", "stop")
WORN = ("flat", "push", "beam", "turn", "stones")
DRAWN = {RANDOM: TOGETHER, EVERYTHING: WORN}
"""Walks by what is drawn; everything has wear and poor ground, too."""
COLUMNS = {
    **{name: name for name in ("fell", "steps_taken", "tilt_max_deg", "zmp_margin_min_m")},
    "position_error_m": "final.position_error_m",
    "heading_error_deg": "final.heading_error_deg",
    "com_error_max_m": lambda simulation, out: max(out["estimate"]["com_error_max_m"]),
}


def _alone(item: str, level: float, scene: str) -> str:
    return f"{item} alone at {level:g}, {scene}"


def _together(scene: str, draw: str = RANDOM) -> str:
    return f"{'together' if draw == RANDOM else draw} at 2, {scene}"


def _cases() -> list[Case]:
    alone = [
        Case(
            _alone(item, level, scene),
            scene,
            robot,
            (*settings, f"{item}={RANDOM}", f"plant.level={level:g}"),
            n,
            plants=("own",),
        )
        for level, n in FRESH_SEEDS.items()
        for item in Plant.items()
        for scene, settings in ALONE.items()
        for robot in ROBOTS
    ]
    return alone + [
        Case(_together(scene, draw), scene, robot, (f"plant={draw}",), 20, plants=("own",))
        for draw, scenes in DRAWN.items()
        for scene in scenes
        for robot in ROBOTS
    ]


def outcome(rows: Sequence[dict[str, str]], name: str, robot: str) -> tuple[int, int]:
    """Completed runs of a case, and all."""
    mine = [r["completed"] == "True" for r in rows if r["case"] == name and r["robot"] == robot]
    return sum(mine), len(mine)


def limit_text(item: str) -> str:
    """What an item is drawn from at level 2, with its unit."""
    limit, unit, _ = RANGES[item]
    return f"{limit:.3g} {unit}".removesuffix(" 1")


def table_alone(rows: Sequence[dict[str, str]]) -> str:
    """Completed runs of each item by level, of all walks and both robots together."""
    lines = []
    for item in Plant.items():
        cells = []
        for level in LEVELS:
            found = [outcome(rows, _alone(item, level, scene), robot) for scene in ALONE for robot in ROBOTS]
            good, runs = (sum(counts) for counts in zip(*found, strict=True))
            cells.append(f"{good}/{runs}" if runs else "-")
        if set(cells) != {"-"}:
            lines.append((f"`{item}`, {limit_text(item)}", *cells))
    return markdown_table(("item, its limit at level 2", *(f"level {v:g}" for v in LEVELS)), lines)


def table_together(rows: Sequence[dict[str, str]]) -> str:
    """Completed runs with everything drawn together, by walk and robot, with Wilson's interval at 95 % in percent."""
    lines = []
    for draw, scenes in DRAWN.items():
        for scene in scenes:
            for robot in ROBOTS:
                mine = [r for r in rows if (r["case"], r["robot"]) == (_together(scene, draw), robot)]
                now, _, older = counted(mine)
                if mine:
                    lines.append((f"`{scene}`", f"`plant={draw}`", robot, now, older, failed(of_now(mine))))
    return markdown_table(("walk", "plant", "robot", "completed", "older ground", "failed"), lines)


def draw(rows: Sequence[dict[str, str]], path: Path) -> None:
    """Draw where each item breaks: a panel for each walk and robot, a row for each item."""
    import numpy as np

    from plantar.plotting import new_figure, save_figure

    panels: list[tuple[str, Any, list[list[tuple[int, int]]]]] = []
    for robot in ROBOTS:
        for scene in ALONE:
            counts = [[outcome(rows, _alone(i, v, scene), robot) for v in LEVELS] for i in Plant.items()]
            share = np.array([[good / runs if runs else np.nan for good, runs in line] for line in counts])
            if np.isfinite(share).any():
                panels.append((f"{scene}, {robot}", share, counts))
    items = [i for k, i in enumerate(Plant.items()) if any(np.isfinite(share[k]).any() for _, share, _ in panels)]
    shown = [Plant.items().index(i) for i in items]
    figure, axes = new_figure(
        3.4 + 1.9 * len(panels), 1.4 + 0.27 * len(items), 1, len(panels), squeeze=False, sharey=True
    )
    image = None
    for axis, (title, share, counts) in zip(axes[0], panels, strict=True):
        image = axis.imshow(share[shown], vmin=0.0, vmax=1.0, cmap="RdYlBu", aspect="auto")
        for row, k in enumerate(shown):
            for column, (good, runs) in enumerate(counts[k]):
                if runs:
                    dark = good / runs in (0.0, 1.0)
                    text = f"{good}/{runs}"
                    axis.text(column, row, text, ha="center", va="center", fontsize=7, color="w" if dark else "k")
        axis.set_title(title, fontsize=9)
        axis.set_xticks(range(len(LEVELS)), [f"{level:g}" for level in LEVELS], fontsize=8)
        axis.set_xlabel("level [1]", fontsize=8)
        axis.set_yticks(range(len(items)), [f"{i.replace('_', ' ')} ({limit_text(i)})" for i in items], fontsize=8)
    axes[0][0].set_ylabel("item (its limit at level 2)", fontsize=8)
    bar = figure.colorbar(image, ax=axes[0].tolist(), location="right", ticks=[0.0, 0.5, 1.0])
    bar.set_label("completed runs [1], white: not run", fontsize=8)
    save_figure(figure, path)


def report() -> None:
    rows = latest(rows_of(BENCHMARK.path))
    write_table(FOLDER / "plant.md", [table_alone(rows), "", origin(BENCHMARK)], "alone")
    write_table(FOLDER / "plant.md", [table_together(rows)], "together")
    if any(" alone " in r["case"] for r in rows):
        draw(rows, FOLDER / "plant.png")


BENCHMARK = Benchmark("plant", COLUMNS, _cases())
