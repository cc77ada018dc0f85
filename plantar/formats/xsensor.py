"""XSENSOR CSV exports: a header and pressure matrix a frame and insole.

Matrices of cell groups (heel, toes, ...) are skipped. Headers' load and contact area check the unit and refine the
cells' area; in swing the stated load is 0.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.errors import FormatError
from plantar.formats.cells_of_foot import foot_of_matrix, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import side_of
from plantar.formats.stated_rate import or_usual
from plantar.formats.table_text import seconds_of_time
from plantar.formats.text import cells_of_row, head_text, number, number_in, open_text, row_of_numbers
from plantar.formats.units import LENGTHS, Unit, find_unit
from plantar.layouts.layout import Side
from plantar.recordings.frame_table import FrameTable
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, sampling

_USUAL_SIZE = 0.0086
_LARGEST = 100_000  # Most cells of a matrix, and rows and columns that are believed
_MOST_SENSORS = 100
_MOST_FACTS = 1000
_MOST_EMPTY = 1000
_LONGEST_NAME = 200
_THRESHOLD = 1e3
_KEYWORDS = ("FRAME", "SENSOR", "GROUP", "SENSELS", "DATE", "TIME")
_ENOUGH = 50.0  # Load in N from which the header's figures are taken to check the unit and the cells' area


def _recognises(head: bytes) -> bool:
    text = head_text(head)
    return re.search(r"^\W*SENSELS\b", text, re.MULTILINE) is not None and "SENSOR" in text and "FRAME" in text


@dataclass
class _Sensor:
    """One insole over all frames: numbers of those with a whole matrix, and matrices as rows."""

    name: str
    rows: int = 0
    columns: int = 0
    frames: list[int] = field(default_factory=list)
    values: FrameTable = field(default_factory=lambda: FrameTable(0, 0))
    load: list[float] = field(default_factory=list)
    contact: list[float] = field(default_factory=list)
    damaged: int = 0
    repeated: int = 0

    def add(self, frame: int, rows: list[NDArray[np.float64]], file_size: int) -> None:
        """Add a frame's matrix if whole and of the sensor's shape; the first defines both."""
        if self.frames[-1:] == [frame]:
            self.repeated += 1
            return
        stated = self.rows or len(rows)
        widths = {len(r) for r in rows}
        if len(rows) != stated or len(widths) != 1 or stated * len(rows[0]) > _LARGEST:
            return
        if not self.frames:
            self.rows = stated
            self.columns = len(rows[0])
            self.values = FrameTable(self.rows * self.columns, file_size // (2 * self.rows * self.columns))
        if widths == {self.columns}:
            self.frames.append(frame)
            self.values.add(np.concatenate(rows)[None])

    def of_frames(self, count: int) -> NDArray[np.float64]:
        """First frames' matrices (count, cells); NaN if missing."""
        if self.frames == list(range(len(self.frames))) and len(self.frames) >= count:
            return self.values.rows[:count]
        if count > _MOST_EMPTY + 5 * len(self.frames):
            raise FormatError(
                f"{len(self.frames)} of {count} frames hold a matrix of {self.name!r}; the file is damaged"
            )
        out = np.full((count, self.rows * self.columns), np.nan)
        there = np.array(self.frames) < count
        out[np.array(self.frames)[there]] = self.values.rows[there]
        return out


