"""Balance gains of your own: a sweep over a gain while the robot is pushed, and whether the gain makes a difference.

python examples/walk_own_gains.py [FOLDER]
"""

import csv
import sys
from pathlib import Path
from statistics import median
from tempfile import mkdtemp

from plantar.sim.sweep import Sweep, run_sweep

GAINS = ("0", "3", "8")  # of the DCM's integral in 1/s; h1 walks with 3


def main():
    """Each gain on the same three seeds; the table is results.csv in the folder."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(mkdtemp())
    push = ["steps=3", "settle=0.5", "impulse=25", "push.step=1", "direction=backward"]
    run_sweep(Sweep.from_texts("push", [f"balance.dcm_gain={','.join(GAINS)}"], seeds=3, settings=push), folder)
    with (folder / "results.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    tilts = {}
    for gain in GAINS:
        mine = [row for row in rows if row["balance.dcm_gain"] == gain]
        tilts[gain] = [float(row["tilt_max_deg"]) for row in mine]
        done = sum(row["completed"] == "True" for row in mine)
        print(f"dcm_gain {gain}: completed {done} of {len(mine)}, tilted by {median(tilts[gain]):.2f} degrees (median)")
    apart = max(map(median, tilts.values())) - min(map(median, tilts.values()))
    by_chance = max(max(tilt) - min(tilt) for tilt in tilts.values())
    verdict = "choose by it" if apart > 2.0 * by_chance else "too little to choose by: more seeds, or a harder push"
    print(f"gains differ by {apart:.2f} degrees, seeds by {by_chance:.2f}: {verdict}")


if __name__ == "__main__":  # the sweep starts processes, which import this file
    main()
