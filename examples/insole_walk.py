"""Write a made-up walk on pressure insoles as a .asc file, to try `plantar analyze` without a recording at hand.

    python examples/insole_walk.py walk.asc

Each step's force has the two humps of a healthy adult's; eight parts of the sole share it, each in its time of stance.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

RATE, STRIDES, CYCLE, CONTACT, WEIGHT, CELL = 50, 13, 1.08, 0.67, 690.0, 174e-6  # Hz, -, s, s, N, m^2
ROWS = (5, *(7,) * 12, 6, 4)  # cells of each row, from heel to toe; in a row from the inner to the outer edge
PLACES = np.array([((row + 0.5) / 15, (k + 0.5) / n) for row, n in enumerate(ROWS) for k in range(n)])
PARTS = [  # place along and across, size along and across, peak in kPa, begin, middle and end in stance
    (0.13, 0.48, 0.085, 0.34, 230, -0.02, 0.17, 0.62),  # heel
    (0.42, 0.82, 0.14, 0.22, 70, 0.06, 0.38, 0.78),  # outer arch
    (0.70, 0.14, 0.06, 0.16, 210, 0.20, 0.74, 0.96),  # ball, below the big toe
    (0.74, 0.38, 0.06, 0.15, 250, 0.18, 0.76, 0.97),  # ball, second
    (0.73, 0.58, 0.06, 0.15, 220, 0.16, 0.72, 0.96),  # ball, third
    (0.67, 0.86, 0.07, 0.16, 120, 0.12, 0.62, 0.93),  # ball, fourth and fifth
    (0.92, 0.18, 0.05, 0.20, 240, 0.42, 0.85, 1.01),  # big toe
    (0.91, 0.62, 0.05, 0.30, 90, 0.46, 0.82, 1.00),  # the other toes
]
STANCE = [0.0, 0.12, 0.22, 0.34, 0.48, 0.62, 0.76, 0.87, 1.0]
HUMPS = PchipInterpolator(STANCE, [0.0, 0.72, 1.07, 0.90, 0.74, 0.88, 1.10, 0.72, 0.0])  # in body weights


def insole_pressure(stance: float) -> np.ndarray:
    """Pressures (99,) in kPa at an instant of stance, 0 at heel strike and 1 at toe off."""
    load = np.zeros(len(PLACES))
    for along, across, length, width, peak, begin, middle, end in PARTS:
        phase = np.interp(stance, [begin, middle, end], [0.0, 0.5, 1.0])
        spot = ((PLACES[:, 0] - along) / length) ** 2 + ((PLACES[:, 1] - across) / width) ** 2
        load += peak * np.sin(np.pi * phase) ** 1.5 * np.exp(-0.5 * spot)
    return load * WEIGHT * HUMPS(stance) / max(1e3 * CELL * load.sum(), 1.0)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python examples/insole_walk.py FILE.asc")
    lines = ["made-up walk", "sensor type: x0001l/x0002r", "pressure values in kPa", f"scanning rate [Hz]: {RATE}"]
    lines.append("\t".join(["time[secs]", *[str(1 + cell) for cell in range(len(PLACES))] * 2]))
    vary = np.random.default_rng(0)
    times = np.arange(int(STRIDES * CYCLE * RATE)) / RATE
    feet = np.zeros((len(times), 2, len(PLACES)))
    for foot, first in enumerate((0.2, 0.2 + CYCLE / 2)):
        for strike in first + CYCLE * np.arange(STRIDES) + vary.normal(0.0, 0.012, STRIDES):
            step = (times > strike) & (times < strike + CONTACT)
            pressures = [insole_pressure(stance) for stance in (times[step] - strike) / CONTACT]
            feet[step, foot] = vary.normal(1.0, 0.02) * np.array(pressures)
    for time, frame in zip(times, feet, strict=True):
        cells = 2.5 * np.round(frame.ravel() / 2.5)  # the sensor resolves 2.5 kPa
        lines.append("\t".join([f"{time:.3f}", *(f"{value:g}" for value in cells)]))
    out = Path(sys.argv[1])
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("\n".join(lines) + "\n", encoding="ascii")
