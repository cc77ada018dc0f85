"""Check that a change leaves walks the same to the last bit: `python tools/same_motion.py record|check FILE [--short]`.

`record` walks the scenes below with both robots and keeps a digest of every topic of their recordings, one for each
second of a walk; `check` walks them again and names which topic differs from when on. A commit that only moves code
must not change one bit; one that mends a fault names it and shows here which walks it changes.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from plantar.recordings.recording import read_mcap

WALKS = (
    ("flat", (), "steps=4"),
    ("beam", (), "steps=8"),
    ("beam", ("footholds=force",), "steps=8"),
    ("uneven", ("steps=30",), "steps=6"),
    ("feasibility-2", (), "steps=6"),
    ("stones", (), "steps=6"),
    ("push", (), "steps=6"),
)
"""Scenes, their settings, and what a short check walks of them: level and partial ground, with and without proximity,
plain and replanned steps, steps that are refused, and a push."""

ROBOTS = ("h1", "hrp2kai")


def digests(walk: tuple[str, str, tuple[str, ...]]) -> dict[str, list[str]]:
    """Walk a scene, seed 0, and digest its recording.

    Args:
        walk: Scene, robot and settings.

    Returns:
        For each topic a digest for each second that it covers.
    """
    from plantar.sim.run.runner import run_scene
    from plantar.sim.run.scene import load_scene

    scene, robot, settings = walk
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.mcap"
        run_scene(load_scene(scene, settings, robot), 0, record=path)
        found = {}
        for name, topic in sorted(read_mcap(path).topics.items()):
            second = np.floor(topic.time).astype(int)
            found[name] = [
                _digest([topic.time[second == k], *(topic.fields[f][second == k] for f in sorted(topic.fields))])
                for k in range(int(second.max(initial=-1)) + 1)
            ]
    return found


def _digest(arrays: list[np.ndarray]) -> str:
    total = hashlib.sha256()
    for array in arrays:
        total.update(repr((array.shape, array.dtype.str)).encode())
        total.update(np.ascontiguousarray(array).tobytes())
    return total.hexdigest()[:16]


def differences(before: dict[str, list[str]], after: dict[str, list[str]]) -> list[str]:
    """What differs between two digests of a walk, a line each.

    Args:
        before: Digests by topic.
        after: The same of another run.

    Returns:
        Topics that are gone, and those that differ with the first second in which they do; a new topic does not differ.
    """
    lines = []
    for name, expected in before.items():
        got = after.get(name)
        if got is None:
            lines.append(f"{name} is gone")
        elif got != expected:
            pairs = zip(expected, got, strict=False)
            first = next((k for k, (a, b) in enumerate(pairs) if a != b), min(len(expected), len(got)))
            lines.append(f"{name} differs from second {first} on")
    return lines


def main() -> int:
    """Record or check; exit code 1 if a walk is another one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=("record", "check"))
    parser.add_argument("file", type=Path, help="JSON file of the digests")
    parser.add_argument("--short", action="store_true", help="only the first steps of each walk")
    parser.add_argument("--workers", type=int, default=2, help="processes (2)")
    options = parser.parse_args()
    walks = [(s, r, (*x, short) if options.short else x) for s, x, short in WALKS for r in ROBOTS]
    with ProcessPoolExecutor(options.workers) as pool:
        found = {" ".join([s, r, *x]): d for (s, r, x), d in zip(walks, pool.map(digests, walks), strict=True)}
    if options.task == "record":
        options.file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        print(f"{len(found)} walks are kept in {options.file}")
        return 0
    kept = json.loads(options.file.read_text(encoding="utf-8"))
    changed = 0
    for name, digest in found.items():
        lines = differences(kept[name], digest) if name in kept else ["was not recorded"]
        changed += bool(lines)
        print(f"{name}: {'the same to the last bit' if not lines else '; '.join(lines)}")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
