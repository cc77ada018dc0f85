"""Tables of PhysioNet's "Gait in Parkinson's Disease" (gaitpdb): 19 columns without names.

Time in s; eight sensors in N under the left foot, then under the right one; the two feet's sums, by which the table is
known (https://physionet.org/content/gaitpdb).
"""

from pathlib import Path

import numpy as np

from plantar.errors import FormatError
from plantar.formats.format import Format, ReadOptions
from plantar.formats.text import head_text, open_text, row_of_numbers, table_of_lines
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, sampling

_WIDTH = 19
_CELLS = 8
_ROWS = 20  # Rows that are looked at
_SAME = 0.02  # N, or as a share, by which sums may differ from the cells': numbers are rounded


def _recognises(head: bytes) -> bool:
    lines = [line.split() for line in head_text(head).splitlines()[:_ROWS] if line.strip()]
    if len(lines) < 3 or any(len(cells) != _WIDTH for cells in lines[:-1]):
        return False
    table = np.array([row_of_numbers(cells)[0] for cells in lines[:-1]])
    sums = table[:, 1:-2].reshape(len(table), 2, _CELLS).sum(axis=2)
    return bool((np.diff(table[:, 0]) > 0.0).all() and np.allclose(sums, table[:, -2:], rtol=_SAME, atol=_SAME))


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    with open_text(path) as stream:
        rows = (line.rstrip("\n") for line in stream if line.strip())
        table = table_of_lines(path, rows, None, _WIDTH, warnings)
    if len(table) < 2:
        raise FormatError("fewer than two rows: no recording over time")
    time, rate, notes = sampling(table[:, 0], None, options.rate_hz)
    cells = {"left": table[:, 1 : 1 + _CELLS], "right": table[:, 1 + _CELLS : 1 + 2 * _CELLS]}
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet={side: FootRecording(side, values, None) for side, values in cells.items()},  # type: ignore[misc,arg-type]
        metadata={"unit": "N"},
        warnings=(
            *warnings,
            *notes,
            "the sensors' places are not in the file: forces only, no pressures and centres of pressure",
        ),
    )


FORMAT = Format(
    name="gaitpdb",
    title="PhysioNet's gaitpdb table",
    suffixes=(".txt",),
    recognises=_recognises,
    read=_read,
    order=19,
)
