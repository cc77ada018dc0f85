"""Push a walking robot: what its soles feel keeps it upright; without that feedback it falls.

python examples/walk_push.py [SEED]
"""

import sys

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

seed = int(sys.argv[1]) if len(sys.argv) > 1 else 0
push = ["steps=4", "settle=1.0", "impulse=25", "direction=backward", "push.step=1"]  # 25 N s from the front

for feedback in ("true", "false"):
    summary = run_scene(load_scene("push", [*push, f"feedback={feedback}"]), seed)
    ended = "fell" if summary["fell"] else f"took {summary['steps_taken']} of {summary['steps_planned']} steps"
    print(f"feedback={feedback}: {ended}, tilted by {summary['tilt_max_deg']:.1f} degrees at most")