@dataclass
class _Scan:
    file_size: int
    facts: dict[str, str] = field(default_factory=dict)
    clock: list[float | None] = field(default_factory=list)
    numbers: list[float] = field(default_factory=list)
    sensors: dict[str, _Sensor] = field(default_factory=dict)
    sensor: _Sensor | None = None
    rows: list[NDArray[np.float64]] | None = None
    delimiter: str = ","

    def take_row(self, line: str) -> bool:
        """Whether a line is a row of the matrix, which it joins."""
        sensor = self.sensor
        rows = self.rows
        if rows is None or sensor is None or not _is_row(line, len(rows), sensor.rows):
            return False
        width = sensor.columns or (len(rows[0]) if rows else 1)
        if len(rows) <= (sensor.rows or _LARGEST // max(1, width)):  # a matrix of too many rows is never taken
            row = _row(line, self.delimiter, sensor.columns)
            sensor.damaged += row is None
            rows.append(np.full(width, np.nan) if row is None else row)
        return True

    def take_header(self, text: str) -> None:
        self.delimiter = _delimiter(text, self.delimiter)
        parts = [p.strip().strip('"') for p in text.split(self.delimiter)]
        key = parts[0].rstrip(":").strip()
        value = next((p for p in parts[1:] if p), "")
        word = key.upper()
        if word in ("FRAME", "GROUP", "SENSOR"):
            self.finish_matrix()
            self.sensor = None
        if word == "FRAME":
            self._begin_frame(value)
        elif word == "SENSOR":
            self._begin_sensor(value[:_LONGEST_NAME])
        elif word == "TIME" and self.clock:
            self.clock[-1] = seconds_of_time(value)
        elif word == "SENSELS":
            self.rows = [] if self.sensor is not None else None
        elif self.sensor is not None:
            _take_fact(self.facts, self.sensor, key, value)
        elif word != "GROUP":
            _keep(self.facts, key, value)

    def finish_matrix(self) -> None:
        if self.rows and self.sensor is not None and self.clock:
            self.sensor.add(len(self.clock) - 1, self.rows, self.file_size)
        self.rows = None

    def _begin_frame(self, value: str) -> None:
        self.clock.append(None)
        figure = number(value)
        self.numbers.append(np.nan if figure is None else figure)
        if len(self.clock) > _MOST_EMPTY + 5 * max((len(s.frames) for s in self.sensors.values()), default=0):
            raise FormatError(f"fewer than one in five of {len(self.clock)} frames hold a matrix of SENSELS")

    def _begin_sensor(self, name: str) -> None:
        self.sensor = self.sensors.setdefault(name, _Sensor(name))
        if len(self.sensors) > _MOST_SENSORS:
            raise FormatError(f"more than {_MOST_SENSORS} sensors; one or two feet can be read")
        self.sensor.load.append(np.nan)
        self.sensor.contact.append(np.nan)


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    with open_text(path) as stream:
        scan = _scan(stream, path.stat().st_size)
    warnings: list[str] = []
    frames = len(scan.clock)
    sensors = {name: s for name, s in scan.sensors.items() if s.frames}
    if not frames or not sensors:
        raise FormatError("the file holds no frame with a matrix of SENSELS")
    if min(s.frames[-1] for s in sensors.values()) == frames - 2:
        frames -= 1
        warnings.append("the last frame is cut short: left out")
    unit = _unit(scan.facts, options, warnings)
    time, rate, notes = _times(scan.clock[:frames], scan.numbers[:frames], options, warnings)
    _check_repeated(sensors.values(), warnings)
    feet: dict[Side, FootRecording] = {}
    grid = None
    for side, sensor in _sides(sensors, options, warnings):
        shape = sensor.rows, sensor.columns
        values = sensor.of_frames(frames)
        lost = int(np.isnan(values).all(axis=1).sum())
        if lost == frames:
            raise FormatError(f"no frame of the {side} insole holds a number")
        if lost:
            warnings.append(f"{lost} frame(s) of the {side} insole are missing: they count as not measured")
        if sensor.damaged:
            warnings.append(f"{sensor.damaged} row(s) of the {side} insole hold no numbers: they count as not measured")
        size = _cell(scan.facts, sensor, values, unit, side, warnings)
        if unit.kind == "pressure":
            _check_load(sensor, values, unit.factor * size[0] * size[1], frames, side, warnings)
        cells = np.ones(shape, dtype=bool)
        feet[side] = foot_of_matrix(side, values, unit, options, cells, size, sensor.name, _THRESHOLD)
        grid = shape
    warnings.append("the first row of each matrix is taken as the toes, its columns as seen from above")
    feet = {s: feet[s] for s in SIDES if s in feet}
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={"sensors": [s.name for s in sensors.values()], "unit": unit.name},
        warnings=(*warnings, *notes),
        raw=unit.kind == "raw",
        grid=grid,
    )


