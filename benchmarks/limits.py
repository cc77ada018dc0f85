"""Where robots break, by `plantar sweep --limit`: `benchmarks/limits.py FOLDER [ROBOT-SCENE ...]`.

Finds the push from each side, over one foot and the other, and the beam's width at which half of the runs are
completed, on fresh seeds, to a tenth at 95 %. FOLDER keeps the rows of a stopped search.
"""

import os
import sys
from pathlib import Path

from resumable import processor_time, write_table

from plantar.bench.tables import markdown_table
from plantar.sim.sweep import LimitSearch, plan_from_texts, run_sweep

FOLDER = Path(__file__).parent
PUSHES = ("direction=forward,backward,left,right", "push.step=3,4")
"""Sides, and a step of the right foot and one of the left: by chance from any side, in any step, half of the pushes are
too much somewhere between these eight curves, and known slowly."""

MOST = {"push": 100, "beam": 1000}
"""Runs of each curve: a push over a side that fails, holds and fails again is known no better with more."""

SEARCHES = {
    "h1-push": ("push", "h1", PUSHES, "impulse=10:100", "N s"),
    "hrp2kai-push": ("push", "hrp2kai", PUSHES, "impulse=5:80", "N s"),
    "h1-beam": ("beam", "h1", (), "width=0.02:0.2", "m"),
    "hrp2kai-beam": ("beam", "hrp2kai", (), "width=0.02:0.2", "m"),
}


def main(folder: Path, names: list[str]) -> None:
    lines = []
    head = ["scene", "robot", "limit", "95 % interval", "width", "runs", "completed", "processor time of a run [s]"]
    for name in names:
        scene, robot, grid, limit, unit = SEARCHES[name]
        plan = plan_from_texts(scene, grid, MOST[scene], robot=robot, limit=limit, first_seed=1000)
        assert isinstance(plan, LimitSearch)
        before = processor_time()
        found = run_sweep(plan, folder / name, workers=os.cpu_count() or 1)
        used = processor_time() - before
        print(f"{name}: {found['runs']} runs took {used:.0f} s of processor time", file=sys.stderr)
        for outcome in found["limits"]:
            low, high = outcome["interval"] or (float("nan"), float("nan"))
            where = " ".join([f"`{scene}`", *outcome["settings"].values()])
            limit = f"{outcome['limit']:.3g} {unit}" if outcome["reached"] else "not known so well"
            width = f"{outcome['width']:.1%}" if outcome["width"] is not None else "-"
            a_run = f"{used / found['runs']:.2f}" if found["runs"] else "-"
            counts = outcome["runs"], outcome["completed"]
            lines.append((where, robot, limit, f"{low:.3g} to {high:.3g}", width, *counts, a_run))
        write_table(FOLDER / "limits.md", [markdown_table(head, lines)])  # after each: one takes up to half an hour


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:] or list(SEARCHES))
