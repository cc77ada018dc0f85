"""Round FSRs, a sheet and four load cells on one sole: fitted, laid out in a file, read back, and what each shows.

    python examples/sole_other_cells.py [PICTURE.png]

`plantar shoe FOOT --cell fsr_402_short` does the same, and prints the shoe; a cell of your own is a TOML file.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from plantar import Percept, Reading, read_layout
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.shoes import build_shoe, export_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import read_cell
from plantar.sim.sensing.sole_pressure import SolePressure

foot = foot_from_dimensions("robot", length=0.2, width=0.09, corner_radius=0.03)
LOAD, COP = 250.0, (0.02, 0.01)  # N; m forward and left
soles = {}
for name in ("fsr_402_short", "velostat", "fx29_100"):
    build = build_shoe(foot, side="left", cell=read_cell(name), layout_only=True)
    with tempfile.TemporaryDirectory() as folder:
        export_shoe(build, folder)
        layout = soles[name] = read_layout(Path(folder) / "layout_left.json")
    face = [tuple(corner) for corner in layout.outline]
    percept = Percept(layout, Reading(0.0, SolePressure(layout).spread(face, LOAD, COP)))
    x, y = percept.position_cop_in_sole
    measured = 100.0 * layout.areas.sum() / layout.sole_area
    print(
        f"{name}: {len(layout)} cells feel {measured:.0f} % of the sole and carry {percept.vertical_force:.1f} N; "
        f"CoP {1e3 * x:.1f} mm forward, {1e3 * y:.1f} mm left; support polygon {1e4 * percept.support_area:.0f} cm^2"
    )

if len(sys.argv) > 1:
    figure, panels = new_figure(9.0, 6.0, rows=3)
    for axes, (name, layout) in zip(panels, soles.items(), strict=True):
        for i in range(len(layout)):
            axes.fill(*1e3 * layout.cell_polygon(i).T, facecolor=COLOURS["cell"], edgecolor=COLOURS["edge"], lw=0.6)
        axes.plot(*1e3 * np.vstack([layout.outline, layout.outline[:1]]).T, color=COLOURS["left"], lw=1.5)
        axes.set_title(f"--cell {name}: {len(layout)} cells", fontsize=9, loc="left")
        axes.set_aspect("equal")
    panels[-1].set_xlabel("mm, toes to the right")
    print(save_figure(figure, sys.argv[1]))
