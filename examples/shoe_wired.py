"""A shoe's sheet wired and read without hardware: its nets, its ghosts, and its own firmware run on this computer.

    python examples/shoe_wired.py

`plantar shoe FOOT --cell velostat` writes the same as files, with board and Gerbers. Needs a C compiler.
"""

import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from plantar.live.packets import packets_of
from plantar.shoes import build_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.wiring.firmware_files import firmware_sources, header_text
from plantar.shoes.wiring.matrix_circuit import read_conductances
from plantar.shoes.wiring.nets import wiring_of

foot = foot_from_dimensions("robot", length=0.12, width=0.07, corner_radius=0.01, mass=4.0)
build = build_shoe(foot, side="left", cell=read_cell("velostat"), layout_only=True)
shoe = build.shoes[0]
wiring = wiring_of(shoe, build.parameters)
rows, columns = shoe.plan.sheet_lines
print(
    f"{len(shoe.layout)} taxels on {rows} rows and {columns} columns; R0 joins {', '.join(map(str, wiring.nets['R0']))}"
)

pressed = np.zeros((rows, columns))
pressed[[1, 1, 3], [2, 6, 2]] = 4e-4  # S: three corners of a rectangle
for circuit in ("floating", "solved"):
    ghost = read_conductances(pressed, circuit)[3, 6] / 4e-4
    print(f"other rows {circuit}: the fourth corner, where nothing presses, reads {100 * ghost:.1f} % of the others")

with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    for file, source in firmware_sources().items():
        (folder / file).write_text(source.read_text())
    (folder / "sole.h").write_text(header_text(shoe, wiring))
    command = ["cc", "-std=c99", "-O2", "sole.c", "hardware_simulated.c", "-lm", "-o", "sole"]
    subprocess.run(command, cwd=folder, check=True)
    settings = {**os.environ, "SOLE_SECONDS": "0.7", "SOLE_PRESSED": "20"}
    sent = subprocess.run([folder / "sole"], env=settings, capture_output=True, check=True).stdout
readings = [reading for _, reading in packets_of([sent], {"left": shoe.layout})]
rise = readings[-1].force - readings[0].force
taxel, next_ = int(rise.argmax()), np.sort(rise)[-2]
print(f"{len(readings)} packets; taxel {taxel} rose by {rise.max():.0f} counts, the next by {next_:.0f}")
