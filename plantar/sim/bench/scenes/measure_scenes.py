"""`plantar bench scenes`: run walks in many ways, and write what each way costs and how far off it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from plantar.atomic import write_text
from plantar.csv_table import csv_text, mapping_rows
from plantar.errors import InputError
from plantar.sim.bench.scenes.scene_row import SceneRow, scene_rows
from plantar.sim.bench.scenes.scene_runs import TABLE, SceneCase, SceneRuns
from plantar.sim.bench.scenes.scene_setting import SETTINGS
from plantar.sim.bench.scenes.scenes_figure import draw_scenes
from plantar.sim.bench.scenes.scenes_page import scenes_page
from plantar.sim.bench.scenes.verdict import knob_verdicts

__all__ = ["CASES", "measure_scenes", "write_scenes"]

_WALKS = {"flat": "steps=4", "beam": "steps=6", "uneven": "steps=4"}

CASES: tuple[SceneCase, ...] = tuple(
    SceneCase(scene, robot, (steps, "walk.settle=0.2"))
    for robot in ("h1", "hrp2kai")
    for scene, steps in _WALKS.items()
)
"""The walks: a few steps of each scene, since each setting walks them several times."""

_SEEDS, _TRACED = 5, 2


def measure_scenes(
    folder: Path,
    progress: Callable[[float, str], None],
    scenes: Sequence[str] = (),
    robots: Sequence[str] = (),
    quick: bool = False,
) -> dict[str, Any]:
    """Run what is missing in the folder's scene_runs.csv, and write scenes.md, scenes.csv and scenes.png again.

    Args:
        folder: Where the table is; made where it is not there.
        progress: Called with the fraction done and a text.
        scenes: Names of the scenes to run; all of `CASES` where empty.
        robots: Names of the robots to run them with; likewise.
        quick: Run the settings that show most, with one seed, and of the walks H1's on flat ground unless others are
            named.

    Returns:
        Rows and verdicts as plain JSON values, and the names of the files.

    Raises:
        InputError: If a scene or robot is not among the walks, or the table is not one of scene runs.
    """
    cases = _chosen(scenes, robots, quick)
    folder.mkdir(parents=True, exist_ok=True)
    runs = SceneRuns(folder)
    settings = [s for s in SETTINGS if s.quick or not quick]
    seeds = range(1, 2 if quick else _SEEDS + 1)
    runs.run(cases, settings, seeds, 1 if quick else _TRACED, progress)
    return write_scenes(folder, runs.rows)


def write_scenes(folder: Path, runs: Sequence[dict[str, str]]) -> dict[str, Any]:
    """Write what runs come to.

    Args:
        folder: Where to; exists.
        runs: Rows of `SceneRuns`; one at least.

    Returns:
        See `measure_scenes`.
    """
    rows = scene_rows(runs)
    verdicts = knob_verdicts(rows)
    write_text(folder / "scenes.csv", _csv(rows))
    write_text(folder / "scenes.md", scenes_page(rows, verdicts))
    draw_scenes(folder / "scenes.png", rows)
    return {
        "rows": [row.as_dict() for row in rows],
        "verdicts": [v._asdict() for v in verdicts],
        "files": ["scenes.md", "scenes.csv", "scenes.png", TABLE],
    }


def _chosen(scenes: Sequence[str], robots: Sequence[str], quick: bool) -> list[SceneCase]:
    known = {"scene": dict.fromkeys(c.scene for c in CASES), "robot": dict.fromkeys(c.robot for c in CASES)}
    for what, names in (("scene", scenes), ("robot", robots)):
        for name in names:
            if name not in known[what]:
                raise InputError(f"{what} '{name}' is not among the walks; allowed: {', '.join(known[what])}")
    scenes = scenes or (("flat",) if quick else ())
    robots = robots or (("h1",) if quick else ())
    return [c for c in CASES if (not scenes or c.scene in scenes) and (not robots or c.robot in robots)]


def _csv(rows: Sequence[SceneRow]) -> str:
    names = list(rows[0].as_dict())
    cells = ({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in row.as_dict().items()} for row in rows)
    return csv_text(names, mapping_rows(names, cells))
