"""Write a made-up walk on pressure insoles as a .asc file, to try `plantar analyze` without a recording at hand.

    python examples/insole_walk.py walk.asc

Each foot stands 0.65 s in each 1.1 s, the right foot half a cycle after the left. A bump of pressure rolls from heel to
toe over the 99 cells of each insole.
"""

import sys
from pathlib import Path

import numpy as np

RATE, DURATION, CYCLE, CONTACT, CELLS = 50, 12.0, 1.1, 0.65, 99


def insole_pressure(phase: float) -> np.ndarray:
    """Pressures (99,) in kPa at a time in s since the last heel strike: cells are numbered from heel to toe."""
    if phase >= CONTACT:
        return np.zeros(CELLS)
    progress = phase / CONTACT
    along = np.arange(CELLS) / (CELLS - 1)
    roll = np.exp(-(((along - progress) / 0.25) ** 2))
    load = np.sin(np.pi * np.clip(progress, 0.04, 0.96)) ** 0.4
    return np.round(110.0 * load * roll / 2.5) * 2.5  # a sensor resolves 2.5 kPa


def main() -> None:
    """Write the file that the command line names."""
    if len(sys.argv) != 2:
        sys.exit("usage: python examples/insole_walk.py FILE.asc")
    lines = ["made-up walk", "pressure values in kPa", f"scanning rate [Hz]: {RATE}"]
    lines.append("\t".join(["time[secs]", *(str(1 + cell) for _ in ("left", "right") for cell in range(CELLS))]))
    for frame in range(int(DURATION * RATE)):
        time = frame / RATE
        feet = [insole_pressure((time + shift) % CYCLE) for shift in (0.3, 0.3 + CYCLE / 2)]
        lines.append("\t".join([f"{time:.3f}", *(f"{value:.1f}" for value in np.concatenate(feet))]))
    Path(sys.argv[1]).write_text("\n".join(lines) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
