"""Lay hexagonal taxels on a sole, keep them in a file, and ask where they are.

python examples/sole_hexagons.py [LAYOUT.json]
"""

import sys
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from plantar import hex_layout, mirrored, read_layout, write_layout

angle = np.linspace(0.0, 2.0 * np.pi, 80, endpoint=False)
waist = 1.0 - 0.25 * np.exp(-((0.12 * np.cos(angle) / 0.04) ** 2))
outline = np.column_stack([0.12 * np.cos(angle), 0.05 * waist * np.sin(angle)])  # m; x forward, y left

left = hex_layout(outline, name="my sole", cell_area=300e-6)  # m^2; cells at the rim are cut to the outline
whole = hex_layout(outline, name="whole cells only", cell_area=300e-6, clip=False)
right = mirrored(left)

for sole in (left, whole, right):
    print(f"{sole.name}, {sole.side}: {len(sole)} taxels on {1e4 * sole.areas.sum():.0f} cm^2")

path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(mkdtemp()) / "layout.json"
write_layout(left, path)
again = read_layout(path)
print(f"read back from {path.name}: {len(again)} taxels, the first at {np.round(again.positions[0], 4).tolist()} m")
