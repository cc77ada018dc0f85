"""Footscan (formerly RSscan) pressure plate text: "Frame 3 (12 ms)", then rows of cells in N.

After the R package pressuRe (0.2.4, `load_footscan`): first row hind edge; cells 5.08 mm wide, 7.62 mm long, 64 across.
"""

import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import open_input
from plantar.errors import FormatError
from plantar.formats.cells_of_foot import foot_of_matrix, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import side_of
from plantar.formats.text import cells_of_row, frames_of_lines, head_text, number, open_text, row_of_numbers
from plantar.recordings.frame_table import FrameTable
from plantar.recordings.pressure_recording import PressureRecording, possible_rate, sampling

_FRAME = re.compile(r"\W*frame\s*(\d{1,9})\s*\(\s*([\d.,]{1,15})\s*ms\s*\)", re.IGNORECASE)
# Size of a cell in m across and along the plate
_ACROSS = 5.08e-3
_ALONG = 7.62e-3
_COLUMNS = 64  # Cells across every plate: 0.5, 1, 1.5 and 2 m long plates have 64, 128, 192 and 256 along
# Pressure in Pa from which a cell counts as loaded, about 0.08 N: the least that the plate states is 0.1 N.
_THRESHOLD = 2e3
_LARGEST_HEADER = 200
_LARGEST = 200_000
_MOST_ROWS = 2000
_EXCEL = b"\xd0\xcf\x11\xe0"


def _recognises(head: bytes) -> bool:
    return re.search(r"(?:^|\n)" + _FRAME.pattern, head_text(head), re.IGNORECASE) is not None


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    with open_input(path, FormatError) as stream:
        if stream.read(4) == _EXCEL:
            raise FormatError("a binary Excel file; save it as text (tab delimited) or CSV first")
    warnings: list[str] = []
    with open_text(path) as stream:
        times, (rows, columns), table = _take_frames(path, iter(stream), warnings)
    time, rate = _times(times, options, warnings)
    time, rate, notes = sampling(time, rate)
    turned = rows == _COLUMNS != columns
    pitch = (_ACROSS, _ALONG) if turned else (_ALONG, _ACROSS)
    warnings.append(
        f"the file states no size of its cells: {_ACROSS * 1e3:g} x {_ALONG * 1e3:g} mm, as plates have them"
    )
    side = options.side or side_of(path.stem)
    unit = unit_of_values("N", options, warnings)
    whole = np.ones((rows, columns), dtype=bool)
    name = f"platform of {rows} x {columns} cells"
    foot = foot_of_matrix(side or "left", table.rows, unit, options, whole, pitch, name, _THRESHOLD)
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet={foot.side: foot},
        metadata={"side": side, "sensor": "footscan plate", "unit": unit.name},
        warnings=(*warnings, *notes),
        kind="platform",
        raw=unit.kind == "raw",
        grid=(rows, columns),
    )


def _times(stated: list[float], options: ReadOptions, warnings: list[str]) -> tuple[NDArray[np.float64], float]:
    time = 1e-3 * np.array(stated)
    steps = np.diff(time)
    if options.rate_hz is not None:
        return np.arange(len(time)) / options.rate_hz, options.rate_hz
    if not len(steps):
        raise FormatError("the file holds one frame: no step can be seen")
    if not (steps > 0.0).all():
        raise FormatError("the frames' times in ms do not rise (--rate overrides)")
    rate = possible_rate(1.0 / float(np.median(steps)), "the frames' times mean")
    if steps.max() > 1.5 * np.median(steps):
        warnings.append("frames are missing in the file: a gap in time")
    return time - time[0], rate


def _take_frames(
    path: Path, lines: Iterator[str], warnings: list[str]
) -> tuple[list[float], tuple[int, int], FrameTable]:
    times: list[float] = []
    table: FrameTable | None = None
    shape = (0, 0)
    odd = 0
    last_is_odd = False
    first = next((m for line in islice(lines, _LARGEST_HEADER + 2) if (m := _FRAME.match(line))), None)
    for mark, body in frames_of_lines(lines, _FRAME, first, _MOST_ROWS):
        time = number(mark[2])
        if time is None:
            raise FormatError(f"the time {mark[2]!r} ms of frame {mark[1]} is no number")
        delimiter = next((d for d in "\t;," if d in body[0]), None) if body else None
        if table is None:
            shape = len(body), len(cells_of_row(body[0], delimiter)) if body else 0
            if not 0 < shape[0] * shape[1] <= _LARGEST:
                raise FormatError(f"a plate of {shape[0]} x {shape[1]} cells cannot be read")
            usual = sum(len(line) + 1 for line in body)
            table = FrameTable(shape[0] * shape[1], path.stat().st_size * 5 // (3 * usual))
        odd += last_is_odd
        values = np.full(shape, np.nan)
        last_is_odd = len(body) != shape[0]
        for r, line in enumerate(() if last_is_odd else body):
            row, wrong = row_of_numbers(cells_of_row(line, delimiter)[: shape[1]])
            last_is_odd |= wrong > 0 or len(row) != shape[1]
            values[r, : len(row)] = row
        table.add(values[::-1].reshape(1, -1))
        times.append(time)
    if table is None:
        raise FormatError("not a footscan export: no line 'Frame 0 (0 ms)'")
    if last_is_odd and len(times) > 1:
        times.pop()
        table.drop_last()
        warnings.append("the last frame is cut short: left out")
    if odd > 0.2 * len(times) or np.isnan(table.rows).all():
        raise FormatError(f"{odd} of {len(times)} frames are no matrix of {shape[0]} x {shape[1]} numbers")
    if odd:
        warnings.append(f"{odd} damaged frame(s): what is no number counts as not measured")
    return times, shape, table


FORMAT = Format(
    name="footscan",
    title="footscan plate export",
    suffixes=(".txt", ".xls", ".csv"),
    recognises=_recognises,
    read=_read,
    order=16,
)
