"""Check that a change leaves walks the same: `python tools/same_motion.py record|check FILE [--scene NAME]...`

`record` walks every walking scene with both robots for its first two seconds, which hold the first second of the walk,
and keeps all recorded numbers; `check` walks them again and lists what differs by more than 1e-9 (of m, rad, N, ...),
and from when on. A change that only moves code or rounds otherwise stays within that; one that corrects a fault names
it and shows here which walks it changes.
"""

import argparse
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from plantar.recordings.recording import read_mcap

ROBOTS = ("h1", "hrp2kai")

TOLERANCE = 1e-9
"""Allowed difference of a number; of one above 1, as a share of it."""

SECONDS = 2.0
"""Recorded time that is compared: a walk begins at 1 s."""


def scenes() -> list[str]:
    """All scenes in which a robot walks."""
    from plantar.sim.run.scene import Scene, builtin_scenes
    from plantar.sim.run.scene_kind import open_scene

    return [name for name in builtin_scenes() if isinstance(open_scene(name), Scene)]


def numbers(walk: tuple[str, str]) -> dict[str, np.ndarray] | str:
    """Walk a scene, seed 0, and keep what is recorded.

    Args:
        walk: Scene and robot.

    Returns:
        Array of each "topic/field", times among them, or why the robot does not walk the scene.
    """
    from plantar.errors import PlantarError
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    class Short(Simulation):
        @property
        def end(self) -> float:
            return SECONDS

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.mcap"
        try:
            Short(load_scene(walk[0], robot=walk[1]), 0).run(record=path)
        except PlantarError as error:
            return str(error)
        topics = read_mcap(path).topics
    found = {f"{name}/{field}": topic.fields[field] for name, topic in topics.items() for field in topic.fields}
    return found | {f"{name}/time": topic.time for name, topic in topics.items()}


def differences(before: dict[str, np.ndarray], after: dict[str, np.ndarray]) -> list[str]:
    """What differs between two walks, a line each.

    Args:
        before: Arrays by topic and field.
        after: The same of another run.

    Returns:
        Fields that are gone or differ, with the first row that does; a new field does not differ.
    """
    lines = []
    for name, expected in before.items():
        got = after.get(name)
        if got is None:
            lines.append(f"{name} is gone")
        elif got.shape != expected.shape:
            lines.append(f"{name} has shape {got.shape}, was {expected.shape}")
        elif expected.dtype.kind == "f":
            scale = np.maximum(1.0, np.abs(expected))
            near = (
                (np.abs(got - expected) <= TOLERANCE * scale) | (np.isnan(got) & np.isnan(expected)) | (got == expected)
            )
            if not near.all():
                row = int(np.argmin(near.reshape(len(near), -1).all(axis=1)))
                lines.append(f"{name} differs from row {row} on, by up to {np.nanmax(np.abs(got - expected)):.3g}")
        elif not np.array_equal(got, expected):
            lines.append(f"{name} differs")
    return lines


def main() -> int:
    """Record or check; exit code 1 if a walk is another one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=("record", "check"))
    parser.add_argument("file", type=Path, help="NPZ file of the numbers")
    parser.add_argument("--scene", action="append", help="a scene; repeatable (all walking scenes)")
    parser.add_argument("--workers", type=int, default=2, help="processes (2)")
    options = parser.parse_args()
    walks = [(scene, robot) for scene in options.scene or scenes() for robot in ROBOTS]
    with ProcessPoolExecutor(options.workers) as pool:
        found = {" ".join(walk): made for walk, made in zip(walks, pool.map(numbers, walks), strict=True)}
    walked = {name: made for name, made in found.items() if not isinstance(made, str)}
    if options.task == "record":
        with options.file.open("wb") as kept_in:  # under just that name; NumPy adds .npz to a path
            np.savez_compressed(kept_in, **{f"{n}|{k}": v for n, made in walked.items() for k, v in made.items()})
        print(f"{len(walked)} walks are kept in {options.file}")
        return 0
    kept: dict[str, dict[str, np.ndarray]] = {}
    with np.load(options.file) as stored:
        for key in stored.files:
            name, _, field = key.partition("|")
            kept.setdefault(name, {})[field] = stored[key]
    changed = 0
    for name, made in walked.items():
        lines = differences(kept[name], made) if name in kept else ["was not recorded"]
        changed += bool(lines)
        print(f"{name}: {'the same' if not lines else '; '.join(lines)}")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
