"""Walk on stiff position servos, then by torque with gains of 150 N m/rad, 1/50 of the servos' stiffness.

python examples/walk_by_torque.py
"""

from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

for drives in (["drives=servo"], ["drives=torque", "joint_stiffness=150"]):
    summary = run_scene(load_scene("flat", ["steps=4", "settle=1.0", *drives], robot="h1"))
    ended = "fell" if summary["fell"] else f"took {summary['steps_taken']} of {summary['steps_planned']} steps"
    print(f"{drives[0]}: {ended}, tilted by {summary['tilt_max_deg']:.1f} degrees at most")
