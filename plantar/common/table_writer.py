"""CSV tables without formulas for spreadsheets."""

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any, TextIO

_FORMULA = ("=", "+", "-", "@", "\t", "\n")
_GUARD = "'"


def csv_text(names: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table as CSV.

    Text that a spreadsheet would run (=, +, -, @, tab, line end) follows an apostrophe. None, NaN and infinities are
    empty.

    Example:
        >>> csv_text(["file", "N"], [["=1+1.csv", -0.5], ["-2e3", None]])
        "file,N\\n'=1+1.csv,-0.5\\n-2e3,\\n"
    """
    out = io.StringIO()
    write_csv_rows(out, [names, *rows])
    return out.getvalue()


def write_csv_rows(stream: TextIO, rows: Iterable[Sequence[Any]]) -> None:
    """Write a table's rows, as `csv_text`. `stream`: where to; opened with newline="".

    Example:
        >>> import sys
        >>> write_csv_rows(sys.stdout, [["time_s", "name"], [0.1, "=1+1"]])
        time_s,name
        0.1,'=1+1
    """
    # Finite numbers, nearly all cells of long tables, pass without a call; NaN and infinity minus themselves are NaN.
    csv.writer(stream, lineterminator="\n").writerows(
        [v if type(v) is float and v - v == 0.0 else _cell(v) for v in row] for row in rows
    )


def csv_row(cells: Sequence[Any]) -> str:
    """One row as `csv_text` writes it. Returns row with its line end.

    Example:
        >>> csv_row([1, None, "a,b"])
        '1,,"a,b"\\n'
    """
    out = io.StringIO()
    write_csv_rows(out, [cells])
    return out.getvalue()


def mapping_rows(names: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> Iterable[list[Any]]:
    """Cells of rows that are mappings.

    `rows`: cells of each row by name. Returns cells of each row in order of names; None if absent.

    Example:
        >>> list(mapping_rows(["a", "b"], [{"b": 2}]))
        [[None, 2]]
    """
    ordered = list(names)
    # Rows that have their cells in this order already are nearly all of a long table.
    return (list(row.values()) if list(row) == ordered else [row.get(name) for name in ordered] for row in rows)


def original_cell(text: str) -> str:
    """Cell without its added apostrophe.

    Example:
        >>> original_cell("'=1"), original_cell("'quoted'")
        ('=1', "'quoted'")
    """
    return text[1:] if text.startswith(_GUARD) and text[1:].startswith((*_FORMULA, _GUARD)) else text


def _cell(value: Any) -> Any:
    if isinstance(value, str):
        return _text(value)
    return "" if value is None or (isinstance(value, float) and not math.isfinite(value)) else value


# A long table has the same few texts, as of a side, in each row.
@lru_cache(maxsize=256)
def _text(value: str) -> str:
    value = value.replace("\r\n", "\n").replace("\r", "\n")
    guarded = value.startswith(_FORMULA) and not _is_number(value)
    return _GUARD + value if guarded or (value.startswith(_GUARD) and original_cell(value) != value) else value


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text
