"""`plantar bench skip`: each scene with and without what it does not need, beside its physics alone, and by room."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from plantar.atomic import write_text
from plantar.csv_table import csv_text, mapping_rows
from plantar.percepts.percept import Percept
from plantar.sim.bench.room_times import RoomTimes
from plantar.sim.bench.skip_page import skip_page
from plantar.sim.bench.skip_row import SkipRow
from plantar.sim.bench.watched_run import WatchedSimulation, replay_physics
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Scene, load_scene

__all__ = ["SCENES", "compare_skipping", "measure_skipping"]

Progress = Callable[[float, str], None]

SCENES: tuple[tuple[str, str, tuple[str, ...]], ...] = tuple(
    (scene, robot, settings)
    for scene, settings in (("flat", ("steps=6",)), ("beam", ("steps=4",)), ("uneven", ("steps=6",)))
    for robot in ("h1", "hrp2kai")
)
"""Scene, robot and settings of each row: a few steps of each, since later ones cost the same."""

_SEED = 1
_NONE = "control.skip=none"
_SHAPES = ("polygon", "outline", "box", "rectangle", "circle", "triangle", "parallelogram", "contours", "centroid")


def compare_skipping(
    scene: str, robot: str, settings: Sequence[str] = (), rounds: int = 3, seed: int = _SEED
) -> SkipRow:
    """Run a scene with what it needs, with everything, and its physics alone.

    Args:
        scene: Name of the scene; one in which no one pushes and no ground moves.
        robot: Name of the robot.
        settings: What to change of it, as `key=value`.
        rounds: Rounds to take the medians over; 1 or more.
        seed: Seed of the runs.

    Returns:
        The comparison.

    Raises:
        SceneError: If there is no such scene, or it has no such setting.
        InputError: On a system without a clock that rings (see `RoomTimes`).
    """
    needed, everything = load_scene(scene, tuple(settings), robot), load_scene(scene, (*settings, _NONE), robot)
    watched, full = WatchedSimulation(needed, seed), WatchedSimulation(everything, seed)
    summary = watched.run()
    full.run()
    motions = {watched.motion, full.motion}
    times: dict[str, list[float]] = {"run": [], "everything": [], "physics": []}
    for _ in range(rounds):
        times["run"].append(_cpu_time(needed, seed))
        with TemporaryDirectory() as folder:
            times["everything"].append(_cpu_time(everything, seed, Path(folder) / "run.mcap"))
        used, motion = replay_physics(watched)
        times["physics"].append(used)
        motions.add(motion)
    simulation = Simulation(needed, seed)
    with RoomTimes() as rooms:
        simulation.run()
    physics = median(times["physics"])
    rest = [run - alone for run, alone in zip(times["run"], times["physics"], strict=True)]
    whole = [run - alone for run, alone in zip(times["everything"], times["physics"], strict=True)]
    return SkipRow(
        scene=scene,
        robot=robot,
        settings=" ".join(settings),
        seed=seed,
        sim_s=round(float(summary["sim_time_s"]), 3),
        run_s=median(times["run"]),
        everything_s=median(times["everything"]),
        physics_s=physics,
        factor=median(part / alone for part, alone in zip(rest, times["physics"], strict=True)),
        saved=median(part / needs for part, needs in zip(whole, rest, strict=True)),
        same_motion=len(motions) == 1,
        motion=watched.motion,
        shares=rooms.shares,
        **_counts(watched, summary),
    )


def _cpu_time(scene: Scene, seed: int, record: Path | None = None) -> float:
    """CPU time in s of a run, without building its world."""
    simulation = Simulation(scene, seed)
    start = time.process_time()
    simulation.run(record=record)
    return time.process_time() - start


def _counts(run: WatchedSimulation, summary: Mapping[str, Any]) -> dict[str, dict[str, int]]:
    """What was skipped and what was computed, by kind."""
    shapes = [name for name in Percept.members() if any(word in name for word in _SHAPES)]
    others = [name for name in Percept.members() if name not in shapes]
    skins = [sensor.skin for sensor in run.sensors.skins.values()]
    told = summary["skipped"]
    computed = {
        "polygons and other shapes": sum(run.members[name] for name in shapes),
        "other percept members": sum(run.members[name] for name in others),
        "taxel forces": sum(len(skin) * skin.pressed for skin in skins),
        "proximity rays": sum(s.cast for s in run.sensors.proximity.values()),
        "steps of the IK with projectors": run.legs.inverse.careful,
        "recorded ticks": 0,
        "rendered frames": 0,
    }
    skipped = {
        "polygons and other shapes": len(shapes) * run.percepts - computed["polygons and other shapes"],
        "other percept members": len(others) * run.percepts - computed["other percept members"],
        "taxel forces": sum(len(skin) * skin.in_air for skin in skins),
        "proximity rays": int(told.get("proximity_rays", 0)),
        "steps of the IK with projectors": run.legs.inverse.plain,
        "recorded ticks": int(told["recorded_ticks"]),
        "rendered frames": int(told["rendered_frames"]),
    }
    return {"skipped": skipped, "computed": computed}


def measure_skipping(
    folder: Path,
    progress: Progress,
    scenes: Sequence[tuple[str, str, Sequence[str]]] = SCENES,
    rounds: int = 3,
) -> dict[str, Any]:
    """Compare all scenes and write skipping.md and skipping.csv.

    Args:
        folder: Where to write; exists.
        progress: Called with the fraction done and a text.
        scenes: Scene, robot and settings of each row.
        rounds: Rounds to take the medians over.

    Returns:
        The rows as plain JSON values, whether all motions were the same, and the names of the files.
    """
    rows = []
    for number, (scene, robot, settings) in enumerate(scenes):
        progress(number / len(scenes), f"{scene}, {robot}")
        rows.append(compare_skipping(scene, robot, settings, rounds))
    write_text(folder / "skipping.csv", _csv(rows))
    write_text(folder / "skipping.md", skip_page(rows))
    return {
        "scenes": [asdict(row) for row in rows],
        "same_motion": all(row.same_motion for row in rows),
        "files": ["skipping.md", "skipping.csv"],
    }


def _csv(rows: Sequence[SkipRow]) -> str:
    """The rows as a table with a column a figure."""
    flat = []
    for row in rows:
        cells = asdict(row)
        for name in ("shares", "skipped", "computed"):
            cells |= {f"{name}: {key}": value for key, value in cells.pop(name).items()}
        flat.append(cells)
    return csv_text(list(flat[0]), mapping_rows(list(flat[0]), flat))
