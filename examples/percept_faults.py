"""Taxels that are dead, saturated or stuck: they are named, left out, or filled from their neighbours.

python examples/percept_faults.py
"""

import numpy as np

from plantar import Percept, PerceptOptions, Reading, StuckMonitor, hex_layout

outline = [[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]]
sole = hex_layout(outline, cell_area=400e-6)
monitor = StuckMonitor(hold=0.5)  # s without any change while the foot is loaded
random = np.random.default_rng(0)

for k in range(200):
    force = 10.0 + 5.0 * np.sin(0.1 * k) + random.normal(0.0, 0.1, len(sole))  # N a taxel
    force[3] = np.nan  # a broken wire
    force[7] = 12.0  # a taxel that hangs
    stuck = monitor.update(0.01 * k, force)

true_load = 10.0 + 5.0 * np.sin(0.1 * 199)
reading = Reading(1.99, force)
left_out = Percept(sole, reading, stuck=stuck)
filled = Percept(sole, reading, stuck=stuck, options=PerceptOptions(fill=True))
print(left_out.health)
print(f"true load {true_load * len(sole):.0f} N: {left_out.vertical_force:.0f} N without the faulty taxels, "
      f"{filled.vertical_force:.0f} N with their neighbours' pressure")  # fmt: skip
