"""Take a robot that steps in place by its forearm, and lead it: the arm gives way first, then the feet follow.

python examples/walk_guided.py [SEED]
"""

import sys

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

seed = int(sys.argv[1]) if len(sys.argv) > 1 else 0
short = ["steps=8", "way=0.15", "toward=backward", "within=0"]  # 0.15 m, beginning 2 s after the start

for name, arm in (("an arm that yields", []), ("a stiff arm", ["arm.gain=0", "spring=8", "damper=0.15"])):
    summary = run_scene(load_scene("guide", [*short, *arm]), seed)
    guided = summary["guide"]
    print(
        f"{name} gave way by {1e3 * guided['arm_yielded_m']:.0f} mm under at most {guided['largest_force_N']:.0f} N, "
        f"and the feet followed by {1e3 * guided['feet_followed_m']:.0f} mm in {summary['steps_taken']} steps"
    )
