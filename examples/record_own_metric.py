"""A mask and your own measure over every step that the analysis finds.

python examples/record_own_metric.py [RECORDING]
"""

import subprocess
import sys
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from plantar.formats import read_recording
from plantar.gait.analysis.parameters import analyse_foot

if len(sys.argv) > 1:
    path = Path(sys.argv[1])
else:
    path = Path(mkdtemp()) / "walk.asc"
    subprocess.run([sys.executable, Path(__file__).with_name("insole_walk.py"), path], check=True)

recording = read_recording(path)
for side, foot in recording.feet.items():
    x = foot.layout.positions[:, 0]
    back, front = np.percentile(x, [40, 70])
    masks = {"heel": x < back, "midfoot": (x >= back) & (x < front), "forefoot": x >= front}
    rolls = []
    for step in analyse_foot(recording, side).steps:
        frames = (recording.time >= step.heel_strike_s) & (recording.time <= step.toe_off_s)
        time, force = recording.time[frames], foot.force[frames]
        peak = {name: time[force[:, mask].sum(axis=1).argmax()] for name, mask in masks.items()}
        rolls.append(peak["forefoot"] - peak["heel"])
    print(f"{side}: {len(rolls)} steps, forefoot loaded {np.mean(rolls):.2f} +- {np.std(rolls):.2f} s after the heel")
