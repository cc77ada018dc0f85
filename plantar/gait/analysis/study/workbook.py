"""A study's tables as one Excel workbook, with a sheet of definitions, by XlsxWriter (optional)."""

import math
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from plantar.common.atomic import replacing
from plantar.common.optional_library import optional_library
from plantar.errors import InputError
from plantar.gait.analysis.study.definitions import definition_rows

MOST_ROWS = 1_000_000
"""Rows of a sheet, of which Excel reads 1,048,576; more go on in a sheet of their own."""

_LONGEST_NAME = 31  # characters of a sheet's name, Excel's limit
_LONGEST_TEXT = 32_767  # characters of a cell, Excel's limit

_WIDEST = 40  # characters


def write_workbook(path: Path, tables: Mapping[str, tuple[Sequence[str], Sequence[Mapping[str, Any]]]]) -> Path:
    """Write tables (columns, rows) by sheet name, and a first sheet of what their columns mean.

    Texts are written as texts: none becomes a formula. DependencyError without XlsxWriter.
    """
    with optional_library("xlsxwriter", "study"):
        import xlsxwriter
    columns = [name for names, _ in tables.values() for name in names]
    measures = {str(row["measure"]) for _, rows in tables.values() for row in rows if "measure" in row}
    sheets: dict[str, tuple[Sequence[str], Sequence[Sequence[Any]]]] = {
        "definitions": (("column", "meaning", "unit"), definition_rows([*columns, *sorted(measures)]))
    }
    for name, (names, rows) in tables.items():
        for part, begin in enumerate(range(0, max(1, len(rows)), MOST_ROWS), 1):
            values = [[row.get(column) for column in names] for row in rows[begin : begin + MOST_ROWS]]
            end = "" if part == 1 else f" {part}"
            sheets[name[: _LONGEST_NAME - len(end)] + end] = (names, values)
    options = {"constant_memory": True, "strings_to_formulas": False}
    # Closed in any case, since it keeps rows in files of its own until then.
    with replacing(path) as temporary, closing(xlsxwriter.Workbook(str(temporary), options)) as book:
        bold = book.add_format({"bold": True})
        for name, (names, cells) in sheets.items():
            sheet = book.add_worksheet(name)
            sheet.freeze_panes(1, 0)
            for column, title in enumerate(names):
                sheet.set_column(column, column, min(_WIDEST, max(10, len(title) + 2)))
                sheet.write_string(0, column, title, bold)
            for line, of_line in enumerate(cells, 1):
                for column, value in enumerate(of_line):
                    _write(sheet, line, column, value)
    return path


def _write(sheet: Any, line: int, column: int, value: Any) -> None:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return
    if isinstance(value, bool | int | float):
        sheet.write_number(line, column, float(value))
    else:
        text = str(value)
        if len(text) > _LONGEST_TEXT:
            raise InputError(f"a text of {len(text)} characters; a workbook's cell holds {_LONGEST_TEXT}; allowed: CSV")
        sheet.write_string(line, column, text)
