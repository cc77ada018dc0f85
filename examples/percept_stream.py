"""A stream of readings, tick by tick: contact with hysteresis, a taxel that hangs, what a controller needs in 5 us.

python examples/percept_stream.py
"""

import numpy as np

from plantar import StuckMonitor, TaxelActivation, hex_layout, walking_tick

outline = [[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]]  # m; x forward, y left
sole = hex_layout(outline, cell_area=400e-6)
random = np.random.default_rng(0)
share = np.exp(-(((sole.positions[:, 0] - 0.02) / 0.08) ** 2))
share /= share.sum()

activation = TaxelActivation(threshold=4.0, release=2.0)  # N: above 4 it is in contact, until below 2
threshold_alone = np.zeros(len(sole), dtype=bool)
monitor = StuckMonitor(hold=0.5)
changes = {"threshold": 0, "hysteresis": 0}
active = threshold_alone
for k in range(1000):  # 4 s at 250 Hz: the foot is loaded, stands, and is lifted
    load = 650.0 * np.sin(np.pi * k / 1000) ** 0.5
    force = np.clip(load * share + random.normal(0.0, 0.3, len(sole)), 0.0, None)
    force[5] = 7.25  # hangs
    stuck = monitor.update(k / 250.0, force)
    over = force > 4.0
    changes["threshold"] += int((over != threshold_alone).sum())
    threshold_alone = over
    now = activation.update(force)
    changes["hysteresis"] += int((now != active).sum())
    active = now
    tick = walking_tick(sole, np.where(stuck, 0.0, force), aim=(0.0, 0.0), offset=0.005)
    if k == 500:
        print(f"standing: {int(active.sum())} of {len(sole)} taxels active, stuck: {np.flatnonzero(stuck).tolist()}")
        print(f"  CoP at {np.round(1e3 * tick.position_cop[:2])} mm, polygon of {1e4 * tick.support_area:.0f} cm^2")
print(f"changes of contact: {changes['threshold']} by a threshold, {changes['hysteresis']} with hysteresis")
