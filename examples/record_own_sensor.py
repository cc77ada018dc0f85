"""Record your own sensor: an MCAP file that Foxglove opens and `plantar analyze` reads.

python examples/record_own_sensor.py [RUN.mcap]
"""

import sys
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from plantar import hex_layout, mirrored
from plantar.formats import read_recording
from plantar.recordings.recorder import Recorder

left = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]])
soles = {"left": left, "right": mirrored(left)}
path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(mkdtemp()) / "run.mcap"

with Recorder(path, {"robot": "mine"}, soles) as recorder:
    skins = {side: recorder.channel(f"/skin/{side}", [("force", len(sole))]) for side, sole in soles.items()}
    motors = recorder.channel("/motors", [("current", 2), ("voltage", 1)])  # any else there is
    for k in range(1000):
        time = 0.01 * k
        for side, shift in (("left", 0.0), ("right", 0.55)):
            phase = (time + shift) % 1.1
            load = 700.0 * np.sin(np.pi * phase / 0.65) if phase < 0.65 else 0.0  # N: a stance of 0.65 s
            skins[side].write(time, np.full(len(left), load / len(left)))
        motors.write(time, np.array([1.0, 2.0, 48.0]))

recording = read_recording(path)
print(f"{recording.format}: {len(recording.time)} frames at {recording.rate_hz:.0f} Hz")
for side, foot in recording.feet.items():
    print(f"{side}: at most {foot.vertical_force.max():.0f} N on {len(foot.layout)} taxels")
