"""Novel pedar and pliance ASCII exports (.asc): pressures, a row a frame.

A header states sensor, rate and unit, and may list each insole's cells. Column names start with "time[secs]" and cell
numbers; where they restart, the next foot begins. Pliance exports may end with cell corners.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.errors import FormatError
from plantar.formats.cells_of_foot import scale_to_force
from plantar.formats.format import Format, ReadOptions
from plantar.formats.nominal_insole import CELL_AREAS, DEFAULT_SIZE, nominal_insole
from plantar.formats.recorded_layouts import cells_by_id, polygon_layout
from plantar.formats.stated_rate import stated_rate
from plantar.formats.text import head_text, number_rows, open_text, row_of_numbers
from plantar.formats.units import Unit, find_unit, plain
from plantar.layouts.layout import SoleLayout
from plantar.recordings.frame_table import FrameTable
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, layout_for, sampling

_COLUMNS = re.compile(r"\s*\"?time\s*\[\s*s(?:ecs?)?\s*\]\"?", re.IGNORECASE)
_NUMBER = r"[-+]?\d+(?:[.,]\d*)?(?:[eE][-+]?\d+)?"
_RATES = {"scanning rate [Hz]": r"scanning\s+rate\s*\[Hz\]", "time per frame [s]": r"time\s+per\s+frame\s*\[secs?\]"}
_LABELS = re.compile(r"\s*(?:M[VP]P|x\[|y\[|area|electrical|mechanical|corner|time)", re.IGNORECASE)
_CORNER = re.compile(r"\s*[xy]\[[0-3]\]\s")
_MOST_CORNERS = 64
_LARGEST_HEADER = 400
_LONGEST_FACT = 10_000
_WRITTEN = ("kpa", "n/cm2", "psi", "mmhg", "kg/cm2", "mpa")  # Units that the exporting programs write
# what a processor's cache holds as text and numbers
_BLOCK = 2048
_BLOCK_VALUES = 4_000_000
_CHARACTERS = 250_000
_LATEST = 1e9  # Time in s from which a line is damaged


def _recognises(head: bytes) -> bool:
    text = head_text(head).lower()
    columns = re.search(r"^\s*\"?time\s*\[\s*s(?:ecs?)?\s*\]\"?[\s;,]+\d+", text, re.MULTILINE) is not None
    return columns and ("pressure values" in text or "scanning rate" in text)


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    with open_text(path) as stream:
        header, columns, delimiter = _take_header(stream)
        text = "\n".join(header)
        sides = _sides(text, columns, options, warnings)
        time, parts, tail = _take_rows(path, stream, delimiter, len(columns), [span for _, span in sides], warnings)
    layout = options.layout
    unit = _unit(text, options, warnings)
    named = {name: _field(text, rf"{words}:?\s*({_NUMBER})") or "" for name, words in _RATES.items()}
    time, rate, doubts = sampling(time, options.rate_hz or stated_rate(named, warnings), options.rate_hz)
    warnings += doubts
    geometry = _corner_table(tail, len(columns), warnings) if layout is None else None
    feet: dict[Side, FootRecording] = {}
    for (side, span), values in zip(sides, parts, strict=True):
        sole = _layout(side, columns[span.start : span.stop], layout, geometry, text, warnings, options.insole_size)
        feet[side] = FootRecording(side, values, sole)
        scale_to_force(values, unit, sole.areas)
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={
            "sensor": _field(text, r"(?:sensor|mat)\s+type:?\s*(\S.*)") or "",
            "unit": unit.name,
            "pressure_unit_pa": unit.factor,
        },
        warnings=tuple(dict.fromkeys(warnings)),
        raw=unit.kind == "raw",
    )


def _take_header(lines: Iterable[str]) -> tuple[list[str], list[int], str | None]:
    header: list[str] = []
    for line in lines:
        if _COLUMNS.match(line):
            cells = re.findall(r"(?<![\w.])\d{1,9}(?![\w.])", _COLUMNS.sub("", line, count=1))
            if not cells:
                raise FormatError("the row of column names lists no cells")
            return header, [int(c) for c in cells], next((d for d in ";," if line.count(d) >= len(cells)), None)
        header.append(line[:_LONGEST_FACT].rstrip("\n"))
        if len(header) > _LARGEST_HEADER:
            break
    raise FormatError("not a pedar or pliance export: no row of column names that starts with time[secs]")


def _take_rows(
    path: Path, stream: TextIO, delimiter: str | None, cells: int, spans: Sequence[range], warnings: list[str]
) -> tuple[NDArray[np.float64], list[NDArray[np.float64]], list[str]]:
    """Times in s, each span's values, and lines of cell corners."""
    times = FrameTable(1, 0)
    values = [FrameTable(len(span), 0) for span in spans]
    bad = 0
    lost = []
    tail = list[str]()
    blocks = _blocks(stream, max(1, min(_BLOCK, _BLOCK_VALUES // (cells + 1))))
    for block in blocks:
        rows = _plain_frames(block, delimiter, cells)
        if rows is None:
            frames, end = _frame_lines(block)
            rows = _plain_frames(frames, delimiter, cells)
            if rows is None:
                rows = _damaged_frames(frames, delimiter, cells)
            if end < len(block):
                after = chain(block[end:], chain.from_iterable(blocks))
                tail = list(islice(filter(_CORNER.match, after), _MOST_CORNERS))
        if not len(times):
            usual = sum(map(len, block)) // len(block)  # lines may be shorter; what is not written takes no memory
            expected = len(block) + path.stat().st_size // max(usual * 3 // 5, 2 * cells)
            times = FrameTable(1, expected)
            values = [FrameTable(len(span), expected) for span in spans]
        times.add(rows[:, :1])
        for table, span in zip(values, spans, strict=True):
            table.add(rows[:, 1 + span.start : 1 + span.stop])
        lost.append(np.isnan(rows[:, 1]))
        bad += int(lost[-1].sum())
        if bad > max(0.5 * len(times), 8):  # no use in reading on
            break
    damaged = np.concatenate(lost) if lost else np.zeros(0, dtype=bool)
    if damaged[-1:].any():
        for table in (times, *values):
            table.drop_last()
        warnings.append("the last frame is cut short: left out")
    n = len(times)
    bad = int(damaged[: len(times)].sum())
    if bad == n:
        raise FormatError(f"the file holds no whole frame of {cells} cells")
    if bad > 0.2 * n:
        raise FormatError(f"{bad} of {n} frames do not have {cells} numbers; the file is damaged")
    if bad:
        warnings.append(f"{bad} damaged frame(s) are treated as not measured")
    return times.rows[:, 0], [table.rows for table in values], tail


def _blocks(stream: TextIO, most: int) -> Iterator[list[str]]:
    while lines := stream.readlines(_CHARACTERS):
        for begin in range(0, len(lines), most):
            yield lines[begin : begin + most]


def _frame_lines(block: Sequence[str]) -> tuple[list[str], int]:
    """Lines of frames, and the index of the line that begins the next section; len(block) for none."""
    frames: list[str] = []
    for i, line in enumerate(block):
        if line[:24].lstrip()[:1].isdigit():  # labels begin with a letter: quicker than the pattern
            frames.append(line)
        elif _COLUMNS.match(line):
            continue  # the names again, on another page or of another part
        elif _LABELS.match(line):
            return frames, i
        elif line.strip():
            frames.append(line)
    return frames, len(block)


def _plain_frames(block: list[str], delimiter: str | None, cells: int) -> NDArray[np.float64] | None:
    """Numbers (lines, 1 + cells); None unless all are finite and as many."""
    rows = number_rows(block, delimiter, 1 + cells)
    if rows is None or (np.abs(rows[:, 0]) >= _LATEST).any():
        return None
    # Between blanks no number is missing.
    return rows if delimiter is None or np.isfinite(rows).all() else None


def _damaged_frames(block: list[str], delimiter: str | None, cells: int) -> NDArray[np.float64]:
    out = np.full((len(block), 1 + cells), np.nan)
    for i, line in enumerate(block):
        row, _ = row_of_numbers(line.rstrip(f"{delimiter or ' '}\n").split(delimiter))
        if len(row) == 1 + cells and np.isfinite(row).all() and abs(row[0]) < _LATEST:
            out[i] = row
    return out


def _field(text: str, pattern: str) -> str | None:
    match = re.search(pattern, text, re.IGNORECASE)
    return match[1].strip() if match else None


def _unit(text: str, options: ReadOptions, warnings: list[str]) -> Unit:
    stated = options.unit or _field(text, r"pressure\s+values\s+in:?[ \t]*([^\n]*)")
    if not stated:
        warnings.append("the header states no unit of pressure: kPa is assumed, as pedar writes (--unit overrides)")
        return Unit("pressure", 1e3, "kPa")
    unit = find_unit(stated.split()[0])
    if options.unit is None and plain(stated.split()[0]) not in _WRITTEN:  # "hPa" is a damaged "kPa", not hectopascal
        unit = None
    if unit is None or unit.kind == "force":
        raise FormatError(f"unknown unit of pressure {stated!r}; allowed: {', '.join(_WRITTEN)}")
    return unit


def _sides(text: str, columns: list[int], options: ReadOptions, warnings: list[str]) -> list[tuple[Side, range]]:
    restarts = [i for i in range(1, len(columns)) if columns[i] <= columns[i - 1]]
    listed: dict[Side, int] = {}
    for name, cells in re.findall(r"(left|right)\s+insole:[ \t]*([\d,;\t ]*)", text, re.IGNORECASE):
        if count := len(re.findall(r"\d+", cells)):
            listed.setdefault("left" if name.lower() == "left" else "right", count)
    split = restarts[0] if len(restarts) == 1 else None
    if list(listed) == ["right", "left"] and sum(listed.values()) == len(columns) and split in (None, listed["right"]):
        warnings.append("the header's mask lists the right insole first: the first columns are taken as its cells")
        return [("left", range(listed["right"], len(columns))), ("right", range(listed["right"]))]
    if split is not None:
        if listed and (listed.get("left", 0), listed.get("right", 0)) != (split, len(columns) - split):
            warnings.append(
                f"the header's mask lists other cells than the columns: the columns are used "
                f"({split} left, {len(columns) - split} right)"
            )
        if listed or re.search(r"\dl.*\dr(?![a-z])", _sensor_type(text)):
            if options.side is not None:
                warnings.append("--side is not used: the file states which of its two insoles is which")
        elif options.side is None:
            warnings.append(
                "the file does not state which insole is which: the first columns are taken as the left one's (--side "
                "right, if they are the right one's)"
            )
        elif options.side == "right":
            return [("left", range(split, len(columns))), ("right", range(split))]
        return [("left", range(split)), ("right", range(split, len(columns)))]
    if restarts:
        raise FormatError(f"the column names count {len(restarts) + 1} sensors; one or two feet can be read")
    if listed.get("left") and listed.get("right") and sum(listed.values()) == len(columns):
        return [("left", range(listed["left"])), ("right", range(listed["left"], len(columns)))]
    marks = set(re.findall(r"\d([lr])(?![a-z])", _sensor_type(text)))
    marked: list[Side] = [*listed] if len(listed) == 1 else ["left" if mark == "l" else "right" for mark in marks]
    side = options.side or (marked[0] if len(marked) == 1 else None)
    if side is None:
        warnings.append("the file does not state which foot it is: taken as the left one (--side overrides)")
    return [(side or "left", range(len(columns)))]


def _sensor_type(text: str) -> str:
    return (_field(text, r"(?:sensor|mat)\s+type:?[ \t]*([^\n]*)") or "").lower()


def _layout(
    side: Side,
    cells: list[int],
    given: SoleLayout | None,
    geometry: NDArray[np.float64] | None,
    text: str,
    warnings: list[str],
    insole_size: str | None = None,
) -> SoleLayout:
    if (sole := layout_for(side, given)) is not None:
        return cells_by_id(sole, cells) or sole
    if geometry is not None:
        warnings.append(
            "cell geometry from the file's own corner table; its y is taken as forward, its x as to the right"
        )
        return _layout_of_corners(geometry, cells, side)
    size, assumed = _size(text, insole_size)
    sole = cells_by_id(nominal_insole(size, side), cells)
    if sole is None:
        raise FormatError(
            f"its {len(cells)} cells are not those of a 99-cell insole, and the file holds no geometry; "
            "give one with --layout"
        )
    warnings.append(
        f"the file holds no cell geometry: a nominal 99-cell insole of size {size.upper()}{assumed}, "
        f"{CELL_AREAS[size].mean() * 1e6:.0f} mm2 a cell, is used; forces, areas and CoP rest on it "
        "(--layout overrides)"
    )
    return sole


def _size(text: str, given: str | None) -> tuple[str, str]:
    if given is not None:
        return given, " (--insole-size)"
    stated = (_field(text, r"sensor\s+type:?[ \t]*([a-z]{1,2})(?![a-z])") or "").lower()
    if stated in CELL_AREAS:
        return stated, ""
    sizes = [float(areas.mean()) for areas in CELL_AREAS.values()]
    used = float(CELL_AREAS[DEFAULT_SIZE].mean())
    return DEFAULT_SIZE, (
        f" (assumed, the file names no known size: by the true one of {', '.join(CELL_AREAS)}, forces may be "
        f"{min(sizes) / used:.2f} to {max(sizes) / used:.2f} times these; give it by --insole-size)"
    )


def _corner_table(tail: list[str], cells: int, warnings: list[str]) -> NDArray[np.float64] | None:
    """Returns corners (cells, 4, 2) in m in file axes, from rows "x[0]" .. "y[3]" (in cm) of its tail.

    None without a whole table; reported in warnings.
    """
    rows: dict[str, NDArray[np.float64]] = {}
    for line in tail:
        if match := re.match(r"\s*([xy]\[[0-3]\])\s+(.*)", line):
            rows[match[1]], _ = row_of_numbers(match[2].split())
    if not rows:
        return None
    table = [rows.get(f"{axis}[{corner}]", np.zeros(0)) for corner in range(4) for axis in "xy"]
    if any(len(row) != cells or not np.isfinite(row).all() for row in table):
        warnings.append("the file's table of cell corners is not whole, or holds values that are no numbers: not used")
        return None
    return np.array(table).T.reshape(cells, 4, 2) * 1e-2


def _layout_of_corners(corners: NDArray[np.float64], cells: list[int], side: Side) -> SoleLayout:
    """Returns layout of a side's quadrilateral cells by corners (n, 4, 2) in m in file axes.

    File y becomes x (forward), file x becomes -y (right).
    """
    import shapely  # only where a file brings its own geometry

    turned = np.stack([corners[:, :, 1], -corners[:, :, 0]], axis=-1)
    polygons = [shapely.geometry.polygon.orient(shapely.MultiPoint(c).convex_hull) for c in turned]
    rings = [np.array(p.exterior.coords)[:-1] for p in polygons]
    return polygon_layout(rings, ids=cells, side=side, name="pliance mat")


FORMAT = Format(
    name="pedar",
    title="Novel pedar or pliance export",
    suffixes=(".asc",),
    recognises=_recognises,
    read=_read,
    order=11,
)
