"""An insole of a few round FSRs: any polygons are cells, and what lies between them carries nothing.

python examples/sole_insole.py
"""

import numpy as np

from plantar import Percept, Reading, layout_of_cells

PLACES = {  # x forward, y left, in m; radius in m
    "heel inside": (-0.095, 0.015, 0.012),
    "heel outside": (-0.095, -0.015, 0.012),
    "midfoot": (-0.010, -0.028, 0.009),
    "first metatarsal": (0.065, 0.030, 0.009),
    "third metatarsal": (0.060, 0.000, 0.009),
    "fifth metatarsal": (0.045, -0.032, 0.009),
    "great toe": (0.110, 0.028, 0.009),
}
turn = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
circle = np.column_stack([np.cos(turn), np.sin(turn)])

insole = layout_of_cells([r * circle + (x, y) for x, y, r in PLACES.values()], name="FSR insole")
force = np.array([180.0, 150.0, 20.0, 90.0, 80.0, 60.0, 70.0])  # N
percept = Percept(insole, Reading(0.0, force))

x, y = percept.position_cop_in_sole
print(
    f"{len(insole)} sensors carry {percept.vertical_force:.0f} N; CoP {1e3 * x:.0f} mm forward, {1e3 * y:.0f} mm left"
)
print(f"their hull is {1e4 * percept.support_area:.0f} cm^2, they themselves {1e4 * percept.contact_area:.0f} cm^2")
for name, share in sorted(zip(PLACES, force / force.sum(), strict=True), key=lambda part: -part[1]):
    print(f"  {name}: {100 * share:.0f} %")
