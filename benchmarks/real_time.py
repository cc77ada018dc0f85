"""How much faster than real time the scenes run on one core: `benchmarks/real_time.py [RUNS]`, three runs as a rule.

Everything a scene needs is in it: physics, sensors with noise, controller, judge. Runs one scene after another in one
process and writes real_time.md beside this file. Needs a core of its own: beside other work the figures are too low.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from resumable import write_table

FOLDER = Path(__file__).parent
# scene, robot, settings: the longest ones shortened
SCENES = (
    ("flat", "h1", ()),
    ("flat", "hrp2kai", ()),
    ("balance", "h1", ()),
    ("balance", "hrp2kai", ()),
    ("uneven", "h1", ("steps=30",)),
    ("uneven", "hrp2kai", ("steps=30",)),
    ("obstacle", "h1", ()),
    ("obstacle", "hrp2kai", ()),
    ("tilt", "h1", ()),
    ("tilt", "hrp2kai", ()),
    ("feasibility-3", "h1", ()),
    ("feasibility-3", "hrp2kai", ()),
    ("beam", "h1", ()),
    ("beam", "hrp2kai", ()),
    ("partial-third", "h1", ()),
    ("stones", "h1", ()),
    ("pebbles", "h1", ("steps=10",)),
)


class Cost(NamedTuple):
    """What one run cost."""

    factor: float  # simulated time over CPU time
    p50: float  # us of a control tick
    p99: float


def cost(scene: str, robot: str, settings: tuple[str, ...]) -> Cost:
    """Run a scene once."""
    from sim.runner import Simulation
    from sim.scene import load_scene

    simulation = Simulation(load_scene(scene, settings, robot), 1)
    start = time.process_time()
    out: dict[str, Any] = simulation.run()
    used = time.process_time() - start
    return Cost(out["sim_time_s"] / used, out["control_us"]["p50"], out["control_us"]["p99"])


def main(runs: int) -> None:
    """Run all scenes and write the table."""
    lines = [
        "| scene | robot | settings | real-time factor | control tick, median [us] | 99 % [us] |",
        "|---|---|---|---|---|---|",
    ]
    for scene, robot, settings in SCENES:
        seen = [cost(scene, robot, settings) for _ in range(runs)]
        factor, p50, p99 = (median(column) for column in zip(*seen, strict=True))
        lines.append(f"| {scene} | {robot} | {' '.join(settings)} | {factor:.1f} | {p50:.0f} | {p99:.0f} |")
        print(lines[-1], file=sys.stderr)
    write_table(FOLDER / "real_time.md", lines)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
