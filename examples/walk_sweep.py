"""Count what a setting brings by a sweep: the same seeds with each value, and which of them hold a push.

python examples/walk_sweep.py [FOLDER]
"""

import sys
from pathlib import Path
from tempfile import mkdtemp

from plantar.sim.sweep import Sweep, run_sweep


def main():
    """Two values, two seeds; the table is results.csv in the folder."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(mkdtemp())
    push = ["steps=3", "settle=0.5", "impulse=25", "push.step=1", "direction=backward"]
    sweep = Sweep.from_texts("push", ["feedback=false,true"], seeds=2, settings=push)
    result = run_sweep(sweep, folder, workers=1)  # on a cluster: scheduler="tcp://host:8786"
    for point in result["points"]:
        failed = f", failed by {', '.join(point['reasons'])}" if point["reasons"] else ""
        print(f"{point['settings']}: {point['completed']} of {point['runs']} completed{failed}")
    print(f"the same sweep again finds {run_sweep(sweep, folder)['resumed']} of its 4 rows, and runs the rest")


if __name__ == "__main__":  # the sweep starts processes, which import this file
    main()
