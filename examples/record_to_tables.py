"""A recording as CSV tables and numpy arrays, for other programs.

python examples/record_to_tables.py RUN.mcap [FOLDER]
"""

import sys
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from plantar.recordings.recording import read_mcap

if len(sys.argv) < 2:
    sys.exit("give a recording: python examples/record_to_tables.py RUN.mcap [FOLDER]")
recording = read_mcap(sys.argv[1])
folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(mkdtemp())

for topic, table in recording.topics.items():
    widths = ", ".join(f"{name} ({values[0].size})" for name, values in table.fields.items() if len(values))
    print(f"{topic}: {len(table.time)} rows of {widths}")
for file in recording.to_csv(folder):
    print("wrote", file.name)
with np.load(recording.to_npz(folder / "run.npz")) as arrays:
    print(f"run.npz holds {len(arrays.files)} arrays")
