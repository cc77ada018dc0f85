"""Small text tables (CSV, TSV) in any encoding, limited in size."""

import csv
import io
import os
import re
from itertools import chain
from typing import NamedTuple

from plantar.common.files.input_file import read_input
from plantar.errors import PlantarError

TABLE_MOST = 20_000_000
"""Largest table in bytes."""

_MOST_ROWS = 200_000
_MOST_COLUMNS = 2000
_SEEN = 1024  # bytes in which the zeros of UTF-16 are looked for


class TextTable(NamedTuple):
    """Table with a row of names.

    `names` in lower case, without surrounding spaces; `rows`: line number and cells of each non-empty row; any count of
    cells.
    """

    names: list[str]
    rows: list[tuple[int, list[str]]]

    def column(self, *known: str) -> int | None:
        """Index of the column with the first existing name, or None."""
        return next((self.names.index(name) for name in known if name in self.names), None)


def read_text_table(path: str | os.PathLike[str], error: type[PlantarError]) -> TextTable:
    """Returns the table at `path`: tabs, semicolons or commas between cells, names first.

    Up to TABLE_MOST bytes of UTF-8, UTF-16 or Latin-1; raises `error` if unreadable, no text, or too large.

    Example:
        >>> read_text_table("none.csv", PlantarError)
        Traceback (most recent call last):
        plantar.errors.PlantarError: none.csv: cannot be read (No such file or directory)
    """
    data = read_input(path, error, TABLE_MOST)
    text = data.decode(encoding_of(data), errors="replace").lstrip("\ufeff")
    if "\0" in text:
        raise error(f"{path}: not a table of text (it holds zero bytes)")
    head = text.partition("\n")[0]
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=max("\t;,", key=head.count), strict=True)
    names: list[str] = []
    rows: list[tuple[int, list[str]]] = []
    try:
        names = [name.strip().lower() for name in next(reader, [])]
        for cells in chain([names], reader):
            if len(rows) > _MOST_ROWS or len(cells) > _MOST_COLUMNS:
                raise error(f"{path}: allowed: up to {_MOST_ROWS} rows and {_MOST_COLUMNS} columns")
            if any(cell.strip() for cell in cells):
                rows.append((reader.line_num, cells))
    except csv.Error as problem:
        raise error(f"{path}, line {reader.line_num}: not a table that can be read ({problem})") from None
    return TextTable(names, rows[1:])


def encoding_of(head: bytes) -> str:
    """Encoding of a text by its first bytes: UTF-16 and UTF-8 if marked or seen, else Latin-1.

    Example:
        >>> encoding_of("N/cm²".encode()), encoding_of("N/cm²".encode("latin-1"))
        ('utf-8', 'latin-1')
    """
    for mark, encoding in ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig")):
        if head.startswith(mark):
            return encoding
    for first, encoding in ((0, "utf-16-be"), (1, "utf-16-le")):  # without a mark: every other byte of it is 0
        zeros = head[first:_SEEN:2].count(0)
        others = head[1 - first : _SEEN : 2].count(0)
        if len(head) > 64 and zeros > 0.45 * min(len(head), _SEEN) and others == 0:
            return encoding
    try:
        head[: -4 if len(head) > 4096 else None].decode("utf-8")
    except UnicodeDecodeError:
        good = len(re.findall(rb"[\xc2-\xdf][\x80-\xbf]|[\xe0-\xef][\x80-\xbf]{2}", head))
        return "utf-8" if good else "latin-1"  # one damaged byte does not make another encoding
    return "utf-8"
