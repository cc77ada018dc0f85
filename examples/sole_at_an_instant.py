"""What a sole perceives at an instant of a recording: a picture, and the same as JSON.

python examples/sole_at_an_instant.py [RUN.mcap [TIME [FOLDER]]]
"""

import sys
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

import plantar
from plantar.recordings.recorder import Recorder

path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(mkdtemp()) / "step.mcap"
time = float(sys.argv[2]) if len(sys.argv) > 2 else None
folder = Path(sys.argv[3]) if len(sys.argv) > 3 else path.parent

if len(sys.argv) < 2:  # a foot that rolls from its heel, 250 mm long, and sees the ground 8 mm below its toes
    sole = plantar.hex_layout([[-0.10, -0.06], [0.15, -0.06], [0.15, 0.06], [-0.10, 0.06]], cell_area=400e-6)
    x = sole.positions[:, 0]
    with Recorder(path, {}, {"left": sole}) as recorder:
        skin = recorder.channel("/skin/left", [("force", len(sole))])
        near = recorder.channel("/proximity/left", [("distance", len(sole))])
        for tick in range(100):
            reach = -0.10 + 0.0025 * tick
            skin.write(0.01 * tick, np.where(np.abs(x - reach) < 0.05, 9.0, 0.0))
            near.write(0.01 * tick, np.clip(0.15 * (x - reach - 0.03), 0.0, None))

view = plantar.sole(path, time)
print(view)
for line in view.lines():
    print("  " + line)
for file in view.save(folder):
    print("wrote", file.name)
