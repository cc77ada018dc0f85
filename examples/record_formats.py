"""One walk in four files of four makers: each is recognised by its content and becomes the same recording.

python examples/record_formats.py
"""

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from plantar.formats import ReadOptions, detect_format, formats, read_recording

print("known:", ", ".join(formats()))

with TemporaryDirectory() as name:
    folder = Path(name)
    insole_walk = Path(__file__).with_name("insole_walk.py")
    subprocess.run([sys.executable, insole_walk, folder / "insole.dat"], check=True)  # no ending helps or harms
    walk = read_recording(folder / "insole.dat")
    left, right = (walk.feet[side].force for side in ("left", "right"))

    np.savez(folder / "arrays.npz", time=walk.time, left=left, right=right, unit="N")
    heads = ["time [s]", *(f"left {k} [N]" for k in range(99)), *(f"right {k} [N]" for k in range(99))]
    table = np.column_stack([walk.time, left, right])
    np.savetxt(folder / "table.csv", table, delimiter=",", header=",".join(heads), comments="")
    np.savez(folder / "bare.npz", time=walk.time, values=left)  # states neither foot nor unit: the user does

    for file in sorted(folder.iterdir()):
        options = ReadOptions(unit="N", side="left") if file.stem == "bare" else None
        recording = read_recording(file, options=options)
        peak = recording.feet["left"].vertical_force.max()
        rate = recording.rate_hz
        print(f"{file.name}: {detect_format(file).title}, {len(recording.feet)} feet, {rate:.0f} Hz, peak {peak:.0f} N")
