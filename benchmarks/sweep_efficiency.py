"""How well two worker processes use two cores: `benchmarks/sweep_efficiency.py [ROUNDS]`, three rounds as a rule.

Runs the same sweep by one worker and by two, in turns, from start to figures. The efficiency is the time with one over
twice the time with two, valid only without other processes, whose share of the cores is listed. A last line lists the
sweep's part outside of its workers, and the processor time of a worker's start and of a run.
"""

import os
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import NamedTuple

from resumable import processor_time, write_table

from plantar.bench.tables import markdown_table
from plantar.sim.sweep import plan_from_texts, run_sweep

FOLDER = Path(__file__).parent
SCENE, SEEDS = "flat", 24


class Cost(NamedTuple):
    wall: float  # s
    processor: float  # s, of this process and its workers
    here: float  # s of that, in this process
    others: float  # share of all cores that other processes took


def cost(workers: int, seeds: int = SEEDS) -> Cost:
    plan = plan_from_texts(SCENE, seeds=seeds, first_seed=1000)
    with TemporaryDirectory() as folder:
        wall, busy, own, here = time.monotonic(), _busy(), processor_time(), time.process_time()
        run_sweep(plan, folder, workers=workers)
        wall, busy = time.monotonic() - wall, _busy() - busy
        own, here = processor_time() - own, time.process_time() - here
    return Cost(wall, own, here, max(0.0, busy - own) / (wall * (os.cpu_count() or 1)))


def _busy() -> float:
    """Processor time in s of everything since the machine started: Linux."""
    user, nice, system, _, _, interrupts, soft = map(int, Path("/proc/stat").read_text().split()[1:8])
    return (user + nice + system + interrupts + soft) / os.sysconf("SC_CLK_TCK")


def main(rounds: int) -> None:
    pairs, lines = [], []
    head = ("round", "one worker [s]", "two [s]", "efficiency", "processor time, one [s]", "two [s]", "others' share")
    for number in range(rounds):
        one, two = cost(1), cost(2)
        pairs.append((one, two))
        efficiency = one.wall / (2.0 * two.wall)
        numbers = (f"{v:.1f}" for v in (one.processor, two.processor))
        others = f"{max(one.others, two.others):.0%}"
        lines.append((number + 1, f"{one.wall:.1f}", f"{two.wall:.1f}", f"{efficiency:.0%}", *numbers, others))
        print(*lines[-1], file=sys.stderr, flush=True)
    few = median(cost(1, 2).processor for _ in range(rounds))
    many, here = (median(v) for v in zip(*((one.processor, one.here) for one, _ in pairs), strict=True))
    a_run = (many - few) / (SEEDS - 2)
    note = (
        f"Medians: efficiency {median(one.wall / (2.0 * two.wall) for one, two in pairs):.0%}; {a_run:.2f} s of a "
        f"processor for a run of `{SCENE}`, {many - SEEDS * a_run:.2f} s for everything else (a worker's start among "
        f"it), {here:.2f} s of that in the sweep's own process."
    )
    write_table(FOLDER / "sweep_efficiency.md", [markdown_table(head, lines), "", note])


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
