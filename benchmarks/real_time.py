"""How much faster than real time the scenes run on one core: `benchmarks/real_time.py [RUNS]`, three runs as a rule.

Physics, sensors with noise, controller and judge are included. Scenes take turns, so that a slow minute of the machine
meets each once. Needs a core without other work.
"""

import sys
import time
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from resumable import write_table

from plantar.bench.tables import markdown_table

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
    factor: float  # simulated time over CPU time
    p50: float  # us of a control tick
    p99: float


def cost(scene: str, robot: str, settings: tuple[str, ...]) -> Cost:
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    simulation = Simulation(load_scene(scene, settings, robot), 1)
    start = time.process_time()
    out: dict[str, Any] = simulation.run()
    used = time.process_time() - start
    return Cost(out["sim_time_s"] / used, out["control_us"]["p50"], out["control_us"]["p99"])


def main(runs: int) -> None:
    seen: list[list[Cost]] = [[] for _ in SCENES]
    for turn in range(runs):
        for costs, scene in zip(seen, SCENES, strict=True):
            costs.append(cost(*scene))
            print(f"{turn + 1}/{runs} {' '.join(scene[:2])}: {costs[-1].factor:.2f}", file=sys.stderr)
    lines = []
    for costs, (scene, robot, settings) in zip(seen, SCENES, strict=True):
        factor, p50, p99 = (median(column) for column in zip(*costs, strict=True))
        best = max(c.factor for c in costs)
        numbers = (f"{factor:.1f}", f"{best:.1f}", f"{p50:.0f}", f"{p99:.0f}")
        lines.append((scene, robot, " ".join(settings), *numbers))
    head = ("scene", "robot", "settings", "real-time factor", "best run", "control tick, median [us]", "99 % [us]")
    write_table(FOLDER / "real_time.md", [markdown_table(head, lines)])


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
