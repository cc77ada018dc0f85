"""Balance gains of your own: a sweep over a gain while the robot is pushed, and the one that ends nearest upright.

python examples/walk_own_gains.py [FOLDER]
"""

import csv
import sys
from pathlib import Path
from tempfile import mkdtemp

from plantar.sim.sweep import Sweep, run_sweep


def main():
    """Three values of the DCM's gain, one seed each; the table is results.csv in the folder."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(mkdtemp())
    push = ["steps=3", "settle=0.5", "impulse=25", "push.step=1", "direction=backward"]
    sweep = Sweep.from_texts("push", ["balance.dcm_gain=0,3,8"], seeds=1, settings=push)  # 1/s; h1 walks with 3
    run_sweep(sweep, folder, workers=1)
    with (folder / "results.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    for row in rows:
        ended = "completed" if row["completed"] == "True" else "failed"
        print(
            f"dcm_gain {row['balance.dcm_gain']}: {ended}, tilted by {float(row['tilt_max_deg']):.2f} degrees at most"
        )
    best = min(rows, key=lambda row: (row["completed"] != "True", float(row["tilt_max_deg"])))
    print(f"of these a robot's file would say: [balance] dcm_gain = {best['balance.dcm_gain']}")


if __name__ == "__main__":  # the sweep starts processes, which import this file
    main()
