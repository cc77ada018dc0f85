"""Run what the tables of outcomes still lack: `python benchmarks/outcomes.py [MINUTES]`, then `... outcomes.py report`.

Partial footholds (footholds.md), unknown ground (unknown_ground.md), pushes (push.md) and skin against ankles
(balance.md): the runs that tell most first, one process, a row a run; stopped, it goes on where it was. A row's
commit is what is checked out, so run it in a worktree that nobody changes: `git worktree add ../tables`.
"""

from __future__ import annotations

import sys
import time

import balance
import footholds
import push
import unknown_ground
from resumable import Benchmark, Case, add_row, commit, show, wanted

SCRIPTS = (push, footholds, unknown_ground, balance)
TELLING = ("`stones`", "`partial-third`", "`pebbles` level, 5 mm", "feasibility-2, skin", "feasibility-3, skin")
TELLING += ("25 N s, feedback on", "30 N s, feedback on")
"""Cases that are neither always nor never completed, or were thought to be: four runs for each one of the others."""


def steps(case: Case) -> int:
    """How many steps a case walks, by which it takes its time."""
    from sim.run.scene import load_scene

    return load_scene(case.scene, case.settings, case.robot).walk.steps


def missing() -> list[tuple[Benchmark, Case, int]]:
    """All runs that are missing, the most telling first."""
    jobs = []
    for script in SCRIPTS:
        for rank, case, seed in wanted(script.BENCHMARK):
            order = rank // 4 if case.name in TELLING else rank
            jobs.append(((order, steps(case) > 30), script.BENCHMARK, case, seed))
    jobs.sort(key=lambda job: job[0])
    return [job[1:] for job in jobs]


if __name__ == "__main__":
    if sys.argv[1:] != ["report"]:
        end = time.monotonic() + 60.0 * (float(sys.argv[1]) if len(sys.argv) > 1 else 1e6)
        made = commit()
        while time.monotonic() < end:
            jobs = missing()  # again after each round: a verdict that changed asks for more
            for benchmark, case, seed in jobs:
                if time.monotonic() > end:
                    break
                show(add_row(benchmark, case, seed, made))
            if not jobs:
                break
    for script in SCRIPTS:
        script.report()
