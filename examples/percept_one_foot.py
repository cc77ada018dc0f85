"""What one sole measures on a stone under its inner half: nothing is computed before it is asked for.

python examples/percept_one_foot.py
"""

import numpy as np

from plantar import Percept, Reading, hex_layout, polygon

outline = [[-0.10, -0.06], [0.14, -0.06], [0.14, 0.06], [-0.10, 0.06]]
sole = hex_layout(outline, cell_area=400e-6)
on_stone = (sole.positions[:, 1] > 0.0) & (np.abs(sole.positions[:, 0] - 0.02) < 0.06)
force = np.where(on_stone, 25.0, 0.0)  # N a taxel

percept = Percept(sole, Reading(time=0.0, force=force))
print("CoP in m:", np.round(percept.position_cop_in_sole, 3).tolist())
print("wrench in N and N m:", np.round(percept.wrench_in_sole, 2).tolist())
print(f"support polygon: {len(percept.support_polygon_in_sole)} corners, {1e4 * percept.support_area:.1f} cm^2")
print(f"that is {100 * percept.area_ratio:.0f} % of the sole: may the robot stand on it?")

margin = polygon.signed_margin(percept.support_polygon_in_sole, percept.position_cop_in_sole)
print(f"the CoP keeps {1e3 * margin:.0f} mm to the edge of what carries")
print("computed so far:", ", ".join(sorted(set(vars(percept)) & set(Percept.members()))))
