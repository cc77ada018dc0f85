"""Heat: a push away from what is hot, before it burns, from the same taxels.

python examples/percept_temperature.py
"""

import numpy as np

from plantar import Percept, Reading, hex_layout

outline = [[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]]
sole = hex_layout(outline)
warm = np.hypot(sole.positions[:, 0] - 0.10, sole.positions[:, 1]) < 0.05
temperature = np.where(warm, 45.0, 24.0)  # degC

percept = Percept(sole, Reading(0.0, np.zeros(len(sole)), temperature=temperature))
wrench = percept.temperature_wrench_in_sole
print(f"{int(warm.sum())} taxels at 45 degC push with {wrench[2]:.0f} N, about y with {wrench[4]:.2f} N m")
print("warm footprint in m:", np.round(percept.temperature_footprint_in_sole, 3).tolist())
