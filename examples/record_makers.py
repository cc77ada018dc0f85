"""One foot on a plate and on insoles, in the text exports of five makers: what each reader makes of it.

python examples/record_makers.py
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from plantar.formats import detect_format, read_recording

frames = np.zeros((5, 46, 16))  # kPa in cells of 5.08 mm: rises, stands, falls
for k, share in enumerate((0.2, 0.8, 1.0, 0.7, 0.1)):
    frames[k, 1:45, 1:15] = 45.0 * share


def rows(frame, by="\t"):
    """Lines of a frame's cells."""
    return [by.join(f"{value:.1f}" for value in row) for row in frame]


emed = []
for k, frame in enumerate(frames):
    emed += ["", f"\t\t\t\tPage {k + 1}", "", "\tFile: C:\\novel\\1.dat \tMatrix: 64x95 "]
    emed += ["\tSensor area: 0.25 cm²\tTime/picture:10.0 ms", "\tSensor size: 0.500x0.500 cm"]
    emed += [f"\tPict-No.: {k + 1}  Force[N]=sum*sensor_area in row/column", ""]
    emed += ["\t" + "\t".join(str(i + 1) for i in range(16))]
    emed += [f"{i + 1}\t{row}" for i, row in enumerate(rows(frame))] + ["", "\f"]

tekscan = ["DATA_TYPE MOVIE", "FILENAME walk_left.fsx", "ROW_SPACING 5.08 mm", "COL_SPACING 5.08 mm"]
tekscan += ["SENSEL_AREA 25.8064 mm2", "SECONDS_PER_FRAME 0.01", "UNITS KPa", "ASCII_DATA @@", ""]
for k, frame in enumerate(frames):
    tekscan += [f"Frame {k + 1}", *rows(frame, ","), ""]

footscan = ["footscan entire plate roll off", ""]
for k, frame in enumerate(frames):
    plate = np.pad(frame, ((1, 1), (24, 24))) * 1e3 * 5.08e-3**2  # its cells hold N
    footscan += [f"Frame {k} ({10 * k} ms)", *rows(plate), ""]

xsensor = ["File:,walk.XSN", "Units:,kPa"]
for k, frame in enumerate(frames):
    xsensor += [f"FRAME,{k}", f"Time, 08:00:00.{10 * k:03d}", "SENSOR,HX210-DFM-LF S1", "Rows,46", "Columns,16"]
    xsensor += ["Sensel Width (cm),0.508", "Sensel Height (cm),0.508", "SENSELS", *rows(frame, ",")]

moticon = ["# Size: 7", "# time\t" + "\t".join(f"left pressure {c + 1}[N/cm²]" for c in range(16))]
moticon += [f"{k / 100:.3f}\t" + "\t".join([f"{0.75 * frames[k].max() / 10:.2f}"] * 16) for k in range(5)]

with TemporaryDirectory() as folder:
    makers = {"emed": emed, "tekscan": tekscan, "footscan": footscan, "xsensor": xsensor, "moticon": moticon}
    for maker, lines in makers.items():
        path = Path(folder) / f"{maker}_left.txt"
        path.write_text("\n".join([*lines, ""]), encoding="latin-1" if maker == "emed" else "utf-8")
        recording = read_recording(path)
        foot = recording.feet["left"]
        print(f"{detect_format(path).name}: {foot.force.shape[1]} cells, peak {foot.vertical_force.max():.0f} N")
