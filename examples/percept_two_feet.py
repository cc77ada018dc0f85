"""Both feet as one: composite ZMP and support polygon, with one foot turned and on a step.

python examples/percept_two_feet.py
"""

import numpy as np

from plantar import FeetPercept, Percept, Reading, SolePose, hex_layout, mirrored, polygon
from plantar.mechanics.rotation import rotation_from_angles

outline = [[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]]
left = hex_layout(outline)
right = mirrored(left)

poses = [
    SolePose(rotation_from_angles(0.0), np.array([0.0, 0.10, 0.0])),
    SolePose(rotation_from_angles(np.radians(-15.0)), np.array([0.20, -0.10, 0.0])),
]
forces = [np.full(len(left), 400.0 / len(left)), np.where(right.positions[:, 0] < 0.0, 12.0, 0.0)]
feet = FeetPercept([Percept(s, Reading(0.0, f)) for s, f in zip((left, right), forces, strict=True)], poses)

zmp = feet.position_zmp_in_world
print("CoP of each foot in m:", [np.round(p, 3).tolist() for p in feet.positions_cop_in_world])
print("composite ZMP in m:", np.round(zmp, 3).tolist())
print(f"support: {1e4 * feet.support_area:.0f} cm^2 within {len(feet.support_polygon_in_world)} corners")
print(f"margin of the ZMP: {1e3 * polygon.signed_margin(feet.support_polygon_in_world, zmp[:2]):.0f} mm")
