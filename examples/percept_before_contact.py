"""Proximity: where a foot will stand, before it touches down, and how the ground slopes there.

python examples/percept_before_contact.py
"""

import numpy as np

from plantar import Percept, Reading, hex_layout, polygon

outline = [[-0.10, -0.06], [0.14, -0.06], [0.14, 0.06], [-0.10, 0.06]]
sole = hex_layout(outline, cell_area=400e-6)
x, y = sole.positions[:, 0], sole.positions[:, 1]

ground = 0.012 + np.tan(np.radians(8.0)) * (x + 0.10)  # distance in m: it falls away by 8 degrees forward
stone = (x > 0.04) & (y > 0.0)
distance = np.where(stone, 0.004, ground)
percept = Percept(sole, Reading(0.0, np.zeros(len(sole)), proximity=distance))

area = abs(polygon.area(percept.preemptive_polygon_in_sole))
print(f"{int(percept.near.sum())} of {len(sole)} taxels are near; their hull has {1e4 * area:.0f} cm^2")
for contour in percept.height_contours_in_sole:
    print(f"  closer than {1e3 * contour.height:.0f} mm: {int(contour.taxels.sum())} taxels")
plane = percept.ground_plane_in_sole
slope = np.degrees(np.arctan(plane.slope[0]))
print(f"the ground without the stone: {1e3 * plane.height:.0f} mm below, {slope:.1f} degrees forward")