def _scan(stream: TextIO, file_size: int) -> _Scan:
    scan = _Scan(file_size)
    for line in stream:
        if not scan.take_row(line):
            text = line.strip().strip("\ufeff")
            if text.strip(",;\t "):
                scan.take_header(text)
    scan.finish_matrix()
    return scan


def _delimiter(text: str, before: str) -> str:
    if ";" in text and "," not in text.split(";")[0]:
        return ";"
    return "\t" if "\t" in text else "," if "," in text else before


def _is_row(line: str, taken: int, rows: int) -> bool:
    """Whether a line is a due matrix row without first keyword, perhaps damaged."""
    if line[:1].isdigit():
        return True
    content = line.strip().strip(",;\t ")
    if content.partition(",")[0].strip().upper() in _KEYWORDS:
        return False
    return taken < rows and any(c.isdigit() for c in content)


def _take_fact(facts: dict[str, str], sensor: _Sensor, key: str, value: str) -> None:
    low = key.lower()
    figure = number(value)
    if low in ("rows", "columns") and figure is not None and 0 < figure <= _LARGEST and figure == int(figure):
        if low == "rows":
            sensor.rows = sensor.rows or int(figure)
        else:
            sensor.columns = sensor.columns or int(figure)
    elif low.startswith("est. load") and figure is not None:
        sensor.load[-1] = figure * (1e3 if "(kn)" in low else 1.0 if "(n)" in low else np.nan)
    elif low.startswith("contact area") and figure is not None:
        sensor.contact[-1] = figure * (1e-4 if "cm" in low else 1e-6 if "mm" in low else np.nan)
    elif low.startswith(("sensel", "average pressure")):
        _keep(facts, low if low.startswith("sensel") else "average pressure", f"{value} {key}")


def _keep(facts: dict[str, str], key: str, value: str) -> None:
    if len(facts) < _MOST_FACTS:
        facts.setdefault(key[:_LONGEST_NAME].lower(), value[:_LONGEST_NAME])


def _row(line: str, delimiter: str, columns: int) -> NDArray[np.float64] | None:
    """One matrix row; None with anything not a number. Blank cells were not measured."""
    cells = line.rstrip("\n").split(delimiter) if columns else cells_of_row(line, delimiter)
    if columns and (len(cells) < columns or any(c.strip() for c in cells[columns:])):
        return None
    values, wrong = row_of_numbers(cells[: columns or None])
    return None if wrong else values


def _unit(facts: dict[str, str], options: ReadOptions, warnings: list[str]) -> Unit:
    bracket = re.search(r"\(([^)]*)\)", facts.get("average pressure", ""))
    name = facts.get("units", "") or (bracket[1] if bracket else "")
    unit = unit_of_values(name, options, warnings, pressures=True)
    if options.unit is None and bracket and find_unit(bracket[1]) != unit and facts.get("units"):
        warnings.append(f"the file states {name} and, at its averages, {bracket[1]}: {name} is used, check the unit")
    return unit


