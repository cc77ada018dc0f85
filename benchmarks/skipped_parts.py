"""What each thing that a scene may not need costs: `python benchmarks/skipped_parts.py [--rounds N]`.

Each is computed where the scene does not need it, or switched off where it has it. A round walks the scene as it is and
once with each of them, so that a slow minute of the machine meets all; differences are of the same round.
"""

import argparse
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from resumable import write_table

from plantar.bench.tables import markdown_table
from plantar.gait.command import Command
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

FOLDER = Path(__file__).parent
SCENES = (("flat", "h1"), ("uneven", "h1"), ("uneven", "hrp2kai"))
SHORT = "walk.steps=2"


class EveryMember(Simulation):
    """Computes all members of each percept."""

    def compute_rest(self, command: Command, everything: bool) -> int:
        return super().compute_rest(command, True)


class EveryRay(Simulation):
    """Casts the proximity rays of both soles at each sample."""

    def sense(self, k: int) -> None:
        if k % self.sensors.skin_every == 0:
            self.sensors.read_skins(self.controller.proximity_sides, True, self.judge.feet)


# What, how it is left out, the simulation or setting that changes it, and the count in the summary's `skipped`.
Change = type[Simulation] | str
PARTS: tuple[tuple[str, str, Change, str], ...] = (
    ("members of percepts", "automatic: computed when asked for", EveryMember, "percept_members"),
    ("proximity rays", "automatic: of a sole about to land, near ground", EveryRay, "proximity_rays"),
    ("recording", "automatic: with `--record` or `--plot`", "record", "recorded_ticks"),
    ("preemptive foot compliance", "`control.pfc=false`", "control.pfc=false", ""),
    ("turning soles to the ground", "`control.conform=false`", "control.conform=false", ""),
    ("footholds", "`control.footholds=off`", "control.footholds=off", ""),
    ("refusal of footholds", "`control.feasibility=off`", "control.feasibility=off", ""),
    ("moved steps", "`control.step_adjustment=false`", "control.step_adjustment=false", ""),
    ("estimate of pushes", "`control.push_estimate=off`", "control.push_estimate=off", ""),
    ("momentum of the legs", "`control.leg_momentum=false`", "control.leg_momentum=false", ""),
    ("half of the skin's samples", "`sensing.skin_rate=125`", "sensing.skin_rate=125", ""),
)


def walked(scene: tuple[str, str], change: Change | None) -> tuple[float, dict[str, int]]:
    """Processor time of a tick in us, and the summary's `skipped`."""
    kind: Callable[..., Simulation] = Simulation if change is None or isinstance(change, str) else change
    settings = (SHORT, change) if isinstance(change, str) and change != "record" else (SHORT,)
    simulation = kind(load_scene(scene[0], settings, scene[1]), 1)
    with TemporaryDirectory() as folder:
        began = time.process_time()
        out = simulation.run(record=Path(folder) / "run.mcap" if change == "record" else None)
        used = time.process_time() - began
    return 1e6 * used * simulation.periods[1] / out["sim_time_s"], out["skipped"]


def row(part: tuple[str, str, Change, str], rounds: list[list[tuple[float, dict[str, int]]]], number: int) -> list[str]:
    """Saved time of a tick in us, median and range of a scene's rounds, and that of each thing counted in ns."""
    switched = isinstance(part[2], str) and part[2] != "record"
    saved = sorted((one[0][0] - one[number][0]) * (1 if switched else -1) for one in rounds)
    cells = [f"{median(saved):.0f} ({saved[0]:.0f} to {saved[-1]:.0f})"]
    counted = rounds[0][0][1].get(part[3], 0)
    ticks = rounds[0][0][1]["recorded_ticks"]
    return [*cells, f"{1e3 * median(saved) * ticks / counted:.0f}" if counted else "-"]


def commit() -> str:
    """Short name of the checkout's commit."""
    command = ["git", "-C", str(FOLDER), "rev-parse", "--short=8", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def main(rounds: int) -> None:
    head = ["what", "how it is left out"]
    lines = [[part[0], part[1]] for part in PARTS]
    for scene in SCENES:
        head += [f"{' '.join(scene)} [us]", "each counted [ns]"]
        seen = []
        for turn in range(rounds):
            seen.append([walked(scene, None), *(walked(scene, part[2]) for part in PARTS)])
            print(f"{' '.join(scene)} {turn + 1}/{rounds}: {seen[-1][0][0]:.0f} us a tick", file=sys.stderr)
        for number, (part, line) in enumerate(zip(PARTS, lines, strict=True), 1):
            line += row(part, seen, number)
    write_table(
        FOLDER / "skipping.md",
        [markdown_table(head, lines), "", f"Medians of {rounds} rounds, at commit {commit()}."],
        "parts",
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5, help="walks of each (5)")
    main(parser.parse_args().rounds)
