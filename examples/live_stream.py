"""Readings of an insole as they come by UDP, with rubbish between them: what is no reading is counted.

python examples/live_stream.py
"""

import socket
import threading
import time

import numpy as np

from plantar import Percept, Reading, hex_layout
from plantar.live import open_live, open_sink

PORT = 19870
outline = [[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]]  # m; x forward, y left
sole = hex_layout(outline, cell_area=400e-6, side="left")


def insole() -> None:
    """Send 2 s at 100 Hz: the load rolls from heel to toe. Some packets are rubbish, and the clock begins again."""
    send = open_sink(f"udp:{PORT}")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        for k in range(200):
            middle = -0.08 + 0.2 * k / 200
            force = 30.0 * np.exp(-(((sole.positions[:, 0] - middle) / 0.04) ** 2))
            send("left", Reading(0.01 * (k % 120), force))
            if k % 10 == 0:
                other.sendto(b"\xff\xfe,,,", ("127.0.0.1", PORT))
            time.sleep(0.01)


stream = open_live(f"udp:{PORT}", sole)  # of this machine alone
threading.Thread(target=insole, daemon=True).start()
for count, (side, reading) in enumerate(stream.readings, 1):
    if count % 40 == 0:
        percept = Percept(stream.soles[side], reading)
        place = percept.position_cop_in_sole
        ahead = "no load" if place is None else f"CoP {1e3 * place[0]:.0f} mm ahead"
        print(f"{side} {reading.time:.2f} s: {percept.vertical_force:.0f} N, {ahead}")
    if count == 200:
        break
stream.close()
print({kind: number for kind, number in stream.faults.items() if number})