def _times(
    clock: list[float | None], numbers: list[float], options: ReadOptions, warnings: list[str]
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    seconds = np.array([np.nan if t is None else t for t in clock])
    if options.rate_hz is not None or np.isfinite(seconds).sum() < 2:
        rate = or_usual(options.rate_hz, "the frames have no times", warnings)
        return _places(numbers, warnings) / rate, rate, ()
    seconds = seconds - seconds[np.isfinite(seconds)][0]
    seconds[seconds < -43200.0] += 86400.0  # past midnight
    return sampling(seconds, None)


def _places(numbers: list[float], warnings: list[str]) -> NDArray[np.float64]:
    """Frames' places (n,) in the recording by number, or in sequence where these do not rise by 1."""
    places = np.array(numbers) - numbers[0]
    steps = np.diff(places)
    missing = places[-1] + 1.0 - len(numbers)  # of more than there are, they are damaged, or count something else
    if not ((steps >= 1.0) & (steps == np.round(steps))).all() or not missing <= len(numbers):
        return np.arange(len(numbers), dtype=np.float64)
    if missing:
        warnings.append(f"{missing:.0f} frame number(s) are missing: gaps in time")
    return places


def _check_repeated(sensors: Iterable[_Sensor], warnings: list[str]) -> None:
    for sensor in sensors:
        if sensor.repeated > 0.1 * len(sensor.frames):
            raise FormatError(
                f"{sensor.repeated} of {len(sensor.frames)} frames hold more than one matrix of {sensor.name!r}: "
                "give each sensor a name of its own"
            )
        if sensor.repeated:
            warnings.append(
                f"{sensor.repeated} frame(s) hold more than one matrix of {sensor.name!r}: the first counts"
            )


def _sides(sensors: dict[str, _Sensor], options: ReadOptions, warnings: list[str]) -> list[tuple[Side, _Sensor]]:
    if len(sensors) > 2:  # a damaged name makes a sensor of its own; the two that have most frames are the feet
        kept = sorted(sensors.values(), key=lambda s: -len(s.frames))[:2]
        lost = sum(len(s.frames) for s in sensors.values()) - sum(len(s.frames) for s in kept)
        if lost > 0.1 * len(kept[0].frames):
            raise FormatError(f"the file holds {len(sensors)} sensors; one or two feet can be read")
        warnings.append(f"{lost} matrix(es) are of sensors of another name: left out")
        sensors = {s.name: s for s in kept}
    named = [(side_of(s.name), s) for s in sensors.values()]
    if len(named) == 2 and {n for n, _ in named} == {"left", "right"}:
        return [(side, s) for side, s in named if side is not None]
    if len(named) == 2:
        warnings.append("the sensors' names do not state which foot they are: taken as left and right in their order")
        return [("left", named[0][1]), ("right", named[1][1])]
    side = options.side or named[0][0]
    if side is None:
        warnings.append("the sensor's name does not state which foot it is: taken as the left one (--side overrides)")
    return [(side or "left", named[0][1])]


def _cell(
    facts: dict[str, str], sensor: _Sensor, values: NDArray[np.float64], unit: Unit, side: Side, warnings: list[str]
) -> tuple[float, float]:
    sides: list[float] = []
    for name in ("sensel height", "sensel width"):
        text = next((v for k, v in facts.items() if k.startswith(name)), "")
        value = number_in(text)
        length = re.search(r"\((\w+)\)", text)
        factor = LENGTHS.get(length[1].lower()) if length else None
        if value is not None and value > 0.0 and factor is not None:
            sides.append(value * factor)
    if len(sides) < 2:
        warnings.append("the file states no sensel width and height: 8.6 x 8.6 mm is assumed")
        sides = [_USUAL_SIZE, _USUAL_SIZE]
    height, width = sides
    contact = np.array([c for c, load in zip(sensor.contact, sensor.load, strict=True) if load > _ENOUGH])
    loaded = [
        int((m > 0.0).sum())
        for m, load in zip(sensor.values.rows, sensor.load[: len(sensor.values)], strict=False)
        if load > _ENOUGH
    ]
    n = min(len(contact), len(loaded))
    if n and unit.kind != "raw":
        ratio = float(np.median(contact[:n] / np.maximum(loaded[:n], 1))) / (height * width)
        if abs(ratio - 1.0) < 0.015:  # the stated width and height are rounded
            return height * float(np.sqrt(ratio)), width * float(np.sqrt(ratio))
        if len(sides) == 2 and abs(ratio - 1.0) > 0.05:
            warnings.append(
                f"cells of {height * 1e3:g} x {width * 1e3:g} mm do not agree with the {side} insole's stated contact "
                "area: check the cell size"
            )
    return height, width


def _check_load(
    sensor: _Sensor, values: NDArray[np.float64], factor: float, frames: int, side: Side, warnings: list[str]
) -> None:
    sums = np.array([np.nansum(m) * factor for m in sensor.values.rows])
    load = np.array(sensor.load[: len(sums)])
    known = (load > _ENOUGH) & (sums > 0.0) if len(load) == len(sums) else np.zeros(0, dtype=bool)
    if known.any():
        ratio = float(np.median(sums[known] / load[known]))
        if abs(ratio - 1.0) > 0.05:
            warnings.append(
                f"the {side} insole's load is {ratio:.3g} times the one that the file states: check unit and cell size"
            )


FORMAT = Format(
    name="xsensor", title="XSENSOR export", suffixes=(".csv",), recognises=_recognises, read=_read, order=14
)
