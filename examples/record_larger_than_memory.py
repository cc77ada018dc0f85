"""Go through a recording that does not fit into memory, block by block, from a file.

python examples/record_larger_than_memory.py [FRAMES]
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from plantar import batch, hex_layout

frames = int(sys.argv[1]) if len(sys.argv) > 1 else 200_000
sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]])

with TemporaryDirectory() as folder:
    path = Path(folder) / "force.npy"
    force = np.lib.format.open_memmap(path, "w+", np.float32, (frames, len(sole)))  # what a sensor has written
    for rows, _ in batch.blocks(force):
        phase = np.arange(rows.start, rows.stop) / 100.0  # 100 frames a second, a step a second
        force[rows] = np.maximum(0.0, np.sin(2.0 * np.pi * phase))[:, None] * 10.0
    force.flush()

    stored = np.load(path, mmap_mode="r")
    impulse, longest, peak = 0.0, 0.0, 0.0
    for _, block in batch.blocks(stored):
        loads = batch.loads(sole, block)
        impulse += loads.vertical_force.sum() / 100.0
        peak = max(peak, loads.vertical_force.max())
        longest = max(longest, block.nbytes / 1e6)
    print(f"{stored.nbytes / 1e6:.0f} MB on disk, {longest:.1f} MB at a time")
    print(f"peak {peak:.0f} N, impulse {impulse / (frames / 100.0):.1f} N s a second")
