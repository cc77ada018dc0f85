"""A stream on a page of this machine: an insole's walk as it comes, with its steps, and what a button does.

python examples/live_page.py
"""

import math
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from plantar import Reading, hex_layout, mirrored
from plantar.live import CheckedStream, LiveStream
from plantar.viewer.live_page import LivePage
from plantar.viewer.live_session import record_with_page
from plantar.viewer.live_state import LiveState

outline = [[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]]  # m; x forward, y left
left = hex_layout(outline, cell_area=691e-6, side="left")
soles = {"left": left, "right": mirrored(left)}


def walk(seconds: float, pace: float) -> Iterator[tuple[str, Reading]]:
    """Readings at 100 Hz of a walk with a step each 0.55 s, `pace` times as fast as the clock."""
    for k in range(round(100 * seconds)):
        for side, ahead in (("left", 0.0), ("right", 0.55)):
            share = ((0.01 * k + ahead) % 1.1) / 0.68  # of the contact
            load = 720.0 * math.sin(math.pi * share) ** 0.4 if 0.0 < share < 1.0 else 0.0
            roll = np.exp(-(((left.positions[:, 0] + 0.08 - 0.2 * share) / 0.05) ** 2))
            yield side, Reading(0.01 * k, load * roll / roll.sum())
        time.sleep(0.01 / pace)


with tempfile.TemporaryDirectory() as folder, LivePage(soles, "Live: insole") as page:
    print(f"open {page.url} while it runs")
    stream = CheckedStream(LiveStream(soles, walk(3.0, 4.0), "insole"))
    found = record_with_page(stream, page, Path(folder) / "walk.mcap")
    print(f"{found['seconds']:.1f} s recorded, {found['feet']['left']['frames']} readings of the left sole")

state = LiveState(soles)  # what the page shows, without a page
for side, reading in walk(10.0, 1e9):
    state.take(side, reading)
for name, on_left, on_right in state.as_dict()["measures"]:
    print(f"{name}: {on_left} {on_right}")
