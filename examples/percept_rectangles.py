"""Shapes within a contact of any form: the largest rectangle that carries, and what a wrench cone may use.

python examples/percept_rectangles.py
"""

import numpy as np

from plantar import Percept, Reading, hex_layout, polygon

outline = [[-0.10, -0.06], [0.14, -0.06], [0.14, 0.06], [-0.10, 0.06]]
sole = hex_layout(outline, cell_area=200e-6)
x, y = sole.positions[:, 0], sole.positions[:, 1]
beam = np.abs(y - 0.35 * x) < 0.03  # the sole stands across a beam that runs at an angle
percept = Percept(sole, Reading(0.0, np.where(beam, 10.0, 0.0)))


def sizes(name, ring):
    print(f"{name}: {1e4 * abs(polygon.area(ring)):.1f} cm^2, corners {np.round(ring, 3).tolist()}")


print(f"cells {1e4 * percept.contact_area:.1f} cm^2, their hull {1e4 * percept.support_area:.1f} cm^2")
sizes("box along the sole", percept.bounding_box_in_sole)
sizes("box at any angle", percept.oriented_box_in_sole)
sizes("largest rectangle inside, along the sole", percept.inscribed_rectangle_in_sole)
sizes("largest rectangle inside, at any angle", percept.inscribed_rectangle_any_angle_in_sole)
sizes("the same, 5 mm from every edge", percept.safe_rectangle_in_sole(0.005))
sizes("within the exact outline of the cells, along the sole", percept.outline_rectangle_in_sole)
