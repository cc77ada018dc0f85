"""Counts of a sole become newtons: a ball is rolled over it on a scale, and each gain gets its interval.

python examples/calibrate_a_sole.py
"""

import numpy as np

from plantar import Percept, Reading, calibrate, hex_layout
from plantar.calibration import Take

rng = np.random.default_rng(0)
outline = [[-0.07, -0.045], [0.09, -0.045], [0.09, 0.045], [-0.07, 0.045]]  # m; x forward, y left
sole = hex_layout(outline, cell_area=691e-6, side="left", clip=False)
true_gain = 0.05 * rng.uniform(0.6, 1.4, len(sole))  # N per count, as cells scatter


def counts_of(force: np.ndarray) -> np.ndarray:
    """What the sole's converter makes of forces (k, n) in N."""
    return np.round(80.0 + force / true_gain + rng.normal(0.0, 1.0, force.shape))


time = np.arange(3000) / 50.0  # a minute
x = 0.075 * np.sin(0.9 * time)  # the ball goes to and fro, and slowly across
y = -0.04 + 0.08 * time / time[-1]
distance = np.hypot(sole.positions[:, 0] - x[:, None], sole.positions[:, 1] - y[:, None])
share = np.exp(-0.5 * (distance / 0.012) ** 2)
scale = 50.0 + 25.0 * np.sin(1.7 * time)  # N, what the scale below the sole reads
force = scale[:, None] * share / share.sum(axis=1, keepdims=True)

takes = [
    Take("zero", time[:100], {"left": counts_of(np.zeros((100, len(sole))))}),
    Take("press", time, {"left": counts_of(force)}, load=scale + rng.normal(0.0, 0.3, len(time))),
]
found = calibrate(takes, sole)
print(found.text())

known = found.calibrations["left"]
worst = np.abs(known.gain / true_gain - 1.0).max()
percept = Percept(found.layout, Reading(0.0, known.forces(counts_of(force[1000:1001]), sole)[0]))
cop = 1e3 * percept.position_cop_in_sole
deviation = 1e3 * percept.cop_deviation_in_sole
print(f"worst gain {100.0 * worst:.1f} % off")
print(f"CoP {cop[0]:.1f}, {cop[1]:.1f} mm, standard deviation {deviation[0]:.2f}, {deviation[1]:.2f} mm")
