"""Binary Excel workbooks (.xls), as footscan exports: the fullest sheet as text.

xlrd reads them in a separate process: damage can make it recurse or fill memory without end.
"""

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.input_file import check_input
from plantar.errors import FormatError
from plantar.formats.format import Format, ReadOptions
from plantar.recordings.pressure_recording import PressureRecording

_MAGIC = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_LARGEST = 100_000_000
_LONGEST_CELL = 16_384


def text_of_workbook(path: Path) -> dict[str, NDArray[Any]]:
    """Fullest sheet of a workbook as "text", UTF-8 bytes: a line for each row with cells, tabs between cells.

    A formula is its stored result; truth values and errors are empty cells.
    """
    import xlrd  # 0.03 s

    with (
        open(os.devnull, "w") as notes,
        xlrd.open_workbook(path, logfile=notes, on_demand=True, ragged_rows=True) as book,
    ):
        sheets = (list(_rows(book.sheet_by_index(i))) for i in range(book.nsheets))
        fullest = max(sheets, key=lambda rows: sum(sum(map(bool, row)) for row in rows), default=[])
    text = "".join("\t".join(row) + "\n" for row in fullest)
    return {"text": np.frombuffer(text.encode(), np.uint8)}


def _rows(sheet: Any) -> Iterator[list[str]]:
    for r in range(sheet.nrows):
        row = [_text(*cell) for cell in zip(sheet.row_types(r), sheet.row_values(r), strict=True)]
        if any(row):
            yield row


def _text(kind: int, value: Any) -> str:
    from xlrd import XL_CELL_DATE, XL_CELL_NUMBER, XL_CELL_TEXT

    if kind == XL_CELL_TEXT:
        return " ".join(value.split())[:_LONGEST_CELL]
    return f"{value:.12g}" if kind in (XL_CELL_NUMBER, XL_CELL_DATE) else ""


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    from plantar.formats import detect_format

    check_input(path, FormatError, _LARGEST)
    content = read_apart("xls", path, FormatError)["text"].tobytes()
    if not content:
        raise FormatError(f"{path}: the workbook holds no cells")
    with TemporaryDirectory(prefix="plantar-") as folder:
        text = Path(folder) / f"{path.stem}.txt"
        text.write_bytes(content)
        try:
            found = detect_format(text)
            if found.read is None:
                raise FormatError("the workbook holds no recording")
            return replace(found.read(text, options), path=path)
        except FormatError as error:  # of a file that the user does not have
            raise FormatError(str(error).removeprefix(f"{text}: ")) from None


FORMAT = Format(
    name="xls",
    title="binary Excel workbook of a text export, such as footscan's",
    suffixes=(".xls",),
    recognises=lambda head: head.startswith(_MAGIC),
    read=_read,
    order=30,
)
