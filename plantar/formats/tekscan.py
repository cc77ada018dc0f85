"""Tekscan ASCII exports (.asf, .csv): header of KEY value lines, then a matrix a frame.

F-Scan insoles, mats and walkways share it. "B" marks places without a cell.
"""

import re
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.cells_of_foot import foot_of_matrix, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import side_of
from plantar.formats.stated_rate import or_usual, stated_rate
from plantar.formats.text import (
    cells_of_row,
    frames_of_lines,
    head_text,
    number,
    number_in,
    number_rows,
    open_text,
    row_of_numbers,
)
from plantar.formats.units import LENGTHS, Unit, find_unit
from plantar.recordings.frame_table import FrameTable, blocks_of_frames
from plantar.recordings.pressure_recording import Kind, PressureRecording, sampling

_KEY = re.compile(r"\s*\"?([A-Z][A-Z0-9_]+)\"?[\s,;:]*(.*)$")
_RATES = ("SECONDS_PER_FRAME", "FREQUENCY", "FRAMES_PER_SECOND")
_FRAME = re.compile(r"\s*\"?frame\s*[,;:]?\s*(\d+)", re.IGNORECASE)
# The sign of a place without a cell where it is a part of something else.
_NO_CELL_ALONE = re.compile(r"[^\s,;]B|B[^\s,;]")
_LARGEST_HEADER = 500
_LARGEST = 200_000  # Most cells of a matrix
_MOST_EXTRA = 1000  # lines
_FIRST = 32  # Frames by which the matrix is known where the header does not state it, and a file is given up
_USUAL_PITCH = 5.08e-3
_THRESHOLD = 1e3
_WIDEST_FOOT = 0.16
_LONGEST_FOOT = 0.36


def _recognises(head: bytes) -> bool:
    text = head_text(head).upper()
    keys = sum(re.search(rf"^\W*{k}\b", text, re.MULTILINE) is not None for k in ("ROWS", "COLS", "UNITS", "DATA_TYPE"))
    return keys >= 3 or ("TEKSCAN" in text and keys >= 1) or "SECONDS_PER_FRAME" in text


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    with open_text(path) as stream:
        lines = iter(stream)
        header, first = _take_header(lines)
        numbers, (rows, columns), table = _take_frames(path, first, lines, header, warnings)
    unit = _unit(header, options, warnings)
    pitch = _pitch(header, warnings)
    named = {key: header.get(key, "") for key in _RATES}
    rate = options.rate_hz or stated_rate(named, warnings)
    steps = np.diff(numbers)
    rate = or_usual(rate, "the header states no SECONDS_PER_FRAME", warnings)
    if len(steps) and (steps > 0).all():
        time = (np.array(numbers, dtype=float) - numbers[0]) / rate
        if (steps > 1).any():
            warnings.append(f"{int((steps - 1).sum())} frame(s) are missing in the file: a gap in time")
    else:
        time = np.arange(len(numbers)) / rate
        if len(steps):
            odd = int(np.flatnonzero(steps <= 0)[0])
            warnings.append(
                f"the frames' numbers do not rise (frame {numbers[odd + 1]} follows {numbers[odd]}): frames are "
                "taken in the file's order, evenly spaced, which hides frames that are missing or written twice"
            )
    time, rate, notes = sampling(time, rate)
    present = _measuring(table.rows)
    if not present.any():
        raise FormatError("no cell of the matrix holds a number")
    large = columns * pitch[1] > _WIDEST_FOOT or rows * pitch[0] > _LONGEST_FOOT
    kind: Kind = "platform" if large else "insole"
    side = options.side or side_of(header.get("FILENAME", ""), header.get("COMMENTS", ""), path.stem)
    if side is None and kind == "insole":
        warnings.append("the file does not state which foot it is: taken as the left one (--side overrides)")
    if options.layout is None and kind == "insole":
        warnings.append("the first row of the matrix is taken as the toes, its columns as seen from above")
    warnings += [
        f"the header states {key} {header[key]}: the matrix is taken as it is written; toes and heel or left and right "
        "may be exchanged (check the pressure picture)"
        for key in ("MIRROR_ROW", "MIRROR_COL")
        if header.get(key, "").upper() not in ("", "0", "OFF", "NO", "FALSE")
    ]
    name = f"{header.get('SENSOR_TYPE', 'Tekscan sensor')} of {rows} x {columns}".strip()
    places = present.reshape(rows, columns)
    foot = foot_of_matrix(side or "left", table.columns(present), unit, options, places, pitch, name, _THRESHOLD)
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet={foot.side: foot},
        metadata={"side": side, "sensor": header.get("SENSOR_TYPE", ""), "unit": unit.name},
        warnings=(*warnings, *notes),
        kind=kind,
        raw=unit.kind == "raw",
        grid=(rows, columns),
    )


