"""Tables of any origin (CSV, TSV): a column of times, a column a cell, a row of names that may state sides and units.

Names such as "time [ms]", "left 12 [kPa]", "R_3", "force_7" are understood: a name's last number is the cell's id.
Lines that start with "#" may state "unit: kPa", "rate: 100" or "side: left".
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.cells_of_foot import cells_of_foot, halves, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.number_rows import number_rows
from plantar.formats.side import side_of
from plantar.formats.side_column import is_side_column, on_one_time, rows_of_sides, with_numbers
from plantar.formats.text import blocks_of_lines, head_text, number, number_in, open_text, row_of_numbers
from plantar.formats.units import find_unit
from plantar.formats.written_cells import (
    has_quoted_commas,
    names_of_row,
    seconds_of_time,
    time_unit,
    with_seconds,
    without_quotes,
)
from plantar.recordings.frame_table import FrameTable
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, possible_rate, sampling
from plantar.sides import SIDES, Side

__all__ = ["FORMAT", "recording_of_columns"]

_USUAL_RATE = 100.0
_BLOCK, _BLOCK_VALUES = 2048, 4_000_000
_FIRST = 32
_MOST_COLUMNS, _MOST_COMMENTS, _LONGEST_NAME = 100_000, 1000, 200
_MOST_NAMED = 10
"""Columns that are left out by name in the warnings; of more their number is given."""


def _recognises(head: bytes) -> bool:
    """Printable lines of which the last whole ones are rows of three numbers or more."""
    text = head_text(head)
    if text is None:
        return False
    lines = [x for x in text.splitlines() if x.strip() and not x.startswith("#")]
    lines = lines[1:-1] if len(lines) > 3 else lines[1:]
    if not lines:
        return False
    delimiter = _delimiter(lines)
    plain = without_quotes(iter(lines[:50])) if delimiter == "," else lines[:50]
    rows = [x.split(delimiter) for x in plain]
    good = [len(r) >= 3 and sum(_is_cell(c) for c in r) >= 0.9 * len(r) for r in rows]
    return sum(good) >= 0.9 * len(good)


def _is_cell(text: str) -> bool:
    """Whether a cell of a table holds a number, nothing, the name of a foot, or a time of day."""
    if number(text) is not None or not text.strip() or seconds_of_time(text[:40]) is not None:
        return True
    return len(text) < 12 and side_of(text.strip(' "')) is not None


def _delimiter(lines: list[str]) -> str | None:
    """The sign between cells: the one that all lines share most often; None for blanks."""
    best = max("\t;,", key=lambda d: (min(x.count(d) for x in lines[:50]) > 0, d != ","))
    return best if min(x.count(best) for x in lines[:50]) > 0 else None


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    """Read a table.

    Raises:
        FormatError: If it holds no rows of numbers, or a unit that is not known.
    """
    warnings: list[str] = []
    with open_text(path) as stream:
        comments: list[str] = []
        head = list(islice(_content(stream, comments), 60))
        if len(head) < 2:
            raise FormatError(f"{path}: the table has no rows")
        delimiter = _delimiter(head[1:])
        first = [c[:_LONGEST_NAME] for c in names_of_row(head[0], delimiter)]
        named = any(c and number(c) is None and seconds_of_time(c) is None for c in first) or all(
            c.isdigit() for c in first
        )
        lines: Iterator[str] = chain(head[1:] if named else head, _content(stream, comments))
        if delimiter == "," and any(map(has_quoted_commas, head[1:])):
            lines = without_quotes(lines)
        clock = next((i for i, n in enumerate(first) if not named or time_unit(n) is not None), None)
        if clock is not None and any(seconds_of_time(c) is not None for c in _column(head[1:], delimiter, clock)):
            lines = with_seconds(lines, delimiter, clock)
            first[clock] = "time [s]" if named else first[clock]
        of_side = next((i for i, n in enumerate(first) if named and is_side_column(n)), None)
        if of_side is not None:
            lines = with_numbers(lines, delimiter, of_side)
        table = _table(path, lines, delimiter, len(first), warnings)
    return recording_of_columns(table, first if named else [], options, path, _facts(comments), warnings)


def recording_of_columns(
    table: NDArray[np.float64],
    names: list[str],
    options: ReadOptions,
    path: Path,
    facts: dict[str, str] | None = None,
    warnings: list[str] | None = None,
) -> PressureRecording:
    """A recording from a table of numbers and the names of its columns.

    Args:
        table: Numbers (n, k), NaN where one is missing.
        names: Names (k) of the columns; empty where there are none.
        options: What is known of the table.
        path: What the recording is called.
        facts: What comments state: "unit", "rate", "side".
        warnings: Where assumptions are put.

    Returns:
        The recording.

    Raises:
        FormatError: If no column is a cell or a force, or a unit is not known.
    """
    facts, warnings = {} if facts is None else facts, [] if warnings is None else warnings
    if not names:
        warnings.append("the table has no row of names: the first column is taken as time in s if it increases")
    at = next((i for i, n in enumerate(names) if time_unit(n) is not None), None)
    if at is None and (not names or not names[0]):
        column = table[:, 0]
        at = 0 if np.isfinite(column).all() and (np.diff(column) > 0.0).all() else None
    of_side = next((i for i, n in enumerate(names) if is_side_column(n)), None)
    if of_side is not None:
        table, names = _side_by_side(table, names, at, of_side, warnings)
        at = None if at is None else 0
    time, rate, notes = _times(table, names, at, facts, options, warnings)
    cells = [i for i in range(table.shape[1]) if i != at]
    feet = _feet(table, names, cells, facts, options, warnings)
    if len(feet) == 1 and side_of(*names) is not None:
        warnings.append(f"the file holds the {next(iter(feet))} foot only")
    raw = bool(facts.pop("_raw", ""))
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata=facts,
        warnings=(*warnings, *notes),
        raw=raw,
    )


def _column(lines: list[str], delimiter: str | None, column: int) -> Iterator[str]:
    """The cells of a column, of lines that have one."""
    return (cells[column] for cells in (line.split(delimiter) for line in lines) if column < len(cells))


def _side_by_side(
    table: NDArray[np.float64], names: list[str], at: int | None, of_side: int, warnings: list[str]
) -> tuple[NDArray[np.float64], list[str]]:
    """A table of both feet in columns, from one whose rows are of either foot; the times come first."""
    rows = rows_of_sides(table[:, of_side], warnings)
    cells = [i for i in range(table.shape[1]) if i not in (at, of_side)]
    time = np.arange(len(table), dtype=float) if at is None else table[:, at]
    if at is None:
        for own in rows.values():
            time[own] = np.arange(len(own))
    time, feet, moved = on_one_time(time, rows, [table[:, i] for i in cells])
    if moved:
        warnings.append("the feet's rows have other times: the right foot's values are interpolated at the left one's")
    head = [] if at is None else [names[at]]
    found = [*head, *(f"{side} {names[i]}" for side in feet for i in cells)]
    return np.column_stack([*([] if at is None else [time]), *feet.values()]), found


def _facts(comments: list[str]) -> dict[str, str]:
    out: dict[str, str] = {}
    for line in comments:
        name, sign, value = re.sub(r"[:=]", "\n", line.lstrip("#"), count=1).partition("\n")
        if sign and re.fullmatch(r"[A-Za-z_ ]+", name):
            out[name.strip().lower()] = value.strip()
    return out


def _content(stream: TextIO, comments: list[str]) -> Iterator[str]:
    """The lines that hold something; those that begin with "#" are put aside."""
    for line in stream:
        if line.startswith("#"):
            if len(comments) < _MOST_COMMENTS:
                comments.append(line[:_LONGEST_NAME])
        elif line.strip():
            yield line.rstrip("\n")


def _table(
    path: Path, lines: Iterator[str], delimiter: str | None, width: int, warnings: list[str]
) -> NDArray[np.float64]:
    """The numbers (rows, width), NaN where a cell is empty or none; read block by block to have them there once."""
    if width > _MOST_COLUMNS:
        raise FormatError(f"{path}: a table of {width} columns cannot be read; allowed: up to {_MOST_COLUMNS}")
    table = FrameTable(width, 0)
    bad = short = 0
    last = ""
    for block in blocks_of_lines(lines, max(1, min(_BLOCK, _BLOCK_VALUES // width))):
        if not len(table):
            usual = sum(map(len, block)) // len(block)  # rows may be shorter; what is not written takes no memory
            table = FrameTable(width, len(block) + path.stat().st_size // max(usual * 3 // 5, 2 * width))
        rows, wrong, odd = _rows(block, delimiter, width)
        table.add(rows)
        bad, short, last = bad + wrong, short + odd, block[-1]
        if len(table) > _FIRST and max(short, bad / width) > 0.5 * len(table):  # no use in reading on
            break
    if len(last.split(delimiter)) < width and len(table) > 1:
        table.drop_last()
        short -= 1
        warnings.append("the last row is cut short: left out")
    out = table.rows
    if short > 0.2 * len(out) or bad > 0.2 * out.size:
        raise FormatError(f"{path}: not a table of numbers: {short} rows of another width, {bad} cells of text")
    if short:
        warnings.append(f"{short} damaged row(s) count as not measured")
    if bad:
        warnings.append(f"{bad} value(s) are no numbers: they count as not measured")
    return out


def _rows(block: list[str], delimiter: str | None, width: int) -> tuple[NDArray[np.float64], int, int]:
    """Numbers of some lines, how many cells are none, and how many lines have another width."""
    rows = number_rows(block, delimiter, width)
    if rows is not None:
        return rows, 0, 0
    out = np.full((len(block), width), np.nan)
    bad = short = 0
    for i, line in enumerate(block):
        cells = line.split(delimiter)
        while len(cells) > width and not cells[-1].strip():
            cells.pop()
        if len(cells) != width:
            short += 1
            continue
        out[i], wrong = row_of_numbers(cells)
        bad += wrong
    return out, bad, short


def _taken(table: NDArray[np.float64], columns: list[int]) -> NDArray[np.float64]:
    """Some columns of a table, without a copy where they lie together."""
    if columns == list(range(columns[0], columns[0] + len(columns))):
        return table[:, columns[0] : columns[0] + len(columns)]
    return table[:, columns]


def _times(
    table: NDArray[np.float64],
    names: list[str],
    at: int | None,
    facts: dict[str, str],
    options: ReadOptions,
    warnings: list[str],
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    stated = options.rate_hz
    words = next((v for k, v in facts.items() if "rate" in k or "frequency" in k), None)
    if stated is None and words is not None:
        stated = number_in(words)
        if stated is None:
            raise FormatError(f"a rate of {words[:40]!r} is no number (--rate overrides)")
    if at is None or options.rate_hz is not None:
        if stated is None:
            warnings.append(
                f"the table has no times and states no rate: {_USUAL_RATE:g} Hz is assumed (--rate overrides)"
            )
        rate = _USUAL_RATE if stated is None else possible_rate(stated, "the table states")
        return np.arange(len(table)) / rate, rate, ()
    factor = (time_unit(names[at]) if names else None) or None
    if factor is None:
        factor = 1.0
        step = np.nanmedian(np.diff(table[:, at])) if len(table) > 1 else 0.0
        if step >= 1.0:  # a frame a second is no gait; whole numbers are milliseconds
            factor = 1e-3 if step < 1e3 else 1e-6 if step < 1e6 else 1e-9
        warnings.append(f"the times state no unit: {'s' if factor == 1.0 else f'{factor:g} s'} is assumed")
    time = table[:, at] * factor
    known = time[np.isfinite(time)]
    if len(known) and abs(known[0]) > 1e5:
        warnings.append(f"the times begin at {known[0]:.10g} s: here they count from the first frame")
        time = time - known[0]
    return sampling(time, stated)


def _name_and_unit(text: str) -> tuple[str, str | None]:
    """The name of a column without its unit, and that unit, as in "left 12 [kPa]" or "R_3_N"."""
    unit = re.search(r"[\[(]\s*([^\])]+?)\s*[\])]\s*$", text) or re.search(r"_(kPa|N|Pa|mmHg|psi|raw)$", text)
    return (text, None) if unit is None else (text[: unit.start()], unit[1])


def _feet(
    table: NDArray[np.float64],
    names: list[str],
    cells: list[int],
    facts: dict[str, str],
    options: ReadOptions,
    warnings: list[str],
) -> dict[Side, FootRecording]:
    stated = facts.get("unit", facts.get("units"))
    columns: dict[Side | None, list[tuple[int, int | None]]] = {}
    found: list[str] = []
    parts = [_name_and_unit(names[i] if names else "") for i in cells]
    left_out: list[str] = []
    measured = any(find_unit(u) is not None for _, u in parts if u)  # then what is in degrees or g0 is no load
    for i, (name, unit_of_column) in zip(cells, parts, strict=True):
        last = re.findall(r"\d+", name)
        foreign = measured and unit_of_column is not None and find_unit(unit_of_column) is None
        if names and (foreign or not last):
            if name.strip():
                left_out.append(names[i])
            continue
        if unit_of_column:
            found.append(unit_of_column)
        columns.setdefault(side_of(re.sub(r"\d+", " ", name)), []).append((i, int(last[-1][-18:]) if last else None))
    if len(left_out) > _MOST_NAMED:
        warnings.append(f"{len(left_out)} columns are no cells: left out, {left_out[0]!r} to {left_out[-1]!r}")
    else:
        warnings += [f"column {name!r} is no cell: left out" for name in left_out]
    unit_text = stated or (max(set(found), key=found.count) if found else None)
    if len({find_unit(u) for u in found}) > 1:
        raise FormatError(f"the columns are in different units: {', '.join(sorted(set(found)))}")
    unit = unit_of_values(unit_text, options, warnings, "the table")
    facts["_raw"] = "raw" if unit.kind == "raw" else ""
    if not columns:
        raise FormatError("no column of the table is a cell")
    feet: dict[Side, FootRecording] = {}
    if None in columns and len(columns) == 1:
        own = options.side or side_of(facts.get("side", ""), facts.get("foot", ""))
        indices = [i for i, _ in columns[None]]
        ids = [c for _, c in columns[None] if c is not None]
        split: list[tuple[Side, NDArray[np.float64]]] = (
            [(own, _taken(table, indices))] if own else halves(_taken(table, indices), options, warnings)
        )
        for side, values in split:
            ordered = ids if len(ids) == values.shape[1] else None
            feet[side] = cells_of_foot(side, values, unit, options, warnings, ordered)
        return feet
    if None in columns:
        warnings.append(f"{len(columns[None])} column(s) name no foot: left out")
    for side in SIDES:
        if side in columns:
            ids = [c for _, c in columns[side] if c is not None]
            values = _taken(table, [i for i, _ in columns[side]])
            feet[side] = cells_of_foot(
                side, values, unit, options, warnings, ids if len(ids) == values.shape[1] else None
            )
    return feet


FORMAT = Format(
    name="csv",
    title="table of any origin, with --layout and --unit",
    suffixes=(".csv", ".tsv", ".txt"),
    recognises=_recognises,
    read=_read,
    order=99,
)
"""The entry of the registry."""
