"""Measure footsteps of a walkway in StepUP-P150's form, one by one into tables: memory does not grow with their number.

python examples/record_any_size.py
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from plantar.gait.analysis.study.run_study import run_study


def footstep(peak: float, width: float) -> np.ndarray:
    """A load of some kPa that rolls from the heel (row 60) to the toes (row 12): 101 times of 75 x 40 cells."""
    row, column = np.mgrid[:75, :40]
    out = np.zeros((101, 75, 40))
    for time in range(101):
        away = ((row - (60.0 - 0.48 * time)) / 14.0) ** 2 + ((column - 19.5) / width) ** 2
        out[time] = peak * np.sin(np.pi * (time + 1) / 102.0) * np.maximum(0.0, 1.0 - away)
    return out.round().astype(np.uint8)


with TemporaryDirectory() as name:
    folder = Path(name) / "py"
    for person in (1, 2):
        for footwear, peak, width in (("BF", 240.0, 8.0), ("ST", 150.0, 11.0)):
            walk = folder / f"{person:03}" / footwear / "W1"
            walk.mkdir(parents=True)
            np.savez_compressed(walk / "pipeline_1.npz", np.array([footstep(peak, width)] * 10))
            lines = ["ParticipantID,Footwear,Speed,FootstepID,PassID,StartFrame,EndFrame,Side"]
            for step in range(10):
                side = "Left" if step % 2 else "Right"
                lines.append(f"{person},{footwear},W1,{step},0,{55 * step},{55 * step + 65},{side}")
            (walk / "metadata.csv").write_text("\n".join(lines))

    study = run_study(folder, Path(name) / "out", figures=False)  # 240,000 steps take no more memory
    people = {r.who.participant for r in study.results}
    print(f"{sum(len(r.rows) for r in study.results)} steps of {len(people)} people")
    peaks: dict[str, list[float]] = {"BF": [], "ST": []}
    for result in study.results:
        peaks[result.who.condition].append(1e-3 * result.feet["left"]["peak_pressure_Pa"])
    print(f"ST presses {np.mean(peaks['ST']):.1f} kPa, BF {np.mean(peaks['BF']):.1f}")
    print(*(f.name for f in sorted((Path(name) / "out").glob("*.csv"))))
