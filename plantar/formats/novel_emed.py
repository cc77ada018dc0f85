"""Novel emed ASCII exports (.lst): one page of a printed table for each frame of a pressure platform.

Each page repeats a header and gives the columns and rows of the matrix that it shows, pressures, and the force of each
row, column and frame: sums of pressure times sensor area. The unit of pressure is stated nowhere; it follows from those
forces. Frames that are too wide come on several pages. Summary pages (MVP, MPP) follow the frames.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.format import Format, ReadOptions
from plantar.formats.grid_cells import grid_cells
from plantar.formats.side import side_of
from plantar.formats.text import number, number_in, open_text
from plantar.formats.units import LENGTHS, find_unit
from plantar.layout import Side
from plantar.pressure_recording import FootRecording, PressureRecording, layout_for

__all__ = ["FORMAT"]

_LARGEST = 1024
_USUAL_SIZE, _USUAL_RATE = 0.005, 100.0
_THRESHOLD = 1e3


def _recognises(head: bytes) -> bool:
    text = head.decode("latin-1")
    return b"\0" not in head and re.search(r"Pict-No\.?\s*:", text) is not None and "ensor" in text


@dataclass
class _Page:
    """One frame as its pages give it."""

    picture: int
    rows: list[tuple[int, list[str]]] = field(default_factory=list)
    columns: list[int] = field(default_factory=list)
    force: float | None = None
    cells: list[tuple[int, int, float]] = field(default_factory=list)
    damaged: int = 0


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    """Read a .lst export.

    Raises:
        FormatError: If the file holds no frame, or its forces fit no unit of pressure.
    """
    facts: dict[str, str] = {}
    warnings: list[str] = []
    with open_text(path) as stream:
        pages = _pages(stream, facts)
    frames = _frames(pages, warnings)
    if not frames:
        raise FormatError(f"{path}: the file holds no frame (no page with Pict-No. and a table)")
    indices = np.array([(r, c) for f in frames for r, c, _ in f.cells])
    if not len(indices) or indices.min() < 1 or indices.max() > _LARGEST:
        raise FormatError(f"{path}: the tables hold no pressures in rows and columns 1 to {_LARGEST}")
    columns, rows = _matrix(facts, indices, warnings)
    size = _sensor_size(facts, warnings)
    pressure = np.zeros((len(frames), rows, columns))
    for i, frame in enumerate(frames):
        r, c, v = np.array(frame.cells).T
        pressure[i, r.astype(int) - 1, c.astype(int) - 1] = v
    stated = np.array([np.nan if f.force is None else f.force for f in frames])
    factor = _unit(path, options, pressure, stated, size[0] * size[1], warnings)
    rate = options.rate_hz or _rate(facts, warnings)
    time = (np.arange(len(frames)) + 1) / rate
    starts = [i for i in range(1, len(frames)) if frames[i].picture <= frames[i - 1].picture]
    for i in starts:  # trials one after the other: a pause tells their contacts apart
        time[i:] += 2.0
    if starts:
        warnings.append(f"the file holds {len(starts) + 1} trials: put one after the other, with pauses of 2 s")
    side: Side | None = options.side or side_of(facts.get("file", "").rsplit("\\", 1)[-1])
    given = layout_for(side or "left", options.layout)
    if given is not None and len(given) != rows * columns:
        raise FormatError(f"{path}: the platform has {rows * columns} cells, layout '{given.name}' {len(given)}")
    layout = given or grid_cells(
        np.ones((rows, columns), dtype=bool),
        size[0],
        size[1],
        side=side or "left",
        name=f"platform of {rows} x {columns} cells",
        threshold=_THRESHOLD,
    )
    values = pressure.reshape(len(frames), -1)
    values *= 1.0 if factor is None else factor * layout.areas
    foot = FootRecording(side or "left", values, layout)
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet={foot.side: foot},
        metadata={"side": side, "file": facts.get("file", "")},
        warnings=tuple(warnings),
        kind="platform",
        raw=factor is None,
        grid=(rows, columns),
    )


def _pages(lines: object, facts: dict[str, str]) -> list[_Page]:
    pages: list[_Page] = []
    page: _Page | None = None
    for line in lines:  # type: ignore[attr-defined]
        text = line.strip("\f\n ")
        if not text.strip():
            continue
        picture = re.search(r"Pict-No\.?\s*:\s*(\d+)", text)
        if picture:
            page = _Page(int(picture[1]))
            pages.append(page)
            continue
        if re.search(r"\bPage\b|\bM[VP]P\b", text):  # a new page; a summary's table is nobody's frame
            page = None
            continue
        for key, pattern in (
            ("file", r"File:\s*(.*?)\s*(?:Matrix:|$)"),
            ("matrix", r"Matrix:\s*(\d+\s*x\s*\d+)"),
            ("area", r"Sensor area:\s*([\d.,]+\s*\S+)"),
            ("size", r"Sensor size:\s*(.*)$"),
            ("time", r"Time/picture:\s*(.*)$"),
        ):
            match = re.search(pattern, text, re.IGNORECASE)
            if match and match[1]:
                facts.setdefault(key, match[1])
        if page is not None:
            _take_row(page, text)
    return pages


def _take_row(page: _Page, text: str) -> None:
    cells = text.split("\t") if "\t" in text else text.split()
    label = cells[0].strip()
    if not page.columns:
        numbers = [c.strip() for c in cells if c.strip() and c.strip().lower() != "force"]
        if numbers and all(n.isascii() and n.isdigit() for n in numbers):
            page.columns = [int(n) for n in numbers]
        return
    if label.lower() == "force":
        page.force = number(cells[len(page.columns) + 1]) if len(cells) > len(page.columns) + 1 else None
    elif label.isascii() and label.isdigit() and len(cells) > len(page.columns):
        for column, cell in zip(page.columns, cells[1:], strict=False):
            value = number(cell)
            page.cells.append((int(label), column, np.nan if value is None else value))
            page.damaged += value is None
        page.rows.append((int(label), []))
    elif label:
        page.damaged += 1


def _frames(pages: list[_Page], warnings: list[str]) -> list[_Page]:
    """Pages put together to frames; a last frame that is cut short and damaged ones are reported."""
    frames: list[_Page] = []
    for page in pages:
        whole = bool(page.cells)
        if not whole:
            continue
        last = frames[-1] if frames else None
        if last is not None and last.picture == page.picture and set(last.columns).isdisjoint(page.columns):
            last.cells += page.cells
            last.columns += page.columns
            last.force = page.force if last.force is None else last.force
        elif last is not None and last.picture == page.picture and last.columns == page.columns:
            if {r for r, _ in last.rows}.isdisjoint(r for r, _ in page.rows):
                last.cells += page.cells
                last.rows += page.rows
                last.force = page.force if last.force is None else last.force
            else:
                frames.append(page)
        else:
            frames.append(page)
    usual = int(np.median([len(f.cells) for f in frames])) if frames else 0
    if len(frames) > 1 and len(frames[-1].cells) < 0.95 * usual and frames[-1].force is None:
        frames.pop()
        warnings.append("the last frame is cut short: left out")
    damaged = sum(f.damaged > 0 for f in frames)
    if damaged:
        warnings.append(f"{damaged} frame(s) hold cells that are no numbers: these count as not measured")
    return frames


def _matrix(facts: dict[str, str], indices: NDArray[np.int64], warnings: list[str]) -> tuple[int, int]:
    """Columns and rows of the platform."""
    needed = int(indices[:, 1].max()), int(indices[:, 0].max())
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
    """Pitch of rows and columns in m."""
    numbers = [float(v.replace(",", ".")) for v in re.findall(r"\d+(?:[.,]\d+)?", facts.get("size", ""))]
    unit = next((LENGTHS[w] for w in re.findall(r"[a-z]+", facts.get("size", "").lower()) if w in LENGTHS), None)
    area = number_in(facts.get("area", ""))
    in_mm = re.search(r"mm", facts.get("area", "")) is not None
    area = None if area is None or area <= 0.0 else area * (1e-6 if in_mm else 1e-4)
    if len(numbers) == 2 and min(numbers) > 0.0 and unit is not None:
        size = numbers[1] * unit, numbers[0] * unit
        if area is not None and abs(size[0] * size[1] - area) > 0.02 * area:
            side = float(np.sqrt(area))
            warnings.append(
                f"the file states sensors of {size[1] * 1e3:g} x {size[0] * 1e3:g} mm and of {area * 1e6:g} mm2, which "
                "do not agree: the area is used"
            )
            return side, side
        return size
    if area is not None:
        warnings.append("the file states no sensor size: square sensors of its sensor area are assumed")
        return float(np.sqrt(area)), float(np.sqrt(area))
    warnings.append("the file states neither sensor size nor area: 5 x 5 mm is assumed")
    return _USUAL_SIZE, _USUAL_SIZE


def _unit(
    path: Path,
    options: ReadOptions,
    pressure: NDArray[np.float64],
    stated: NDArray[np.float64],
    area: float,
    warnings: list[str],
) -> float | None:
    """Pa a unit of the tables, None for raw: the user's word, or what the file's own forces say."""
    if options.unit is not None:
        unit = find_unit(options.unit)
        if unit is None or unit.kind == "force":
            raise FormatError(f"{path}: the tables hold pressures, not {options.unit}")
        return None if unit.kind == "raw" else unit.factor
    sums = np.nansum(pressure, axis=(1, 2)) * area
    known = np.isfinite(stated) & (sums > 0.0) & (stated > 0.0)
    if not known.any():
        warnings.append("the file states no unit of pressure and no forces: kPa is assumed")
        return 1e3
    ratio = float(np.median(stated[known] / sums[known]))
    name, factor = min((("kPa", 1e3), ("N/cm2", 1e4)), key=lambda u: abs(np.log(ratio / u[1])))
    if abs(ratio / factor - 1.0) > 0.05:
        raise FormatError(
            f"{path}: the forces are {ratio / 1e3:.4g} times pressure in kPa times sensor area, which is no unit of "
            "pressure; give one with --unit if the sensor size is right"
        )
    off = np.abs(sums * factor - stated)[known] > 0.02 + 1e-3 * stated[known]
    if off.any():
        warnings.append(
            f"in {int(off.sum())} frame(s) the stated force is not the sum of pressures: the file is damaged"
        )
    warnings.append(f"the unit of pressure, {name}, follows from the file's own forces")
    return factor


def _rate(facts: dict[str, str], warnings: list[str]) -> float:
    text = facts.get("time", "")
    value = number_in(text)
    if value is None or value <= 0.0:
        warnings.append(f"the file states no time per picture: {_USUAL_RATE:g} Hz is assumed (--rate overrides)")
        return _USUAL_RATE
    if not re.fullmatch(r"\s*\d+(?:[.,]\d+)?\s*m?s\W*", text):
        warnings.append(f"the time per picture {text.strip()!r} is not clear: check the rate")
    in_s = re.search(r"\d\s*s", text) is not None
    return 1.0 / (value if in_s else value * 1e-3)


FORMAT = Format(name="emed", title="Novel emed export", suffixes=(".lst",), recognises=_recognises, read=_read)
"""The entry of the registry."""