def _measuring(frames: NDArray[np.float64]) -> NDArray[np.bool_]:
    out = np.zeros(frames.shape[1], dtype=bool)
    for rows in blocks_of_frames(frames):
        out |= ~np.isnan(frames[rows]).all(axis=0)
    return out


def _take_header(lines: Iterator[str]) -> tuple[dict[str, str], re.Match[str]]:
    header: dict[str, str] = {}
    key = ""
    for count, line in enumerate(lines):
        frame = _FRAME.match(line)
        if frame:
            return header, frame
        match = _KEY.match(line)
        if match:
            key = match[1].upper()
            header.setdefault(key, match[2].strip().strip(',;" \t'))
        elif key == "COMMENTS" and line.strip(" ,;\n"):
            header[key] = f"{header[key]} {line.strip()}".strip()
        if count > _LARGEST_HEADER:
            break
    raise FormatError("not a Tekscan export: no line 'Frame 1' after the header")


def _take_frames(
    path: Path, first: re.Match[str], lines: Iterator[str], header: dict[str, str], warnings: list[str]
) -> tuple[list[int], tuple[int, int], FrameTable]:
    stated = _stated(header, "ROWS")
    frames = frames_of_lines(lines, _FRAME, first, (stated or _LARGEST) + _MOST_EXTRA)
    bodies = ((int(match[1][-18:]), [line.strip() for line in body]) for match, body in frames)
    known = list(islice(bodies, 1 if stated else _FIRST))
    if not known:
        raise FormatError("the first frame has no end")
    shape, delimiter = _shape(header, stated, [body for _, body in known])
    usual = sum(len(line) + 1 for _, body in known for line in body) // len(known)
    table = FrameTable(shape[0] * shape[1], path.stat().st_size * 5 // max(3 * usual, 1))  # frames may be shorter
    numbers: list[int] = []
    odd = 0
    last_is_cut = False
    for number_of_frame, body in chain(known, bodies):
        odd += last_is_cut  # which was not the last one
        last_is_cut = len(body) != shape[0]
        values, bad = (None, 0) if last_is_cut else _matrix(body, delimiter, *shape)
        table.add(np.full((1, shape[0] * shape[1]), np.nan) if values is None else values.reshape(1, -1))
        numbers.append(number_of_frame)
        odd += bad > 0
        if len(table) == _FIRST and odd > 0.5 * _FIRST:  # no use in reading on
            break
    if last_is_cut:
        numbers.pop()
        table.drop_last()
        warnings.append("the last frame is cut short: left out")
    stop = _stated(header, "END_FRAME")
    if stop is not None and not last_is_cut and numbers[-1] != stop:
        warnings.append(f"the header announces frames up to {stop}, the file ends with frame {numbers[-1]}")
    if not len(table) or odd > 0.2 * len(table):
        raise FormatError(
            f"{odd} of {len(table) + last_is_cut} frames are no matrix of {shape[0]} x {shape[1]} numbers"
        )
    if odd:
        warnings.append(f"{odd} damaged frame(s): what is no number counts as not measured")
    return numbers, shape, table


def _shape(header: dict[str, str], rows: int | None, bodies: list[list[str]]) -> tuple[tuple[int, int], str | None]:
    first = bodies[0]
    rows = rows or int(np.median([len(b) for b in bodies]))
    delimiter = next((d for d in ";\t," if first and d in first[0]), None)
    widths = [len([c for c in cells_of_row(line, delimiter) if c.strip()]) for line in first] or [0]
    columns = _stated(header, "COLS") or int(np.median(widths))
    if rows < 1 or columns < 1 or rows * columns > _LARGEST:
        raise FormatError(f"a matrix of {rows} x {columns} cells cannot be read; allowed: up to {_LARGEST}")
    if int(np.median(widths)) != columns:
        raise FormatError(f"the header states {columns} columns, the rows of the matrix have {max(widths)}")
    return (rows, columns), delimiter


def _matrix(body: list[str], delimiter: str | None, rows: int, columns: int) -> tuple[NDArray[np.float64], int]:
    values = _fast(body, delimiter, rows, columns)
    if values is not None:
        return values, 0
    bad = 0
    values = np.full((rows, columns), np.nan)
    for r, line in enumerate(body):
        cells = cells_of_row(line, delimiter)[:columns]
        row, wrong = row_of_numbers(["" if c.strip().upper() == "B" else c for c in cells])
        bad += wrong + (len(cells) != columns)
        values[r, : len(row)] = row
    return values, bad


def _fast(body: list[str], delimiter: str | None, rows: int, columns: int) -> NDArray[np.float64] | None:
    if delimiter is None or len(body) != rows:
        return None
    text = "\n".join(body)
    if _NO_CELL_ALONE.search(text):
        return None
    return number_rows(text.replace("B", "").split("\n"), delimiter, columns)


def _stated(header: dict[str, str], key: str) -> int | None:
    value = number(header.get(key, "").split(",")[0].split(";")[0])
    return int(value) if value is not None and 0 < value == int(value) else None


def _unit(header: dict[str, str], options: ReadOptions, warnings: list[str]) -> Unit:
    stated = header.get("UNITS", "")
    first = re.split(r"[\s,;]", stated)[0]
    unit = unit_of_values(first if find_unit(stated) is None and find_unit(first) else stated, options, warnings)
    other = (*header.get("SATURATION_PRESSURE", "").split(), stated, stated)[1]  # after its number, if it has one
    if options.unit is None and find_unit(other) != find_unit(stated) and unit.kind == "pressure":
        warnings.append(f"the readings are stated in {stated}, the saturation pressure in {other}: check the unit")
    return unit


def _pitch(header: dict[str, str], warnings: list[str]) -> tuple[float, float]:
    def length(key: str) -> float | None:
        text = header.get(key, "")
        value = number_in(text)
        words = re.findall(r"[a-z]+", text.lower())
        unit = next((LENGTHS[w] for w in words if w in LENGTHS), None)
        if value is not None and value > 0.0 and unit is None:
            warnings.append(f"{key} states no unit of length: mm is assumed")
        return None if value is None or value <= 0.0 else value * (unit or 1e-3)

    stated = [pitch for key in ("ROW_SPACING", "COL_SPACING") if (pitch := length(key)) is not None]
    text = header.get("SENSEL_AREA", "").lower()
    area = (number_in(text) or 0.0) * (1e-4 if "cm" in text else 0.0254**2 if "in" in text else 1e-6)
    if not stated and area > 0.0:
        warnings.append("the header states no spacing: square cells of its sensel area are assumed")
        return float(np.sqrt(area)), float(np.sqrt(area))
    if not stated:
        warnings.append("the header states no spacing of rows and columns: 5.08 mm is assumed")
        return _USUAL_PITCH, _USUAL_PITCH
    if len(stated) == 1:
        warnings.append("the header states one spacing of rows and columns: taken for both")
    rows = stated[0]
    columns = stated[-1]
    if area > 0.0 and abs(rows * columns - area) > 0.02 * area:
        warnings.append(
            f"spacings of {rows * 1e3:g} x {columns * 1e3:g} mm and a sensel area of {area * 1e6:g} mm2 do not agree: "
            "the spacings are used, check the forces"
        )
    return rows, columns


FORMAT = Format(
    name="tekscan", title="Tekscan export", suffixes=(".asf", ".csv"), recognises=_recognises, read=_read, order=13
)
