"""Make a robot that walks of a model, check it, and let it take four steps: what `plantar robot` does, from Python.

MUJOCO_GL=egl python examples/introduce_robot.py my_robot.urdf out/mine
"""

import os
import sys
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

from plantar.shoes.found_foot import shoe_for_surface
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene
from plantar.sim.survey.check import check_robot
from plantar.sim.survey.introduce import introduce


def main(model: str, folder: str) -> bool:
    """Introduce, check and walk; tells whether it walked."""
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    made = introduce(model, out, shoe_for_surface)
    print(made.text(out))
    file = out / "robot.toml"
    print(check_robot(file, "flat").text())
    walk = run_scene(load_scene("flat", ["steps=4"], robot=str(file)))
    tilt = walk["final"]["tilt_deg"]
    print(f"{walk['steps_taken']} of {walk['steps_planned']} steps, at the end tilted by {tilt:.2f} degrees")
    return bool(walk["completed"])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("give a model and a folder: python examples/introduce_robot.py my_robot.urdf out/mine")
    sys.exit(0 if main(*sys.argv[1:3]) else 1)
