"""Tables of any origin (CSV, TSV, text): a row a frame, below lines of unit, rate and names.

OpenSim's .mot and .sto, Cortex' .forces and loadsol's text without zones count, too. A column is what its name or
`ReadOptions.columns` states; one without either is left out.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path

from plantar.common.sides import SIDES
from plantar.errors import FormatError
from plantar.formats.column_map import column_map, mapped_columns
from plantar.formats.field_names import heading_of
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import is_side_column, names_a_foot, number_of_side, side_of
from plantar.formats.table_columns import recording_of_columns
from plantar.formats.table_text import (
    CountedSeconds,
    TableHead,
    head_of_table,
    seconds_of_time,
    time_columns,
    with_columns,
    without_quotes,
)
from plantar.formats.text import head_text, number, open_text, table_of_lines
from plantar.recordings.pressure_recording import PressureRecording

_MOST_COLUMNS = 100_000
_HEAD = 200
_POINT = re.compile(r"(?<!\d)0\.|\.(?!\d{3}(?!\d))|\d{4}\.|\.\d+[eE]")  # that is no mark between thousands
_QUOTED_COMMA = re.compile(r'"[^",]*,[^"]*"')
_FEWEST = 3  # Numbers of a row from which lines are a table by themselves; fewer need names, or so many rows
_ROWS = 20


def _number_or_nan(cell: str) -> str:
    return "nan" if number(cell) is None else cell


def _recognises(head: bytes) -> bool:
    lines = [x for x in head_text(head).splitlines() if x.strip()]
    found = head_of_table(lines[:-1] if len(lines) > 3 else lines)
    if found is None or not (found.width >= _FEWEST or found.names or len(lines) - found.first >= _ROWS):
        return False
    above = sum(not x.startswith("#") for x in lines[: found.first])
    if above > 1:  # below other text a table needs names of loads: numbers alone may be of any maker's format
        headings = [heading_of(n) for n in found.names]
        loads = any(
            h.quantity not in ("number", "unknown", "foreign") or (h.side and (h.number or h.unit)) for h in headings
        )
        return loads or {h.side for h in headings if h.quantity == "number"} >= set(SIDES)
    return True


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    with open_text(path) as stream:
        lines = list(islice((x.rstrip("\n") for x in stream if x.strip()), _HEAD))
        head = _checked_head(lines)
        stated = mapped_columns(column_map(options.columns), head.names, head.width)
        names = [stated.get(i, "") for i in range(head.width)] if stated else list(head.names)
        first = lines[head.first :]
        names, changes = _changed_columns(names, first, head, list(stated))
        more = (x.rstrip("\n") for x in stream if x.strip())
        rows: Iterator[str] = (x for x in chain(first, more) if not x.startswith("#"))
        rows = _plain_numbers(rows, first, head.delimiter)
        if changes:
            rows = with_columns(rows, head.delimiter, changes)
        table = table_of_lines(path, rows, head.delimiter, head.width, warnings, list(stated))
    names = [names[i] for i in stated] if stated else names
    return recording_of_columns(table, names, options, path, dict(head.facts), warnings)


def _checked_head(lines: list[str]) -> TableHead:
    """Head of a table; FormatError without rows, with too many columns, or with commas of two meanings."""
    head = head_of_table(lines)
    if head is None:
        raise FormatError("the table has no rows of numbers")
    if head.width > _MOST_COLUMNS:
        raise FormatError(f"a table of {head.width} columns cannot be read; allowed: up to {_MOST_COLUMNS}")
    nameless = head.delimiter == "," and not head.names
    if nameless and head.first and 2 * lines[head.first - 1].count(",") + 2 == head.width:
        raise FormatError("rows have twice as many cells as names: a comma cannot be decimal sign and delimiter, too")
    if nameless and head.width == 2 and not any("." in x for x in lines[head.first :]):
        raise FormatError(
            "two whole numbers a row are two columns, or one with a decimal comma; allowed: a row of names, or "
            "decimal points"
        )
    return head


def _plain_numbers(rows: Iterator[str], first: Sequence[str], delimiter: str | None) -> Iterator[str]:
    """Rows without quotes about decimal commas, and without points between thousands, where the first ones show it."""
    if delimiter == "," and any(map(_QUOTED_COMMA.search, first)):
        return map(without_quotes, rows)
    if delimiter != "," and any("," in x for x in first) and not any(map(_POINT.search, first)):
        return (x.replace(".", "") for x in rows)
    return rows


def _changed_columns(
    names: list[str], first: Sequence[str], head: TableHead, tried: list[int]
) -> tuple[list[str], dict[int, Callable[[str], str]]]:
    """Columns whose cells are no plain numbers (labels, times of day, feet by name), and names with that of a clock."""
    cells = [line.split(head.delimiter) for line in first]
    changes: dict[int, Callable[[str], str]] = dict.fromkeys(head.labels, _number_or_nan)
    clock = _clock(names, cells, tried or list(range(len(names) or 1)))
    if clock is not None:
        changes[clock] = CountedSeconds()
        names = [f"time {side_of(n) or ''} [s]" if i == clock else n for i, n in enumerate(names)]
    for i in range(head.width):
        own = [row[i] for row in cells if i < len(row)]
        if (names and is_side_column(names[i])) or (own and all(map(names_a_foot, own))):
            changes[i] = number_of_side
    return names, changes


def _clock(names: list[str], rows: list[list[str]], tried: list[int]) -> int | None:
    """Column of times of day or dates: the one that is called time, else the first that holds them."""
    named = time_columns(names)[:1] or tried
    return next((i for i in named if any(seconds_of_time(row[i]) is not None for row in rows if i < len(row))), None)


FORMAT = Format(
    name="csv",
    title="table of any origin: cells, force plates, OpenSim .mot, Cortex .forces, loadsol",
    suffixes=(".csv", ".tsv", ".txt", ".mot", ".sto", ".forces"),
    recognises=_recognises,
    read=_read,
    order=99,
)
