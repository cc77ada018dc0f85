"""Square and oblong taxels, and a grid that is turned: how much of a sole each covers.

python examples/sole_squares.py
"""

import numpy as np

from plantar import Percept, Reading, grid_layout

angle = np.linspace(0.0, 2.0 * np.pi, 80, endpoint=False)
outline = np.column_stack([0.12 * np.cos(angle), 0.05 * np.sin(angle)])  # m; x forward, y left
sole_area = np.pi * 0.12 * 0.05

grids = {
    "squares": grid_layout(outline, pitch=(0.02, 0.02)),
    "whole squares": grid_layout(outline, pitch=(0.02, 0.02), clip=False),
    "oblong cells": grid_layout(outline, pitch=(0.03, 0.01)),
    "turned by 30 degrees": grid_layout(outline, pitch=(0.02, 0.02), angle=np.radians(30.0)),
}
for name, sole in grids.items():
    force = 200.0e3 * sole.areas  # N: 200 kPa everywhere
    percept = Percept(sole, Reading(time=0.0, force=force))
    share = sole.areas.sum() / sole_area
    print(f"{name}: {len(sole)} taxels on {100 * share:.0f} % of the sole, load {percept.vertical_force:.0f} N")
