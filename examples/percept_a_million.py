"""A million frames at once: the same numbers as a percept a frame, without a loop in Python.

python examples/percept_a_million.py [FRAMES]
"""

import sys
import time

import numpy as np

from plantar import Percept, Reading, batch, hex_layout

frames = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]])
force = np.random.default_rng(0).uniform(0.0, 20.0, (frames, len(sole)))

start = time.perf_counter()
loads = batch.loads(sole, force)
middle = time.perf_counter()
polygons = batch.support_polygons(sole, force)
end = time.perf_counter()

print(f"{frames} frames of {len(sole)} taxels: wrench, area and CoP in {1e6 * (middle - start) / frames:.2f} us,")
print(f"support polygons in {1e6 * (end - middle) / frames:.2f} us a frame")
one = Percept(sole, Reading(0.0, force[123]))
print("as a percept says it:", np.abs(loads.center_of_pressure[123] - one.position_cop_in_sole[:2]).max() < 1e-12)
