"""Head of a table: where its numbers begin, its columns' names, and the facts in the lines above."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from plantar.formats.column_names import heading_of
from plantar.formats.side import side_of
from plantar.formats.text import number
from plantar.formats.units import FORCES, LENGTHS, MOMENTS, PASCALS, plain
from plantar.formats.written_cells import names_of_row, seconds_of_time, time_unit, without_quotes

__all__ = ["TableHead", "head_of_table"]

_ROWS = 10
"""Rows of numbers in a row from which a table begins, where there are so many."""
_LONGEST_NAME = 200
_UNITS = {
    *FORCES,
    *PASCALS,
    *LENGTHS,
    *MOMENTS,
    "s",
    "sec",
    "secs",
    "ms",
    "hz",
    "-",
    "",
    "%",
    "%bw",
    "bw",
    "raw",
    "v",
    "deg",
}


@dataclass(frozen=True)
class TableHead:
    """The beginning of a table.

    Attributes:
        names: Names of the columns; empty where there are none.
        delimiter: The sign between cells; None for blanks.
        width: Cells of a row.
        first: Number of the line of the first row.
        facts: Facts in lines above the table, by lower-case name.
    """

    names: list[str]
    delimiter: str | None
    width: int
    first: int
    facts: dict[str, str]


def head_of_table(lines: Sequence[str]) -> TableHead | None:
    """The beginning of a table of numbers, from the first lines that are not blank; None where no rows of numbers
    begin.
    """
    for first in range(len(lines)):
        if lines[first].startswith("#"):
            continue
        rows = [x for x in lines[first : first + 2 * _ROWS] if not x.startswith("#")][:_ROWS]
        delimiter = _delimiter(rows)
        width = _width(rows, delimiter)
        if width == 1 and first and _numbers(rows[0], "\t"):
            alone = _name_alone(lines[:first])
            if alone is not None:
                return TableHead([alone], "\t", 1, first, _facts(lines[: first - 1], None))
        named = _wider_names(lines[first - 1], rows, width) if first else None
        if named is not None:
            return TableHead(named[0], named[1], len(named[0]), first, _facts(lines[: first - 1], named[1]))
        good = [_is_row(x, delimiter, width) for x in rows]
        after_names = first > 0 and _names_columns(names_of_row(lines[first - 1], delimiter), width)
        if width < 2 or not (good[0] or (after_names and _numbers(rows[0], delimiter))) or sum(good) < 0.8 * len(good):
            continue
        if rows and first == 0 and len(rows) > 1 and all(c.strip().isdigit() for c in rows[0].split(delimiter)):
            numbered = not all(c.strip().isdigit() for c in rows[1].split(delimiter))
            ascending = [int(c) for c in rows[0].split(delimiter)] == list(range(1, width + 1))
            if numbered or ascending:
                return TableHead([c.strip() for c in rows[0].split(delimiter)], delimiter, width, 1, {})
        names, above = _names(lines[:first], delimiter, width)
        return TableHead(names, delimiter, width, first, _facts(lines[:above], delimiter))
    return None


def _name_alone(above: Sequence[str]) -> str | None:
    """The name of a single column of forces, with its unit from a line below where it has one; None of others."""
    texts = [x.strip('"# ') for x in above[-2:]]
    if len(texts) == 2 and plain(texts[1]) in _UNITS:
        texts = [f"{texts[0]} [{texts[1]}]"]
    return texts[-1][:_LONGEST_NAME] if heading_of(texts[-1]).quantity == "force" else None


def _delimiter(lines: Sequence[str]) -> str | None:
    """The sign between cells: the one that all lines share most often; None for blanks."""
    if not lines:
        return None
    best = max("\t;,", key=lambda d: (min(x.count(d) for x in lines) > 0, d != ","))
    return best if min(x.count(best) for x in lines) > 0 else None


def _cells(line: str, delimiter: str | None) -> list[str]:
    line = line.rstrip("\r\n")
    return next(without_quotes(iter([line]))).split(delimiter) if delimiter == "," else line.split(delimiter)


def _width(rows: Sequence[str], delimiter: str | None) -> int:
    """The commonest count of cells, of which empty ones at the end do not count where all rows have them."""
    counts = [len(_cells(x, delimiter)) for x in rows]
    width = max(set(counts), key=counts.count, default=0)
    while width > 1 and all(len(c) >= width and not c[width - 1].strip() for c in (_cells(x, delimiter) for x in rows)):
        width -= 1
    return width


def _is_row(line: str, delimiter: str | None, width: int) -> bool:
    """Whether a line is a row of numbers, of which some may be missing or name a foot."""
    cells = _cells(line, delimiter)
    known = sum(_is_cell(c) for c in cells)
    numbers = sum(number(c) is not None or seconds_of_time(c[:40]) is not None for c in cells)
    return len(cells) >= 0.8 * width and known >= 0.9 * len(cells) and numbers >= max(1, 0.3 * len(cells))


def _numbers(line: str, delimiter: str | None) -> bool:
    return all(_is_cell(c) for c in _cells(line, delimiter))


def _wider_names(above: str, rows: Sequence[str], width: int) -> tuple[list[str], str | None] | None:
    """Names of many more columns than the rows below have, which are damaged; None of others."""
    delimiter = _delimiter([above])
    names = [c[:_LONGEST_NAME] for c in names_of_row(above.lstrip("#"), delimiter)]
    words = sum(bool(re.search(r"[^\W\d_]", c)) for c in names[:1000])
    wide = delimiter is not None and len(names) > max(3, 2 * width) and words >= 0.5 * min(len(names), 1000)
    return (names, delimiter) if wide and all(_numbers(x, delimiter) for x in rows) else None


def _is_cell(text: str) -> bool:
    """Whether a cell of a table holds a number, nothing, the name of a foot, or a time of day."""
    if number(text) is not None or not text.strip() or seconds_of_time(text[:40]) is not None:
        return True
    stripped = text.strip(' "').lower()
    return stripped in ("nan", "na", "n/a", "null", "inf", "-") or (len(text) < 12 and side_of(stripped) is not None)


def _names(above: Sequence[str], delimiter: str | None, width: int) -> tuple[list[str], int]:
    """Names of the columns from the lines above the rows, and the number of other lines among these."""
    at = len(above) - 1
    rows = []
    for line in above[-3:]:
        cells = names_of_row(line.lstrip("#").rstrip("\r\n"), delimiter)
        cells = [c[:_LONGEST_NAME] for c in cells]
        rows.append(cells[:width] if len(cells) > width and not any(cells[width:]) else cells)
    while rows and len(rows[-1]) == width - 1 and rows[-1] and width > 2 and not rows[-1][0]:
        rows[-1] = ["", *rows[-1]]
    if not rows or not _names_columns(rows[-1], width):
        return [], len(above)
    names = rows[-1] + [""] * (width - len(rows[-1]))
    units: list[str] = []
    if len(rows) > 1 and all(plain(c) in _UNITS for c in names) and _names_columns(rows[-2], width):
        units, names, at = names, rows[-2] + [""] * (width - len(rows[-2])), at - 1
        rows.pop()
    if units:
        names = [
            f"{n} [{u}]" if u.strip("-[]() ") and "[" not in n and "(" not in n else n
            for n, u in zip(names, units, strict=True)
        ]
    if len(rows) > 1 and side_of(*names) is None and len(rows[-2]) > 1:
        groups, last = [], ""
        for cell in rows[-2] + [""] * (width - len(rows[-2])):
            last = cell or last
            groups.append(last)
        if len(rows[-2]) <= width and any(side_of(g) or heading_of(g).plate for g in groups):
            names = [f"{g} {n}".strip() if time_unit(n) is None else n for g, n in zip(groups, names, strict=True)]
            at -= 1
    return names, at


def _names_columns(cells: Sequence[str], width: int) -> bool:
    words = sum(bool(re.search(r"[^\W\d_]", c)) for c in cells)
    return 0.6 * width <= len(cells) <= width and words >= max(1, 0.25 * len(cells))


def _facts(lines: Sequence[str], delimiter: str | None) -> dict[str, str]:
    """Facts of lines such as "# unit: kPa", "SampleRate=1200" and "rate<tab>100"."""
    out: dict[str, str] = {}
    for line in lines:
        line = line.lstrip("#").strip()
        signs = "[:=]" if delimiter is None or re.search("[:=]", line) else f"[:={delimiter}]"
        name, sign, value = re.sub(signs, "\n", line, count=1).partition("\n")
        if sign and re.fullmatch(r"[\w \[\]()/%.-]{1,60}", name):
            out.setdefault(name.strip().lower(), value.strip().strip('"').strip(",;\t "))
    return out
