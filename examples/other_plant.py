"""Walk on a robot that is not quite the one that the controller knows.

python examples/other_plant.py          # the whole plant, drawn by the seed, at growing levels
python examples/other_plant.py 7        # another seed
"""

import sys

import numpy as np

from plantar.sim.plant.draw import drawn_plant
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

seed = int(sys.argv[1]) if len(sys.argv) > 1 else 0
SHORT = ["steps=2", "settle=0.5"]


def outcome_text(summary):
    """How a walk went, in a line."""
    outcome = "completed" if summary["completed"] else ", ".join(reason["criterion"] for reason in summary["reasons"])
    return (
        f"{outcome}; largest tilt {summary['tilt_max_deg']:.1f} deg, CoM estimated to "
        f"{1e3 * max(summary['estimate']['com_error_max_m']):.0f} mm"
    )


# A scene shows what differs: everything that a robot has that was built with care, and how much of it.
for level in (0, 0.2, 0.5):
    scene = load_scene("flat", [*SHORT, "plant=random", f"plant.level={level}"])
    summary = Simulation(scene, seed).run()
    print(f"level {level:g}: {outcome_text(summary)}")
    for name, value in summary.get("plant", {}).items():
        print(f"    {name}: {np.round(value, 4).tolist()}")

# One thing alone, as a number: the walk's own model states 86 kg, and so does the controller's.
simulation = Simulation(load_scene("flat", [*SHORT, "mass_ratio=1.05"]), seed)
true_mass = float(simulation.world.model.body_subtreemass[simulation.world.torso])
print(f"the controller takes it for {simulation.legs.mass:.1f} kg, the ground carries {true_mass:.1f} kg")
print(f"mass alone: {outcome_text(simulation.run())}")

# What the seed draws is known without a run, for example to see what a hundred robots of one make would be like.
plant = load_scene("flat", ["com_offset=random"]).plant
robots = [drawn_plant(plant, k, simulation.body, 12, simulation.robot.layouts) for k in range(100)]
away = 1e3 * np.linalg.norm([robot.com_offset for robot in robots], axis=1)
print(f"of 100 robots half have their centre of mass within {np.median(away):.0f} mm, all within {away.max():.0f} mm")
