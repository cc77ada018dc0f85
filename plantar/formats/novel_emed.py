"""Novel emed ASCII exports (.lst): a printed table for each frame of a platform.

Pages give columns, rows, pressures, and forces of rows, columns and frame, from which the pressure unit follows. Wide
frames have several pages; summary pages (MVP, MPP) follow.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.cells_of_foot import foot_of_matrix
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import side_of
from plantar.formats.stated_rate import or_usual, stated_rate
from plantar.formats.text import head_text, number, number_in, open_text
from plantar.formats.units import LENGTHS, Unit, find_unit
from plantar.layouts.layout import Side
from plantar.recordings.frame_table import MOST_VALUES
from plantar.recordings.pressure_recording import PressureRecording

_LARGEST = 1024
_MOST_PAGES = 200_000
_MOST_EMPTY = 1000
# Values of all frames' whole matrices that any file may mean, and for each of its bytes; usual is one a byte.
_SMALL = 8_000_000
_MOST_A_BYTE = 8
_USUAL_SIZE = 0.005
_THRESHOLD = 1e3
_PICTURE = re.compile(r"Pict-No\.?\s*:\s*(\d{1,9})")
_NO_FRAME = re.compile(r"\bPage\b|\bM[VP]P\b")
_FACTS = {
    "file": re.compile(r"File:\s*(.*?)\s*(?:Matrix:|$)", re.IGNORECASE),
    "matrix": re.compile(r"Matrix:\s*(\d{1,6}\s*x\s*\d{1,6})\b", re.IGNORECASE),
    "area": re.compile(r"Sensor area:\s*([\d.,]+\s*\S+)", re.IGNORECASE),
    "size": re.compile(r"Sensor size:\s*(.*)$", re.IGNORECASE),
    "time": re.compile(r"Time/picture:\s*(.*)$", re.IGNORECASE),
}


def _recognises(head: bytes) -> bool:
    text = head_text(head)
    return re.search(r"Pict-No\.?\s*:", text) is not None and "ensor" in text


@dataclass
class _Page:
    picture: int
    columns: list[int] = field(default_factory=list)
    force: float | None = None
    damaged: int = 0
    tables: list[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]] = field(default_factory=list)
    labels: list[int] = field(default_factory=list)
    values: list[NDArray[np.float64]] = field(default_factory=list)
    rows_shown: set[int] = field(default_factory=set)
    columns_shown: set[int] = field(default_factory=set)

    def close(self) -> None:
        """Join the rows read to one table."""
        self.tables.append((np.array(self.labels), np.array(self.columns), np.array(self.values)))
        self.rows_shown.update(self.labels)
        self.columns_shown.update(self.columns)
        self.labels = []
        self.values = []

    @property
    def cells(self) -> int:
        return sum(values.size for _, _, values in self.tables)

    def goes_on_with(self, page: "_Page") -> bool:
        """Whether a page continues the frame: other columns, or other rows of the same."""
        if self.picture != page.picture:
            return False
        if self.columns_shown.isdisjoint(page.columns):
            return True
        return self.columns == page.columns and self.rows_shown.isdisjoint(page.rows_shown)

    def join(self, page: "_Page") -> None:
        """Add a page of the same frame."""
        if self.columns_shown.isdisjoint(page.columns):
            self.columns += page.columns
        self.tables += page.tables
        self.rows_shown |= page.rows_shown
        self.columns_shown |= page.columns_shown
        self.force = page.force if self.force is None else self.force
        self.damaged += page.damaged


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    facts: dict[str, str] = {}
    warnings: list[str] = []
    with open_text(path) as stream:
        pages = _pages(stream, facts)
    frames = _frames(pages, warnings)
    if not frames:
        raise FormatError("the file holds no frame (no page with Pict-No. and a table)")
    ends = np.array([(r.min(), r.max(), c.min(), c.max()) for f in frames for r, c, _ in f.tables])
    if ends.min() < 1 or ends.max() > _LARGEST:
        raise FormatError(f"the tables hold no pressures in rows and columns 1 to {_LARGEST}")
    columns, rows = _matrix(facts, (int(ends[:, 3].max()), int(ends[:, 1].max())), warnings)
    size = _sensor_size(facts, warnings)
    most = min(MOST_VALUES, _SMALL + _MOST_A_BYTE * path.stat().st_size)
    if len(frames) * rows * columns > most:
        raise FormatError(
            f"{len(frames)} frames of {rows} x {columns} cells are more than its tables can mean; "
            f"allowed for a file of this size: {most / 1e6:.3g} million values"
        )
    pressure = np.zeros((len(frames), rows, columns))
    for i, frame in enumerate(frames):
        for r, c, values in frame.tables:
            pressure[i, r[:, None] - 1, c - 1] = values
    stated = np.array([np.nan if f.force is None else f.force for f in frames])
    unit = _unit(options, pressure, stated, size[0] * size[1], warnings)
    rate = options.rate_hz or stated_rate({"time per picture": facts.get("time", "")}, warnings)
    rate = or_usual(rate, "the file states no time per picture", warnings)
    time = (np.arange(len(frames)) + 1) / rate
    starts = [i for i in range(1, len(frames)) if frames[i].picture <= frames[i - 1].picture]
    for i in starts:  # trials one after the other: a pause separates their contacts
        time[i:] += 2.0
    if starts:
        warnings.append(f"the file holds {len(starts) + 1} trials: put one after the other, with pauses of 2 s")
    side: Side | None = options.side or side_of(facts.get("file", "").rsplit("\\", 1)[-1])
    whole = np.ones((rows, columns), dtype=bool)
    name = f"platform of {rows} x {columns} cells"
    values = pressure.reshape(len(frames), -1)
    foot = foot_of_matrix(side or "left", values, unit, options, whole, size, name, _THRESHOLD)
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet={foot.side: foot},
        metadata={"side": side, "file": facts.get("file", "")},
        warnings=tuple(warnings),
        kind="platform",
        raw=unit.kind == "raw",
        grid=(rows, columns),
    )


def _pages(lines: Iterable[str], facts: dict[str, str]) -> list[_Page]:
    pages: list[_Page] = []
    page: _Page | None = None
    begun = 0

    def finish() -> None:
        if page is not None and page.labels:
            page.close()
            pages.append(page)
            if len(pages) > _MOST_PAGES:
                raise FormatError(f"more than {_MOST_PAGES} pages with a table; allowed: up to as many")

    for line in lines:
        text = line.strip("\f\n ")
        if not text.strip():
            continue
        picture = _PICTURE.search(text) if ":" in text else None
        if picture:
            finish()
            page = _Page(int(picture[1]))
            begun += 1
            if begun > _MOST_EMPTY + 2 * len(pages):
                raise FormatError(f"{begun - len(pages)} of {begun} pages hold no table; the file is damaged")
            continue
        if _NO_FRAME.search(text):  # a new page; a summary's table is no frame
            finish()
            page = None
            continue
        for key, pattern in _FACTS.items() if ":" in text else ():
            match = pattern.search(text)
            if match and match[1]:
                facts.setdefault(key, match[1])
        if page is not None:
            _take_row(page, text)
    finish()
    return pages


def _take_row(page: _Page, text: str) -> None:
    cells = text.split("\t") if "\t" in text else text.split()
    label = cells[0].strip()
    if not page.columns:
        numbers = [c.strip() for c in cells if c.strip() and c.strip().lower() != "force"]
        if numbers and all(_is_count(n) for n in numbers):
            page.columns = [int(n) for n in numbers]
        return
    if label.lower() == "force":
        page.force = number(cells[len(page.columns) + 1]) if len(cells) > len(page.columns) + 1 else None
    elif _is_count(label) and len(cells) > len(page.columns):
        values = [number(cell) for cell in cells[1 : len(page.columns) + 1]]
        page.labels.append(int(label))
        page.values.append(np.array([np.nan if v is None else v for v in values]))
        page.damaged += sum(v is None for v in values)
    elif label:
        page.damaged += 1


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 10


def _frames(pages: list[_Page], warnings: list[str]) -> list[_Page]:
    frames: list[_Page] = []
    for page in pages:
        if frames and frames[-1].goes_on_with(page):
            frames[-1].join(page)
        else:
            frames.append(page)
    usual = int(np.median([f.cells for f in frames])) if frames else 0
    if len(frames) > 1 and frames[-1].cells < 0.95 * usual and frames[-1].force is None:
        frames.pop()
        warnings.append("the last frame is cut short: left out")
    if damaged := sum(f.damaged > 0 for f in frames):
        warnings.append(f"{damaged} frame(s) hold cells that are no numbers: these count as not measured")
    return frames


def _matrix(facts: dict[str, str], needed: tuple[int, int], warnings: list[str]) -> tuple[int, int]:
    match = re.match(r"(\d+)\s*x\s*(\d+)", facts.get("matrix", ""))
    if match is None:
        warnings.append(f"the file states no size of the matrix: {needed[1]} rows and {needed[0]} columns are shown")
        return needed
    stated = int(match[1]), int(match[2])
    if max(stated) > _LARGEST or stated[0] < needed[0] or stated[1] < needed[1]:
        if stated[1] >= needed[0] and stated[0] >= needed[1] and max(stated) <= _LARGEST:
            return stated[1], stated[0]
        warnings.append(f"the file states a matrix of {match[0]}, its tables reach beyond: what they show is used")
        return max(needed[0], min(stated[0], _LARGEST)), max(needed[1], min(stated[1], _LARGEST))
    return stated


def _sensor_size(facts: dict[str, str], warnings: list[str]) -> tuple[float, float]:
    numbers = [float(v.replace(",", ".")) for v in re.findall(r"\d+(?:[.,]\d+)?", facts.get("size", ""))]
    unit = next((LENGTHS[w] for w in re.findall(r"[a-z]+", facts.get("size", "").lower()) if w in LENGTHS), None)
    area = number_in(facts.get("area", ""))
    area = None if area is None or area <= 0.0 else area * (1e-6 if "mm" in facts["area"] else 1e-4)
    square = _USUAL_SIZE if area is None else float(np.sqrt(area))
    if len(numbers) == 2 and min(numbers) > 0.0 and unit is not None:
        size = numbers[1] * unit, numbers[0] * unit
        if area is None or abs(size[0] * size[1] - area) <= 0.02 * area:
            return size
        warnings.append(
            f"the file states sensors of {size[1] * 1e3:g} x {size[0] * 1e3:g} mm and of {area * 1e6:g} mm2, which "
            "do not agree: the area is used"
        )
    elif area is not None:
        warnings.append("the file states no sensor size: square sensors of its sensor area are assumed")
    else:
        warnings.append("the file states neither sensor size nor area: 5 x 5 mm is assumed")
    return square, square


def _unit(
    options: ReadOptions, pressure: NDArray[np.float64], stated: NDArray[np.float64], area: float, warnings: list[str]
) -> Unit:
    if options.unit is not None:
        unit = find_unit(options.unit)
        if unit is None or unit.kind == "force":
            raise FormatError(f"the tables hold pressures, not {options.unit}")
        return unit
    sums = np.nansum(pressure, axis=(1, 2)) * area
    known = np.isfinite(stated) & (sums > 0.0) & (stated > 0.0)
    if not known.any():
        warnings.append("the file states no unit of pressure and no forces: kPa is assumed")
        return Unit("pressure", 1e3, "kPa")
    ratio = float(np.median(stated[known] / sums[known]))
    name, factor = min((("kPa", 1e3), ("N/cm2", 1e4)), key=lambda u: abs(np.log(ratio / u[1])))
    if abs(ratio / factor - 1.0) > 0.05:
        raise FormatError(
            f"the forces are {ratio / 1e3:.4g} times pressure in kPa times sensor area, which is no unit of "
            "pressure; give one with --unit if the sensor size is right"
        )
    off = np.abs(sums * factor - stated)[known] > 0.02 + 1e-3 * stated[known]
    if off.any():
        warnings.append(
            f"in {int(off.sum())} frame(s) the stated force is not the sum of pressures: the file is damaged"
        )
    warnings.append(f"the unit of pressure, {name}, follows from the file's own forces")
    return Unit("pressure", factor, name)


FORMAT = Format(
    name="emed", title="Novel emed export", suffixes=(".lst",), recognises=_recognises, read=_read, order=12
)
