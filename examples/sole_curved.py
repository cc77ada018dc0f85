"""Taxels on a sole that is curved: what each of them presses along its own normal becomes one wrench.

python examples/sole_curved.py
"""

import numpy as np

from plantar import Percept, Reading, grid_layout, laid_over

RADIUS = 0.35  # m: a rocker sole, round about the y axis
outline = [[-0.12, -0.05], [0.12, -0.05], [0.12, 0.05], [-0.12, 0.05]]

flat = grid_layout(outline, pitch=(0.02, 0.02))
rocker = laid_over(flat, lambda x, y: RADIUS - np.sqrt(RADIUS**2 - x**2))

heel = np.where(flat.positions[:, 0] < -0.08, 15.0, 0.0)  # N a taxel, normal to its own face
for name, sole in (("flat", flat), ("rocker", rocker)):
    percept = Percept(sole, Reading(0.0, heel))
    fx, _, fz, _, ty, _ = percept.wrench_in_sole
    lift = 1e3 * sole.positions[:, 2].max()
    print(f"{name}: heel and toe {lift:.0f} mm up, force {fx:+.1f} N forward and {fz:.1f} N up, moment {ty:.2f} N m")
