"""A terrain of your own: solids in a scene file, walked over by feet that see the ground come.

python examples/walk_own_terrain.py
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

SCENE = """
name = "plank"
description = "A plank of 2 cm lies across the way, and a ramp after it"
robot = "h1"

[terrain]
kind = "course"
solid = [
    { shape = "box", size = [0.25, 0.5, 0.01], position = [0.45, 0.0, 0.01] },
    { shape = "box", size = [0.5, 0.5, 0.05], position = [1.25, 0.0, -0.04], angles = [0.0, 3.0, 0.0] },
]

[walk]
steps = 6
length = 0.2
settle = 1.0
"""

with TemporaryDirectory() as folder:
    file = Path(folder) / "plank.toml"
    file.write_text(SCENE)
    for pfc in ("true", "false"):  # proximity: the foot slows down before it touches, and turns with the ground
        summary = run_scene(load_scene(file, [f"pfc={pfc}"]))
        how = "completed" if summary["completed"] else ", ".join(r["criterion"] for r in summary["reasons"])
        print(f"pfc={pfc}: {how}, {summary['steps_taken']} steps, hardest landing {max(summary['impacts_N']):.0f} N")
