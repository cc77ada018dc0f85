"""Reading text exports of any encoding, line end and decimal sign."""

import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import open_input
from plantar.common.files.text_table import encoding_of
from plantar.errors import FormatError
from plantar.kernels import compiled
from plantar.kernels.formats import decimals
from plantar.recordings.frame_table import FrameTable

_LONGEST_LINE = 1_000_000
_CHUNK = 1 << 17
_BLOCK = 2048
_BLOCK_VALUES = 4_000_000
_FIRST = 32
_ZEROS = 0.01  # Share of zeros that damage may put into a text
_MARKED_AGAIN = re.compile(rb"(?:(\xff\xfe|\xfe\xff|\xef\xbb\xbf)(?=\1))+")  # byte order marks before the last one
_NUMBER = re.compile(r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?")
_THOUSANDS = re.compile(r"[-+]?\d{1,3}(?:(?:[\s'’]\d{3})+(?:[.,]\d*)?|(?:\.\d{3})+,\d*|(?:,\d{3})+\.\d*)")
MISSING = frozenset(["", "nan", "na", "n/a", "#n/a", "null", "none", "inf", "-inf", "-", "--", "---", "*"])
"""What stands for a value that was not measured, in lower case."""


def open_text(path: Path) -> TextIO:
    """Text file at path opened for reading, with uniform line ends; FormatError if unreadable.

    Encoding is found from its beginning; a line over 1 MB is an error when read.
    """
    stream = open_input(path, FormatError)
    head = stream.read(1 << 20)
    encoding = encoding_of(head)
    marks = _MARKED_AGAIN.match(head)
    stream.seek(marks.end() if marks else 0)
    lines = _Lines(stream.detach(), _CHUNK)  # type: ignore[attr-defined]
    text = io.TextIOWrapper(lines, encoding=encoding, errors="replace", newline=None)
    text._CHUNK_SIZE = _CHUNK  # type: ignore[attr-defined]  # of 8 kB, an hour of insoles is 70,000 calls
    return text


class _Lines(io.BufferedReader):
    _without_end = 0

    def read1(self, size: int = -1, /) -> bytes:
        data = super().read1(size)
        end = data.rfind(b"\n")
        end = max(end, data.rfind(b"\r", end + 1))
        self._without_end = len(data) - 1 - end + (self._without_end if end < 0 else 0)
        if self._without_end > _LONGEST_LINE:
            raise FormatError(f"a line is longer than {_LONGEST_LINE / 1e6:g} MB: not a text of lines")
        return data


def blocks_of_lines(lines: Iterator[str], most: int = 2048, characters: int = 16_000_000) -> Iterator[list[str]]:
    """Yields blocks of up to most lines, ending sooner at a number of characters; lines can be taken between."""
    block: list[str] = []
    size = 0
    for line in lines:
        block.append(line)
        size += len(line)
        if len(block) == most or size >= characters:
            yield block
            block = []
            size = 0
    if block:
        yield block


def frames_of_lines(
    lines: Iterator[str], mark: re.Pattern[str], first: re.Match[str] | None, most: int
) -> Iterator[tuple[re.Match[str], list[str]]]:
    """Yields match of `mark` that begins each frame, and its non-empty lines, up to "@@".

    Lines follow the first match (None for no frames); a frame over most lines ends them.
    """
    while first is not None:
        begin = first
        body = list[str]()
        first = None
        for line in lines:
            first = mark.match(line)
            if first or line.lstrip().startswith("@@"):
                break
            if line.strip(" ,;\t\n"):
                body.append(line.strip("\n"))
                if len(body) > most:
                    return
        yield begin, body


def head_text(head: bytes) -> str:
    r"""The beginning of a text, with uniform line ends; empty if it is no text.

    Example:
        >>> head_text("Units:;N/cm²\r\n1;2\r\n".encode("utf-16")), head_text(bytes(range(20)) * 9)
        ('Units:;N/cm²\n1;2\n', '')
    """
    text = head.decode(encoding_of(head), errors="replace")
    if text.count("\0") > _ZEROS * len(text):
        return ""
    return text.replace("\0", "").lstrip("\ufeff").replace("\r\n", "\n").replace("\r", "\n")


def cells_of_row(line: str, delimiter: str | None) -> list[str]:
    """Gives cells of a line between its delimiter (None: blanks), without empty end cells."""
    cells = line.split(delimiter)
    while cells and not cells[-1].strip():
        cells.pop()
    return cells


def number(text: str) -> float | None:
    """Number with decimal point or comma; None if none or not finite.

    Example:
        >>> number(" 1,5 "), number("1.5e3"), number("1.2.3"), number("nan"), number("1.234,5")
        (1.5, 1500.0, None, None, 1234.5)
    """
    cleaned = ungrouped(text.strip().strip("\"'").replace("−", "-"))
    if not _NUMBER.fullmatch(cleaned):
        return None
    return value if np.isfinite(value := float(cleaned.replace(",", "."))) else None


def ungrouped(text: str) -> str:
    """A number's text without marks between thousands."""
    return re.sub(r"[\s'’]|[.,](?=.*[.,])", "", text) if _THOUSANDS.fullmatch(text) else text


def number_in(text: str) -> float | None:
    """First number in a text, or None."""
    return number(match[0]) if (match := _NUMBER.search(text)) else None


def table_of_lines(
    path: Path,
    lines: Iterator[str],
    delimiter: str | None,
    width: int,
    warnings: list[str],
    columns: Sequence[int] = (),
) -> NDArray[np.float64]:
    """Returns numbers (n, k) of a file's lines at path, NaN for empty cells or none.

    Warnings get repairs. FormatError without lines, or if too many are damaged.

    `path`: its size decides the room made; `delimiter`: sign between cells; None for blanks; `width`: cells of a line,
    without empty ones at its end; `columns`: cells (k,) to read; all if empty.
    """
    wanted = list(columns) or list(range(width))
    table = FrameTable(len(wanted), 0)
    bad = 0
    short = 0
    last = ""
    for block in blocks_of_lines(lines, max(1, min(_BLOCK, _BLOCK_VALUES // width))):
        if not len(table):
            usual = sum(map(len, block)) // len(block)  # rows may be shorter; what is not written takes no memory
            expected = len(block) + path.stat().st_size // max(usual * 3 // 5, 2 * width)
            table = FrameTable(len(wanted), expected)
        rows, wrong, odd = _rows(block, delimiter, width, wanted)
        table.add(rows)
        bad = bad + wrong
        short = short + odd
        last = block[-1]
        if len(table) > _FIRST and max(short, bad / len(wanted)) > 0.5 * len(table):  # no use in reading on
            break
    if not len(table):
        raise FormatError("the file holds no row of data")
    if len(last.split(delimiter)) < width and len(table) > 1:
        table.drop_last()
        short -= 1
        warnings.append("the last row is cut short: left out")
    if short > 0.2 * len(table) or bad > 0.2 * len(table) * len(wanted):
        raise FormatError(
            f"not a table of numbers: {short} of {len(table)} rows of another width than {width} columns, "
            f"{bad} cells of text"
        )
    if short:
        warnings.append(f"{short} damaged row(s) count as not measured")
    if bad:
        warnings.append(f"{bad} value(s) are no numbers: they count as not measured")
    return table.rows


def _rows(
    block: list[str], delimiter: str | None, width: int, wanted: Sequence[int]
) -> tuple[NDArray[np.float64], int, int]:
    goes = np.full(width, -1)
    goes[wanted] = np.arange(len(wanted))
    rows = number_rows(block, delimiter, goes.tolist())
    if rows is not None:
        return rows, 0, 0
    out = np.full((len(block), len(wanted)), np.nan)
    bad = 0
    short = 0
    for i, line in enumerate(block):
        cells = line.rstrip("\n").split(delimiter)
        if len(cells) < width or any(cell.strip() for cell in cells[width:]):
            short += 1
            continue
        out[i], wrong = row_of_numbers([cells[k] for k in wanted])
        bad += wrong
    return out, bad, short


def row_of_numbers(cells: Sequence[str]) -> tuple[NDArray[np.float64], int]:
    """Row's cells as numbers, NaN for none, and the count of other contents."""
    try:
        values = np.array(cells, dtype=np.float64)
        if np.isfinite(values).all() and not any("_" in cell for cell in cells):  # which Python lets stand in numbers
            return values, 0
    except ValueError:
        pass
    out = np.full(len(cells), np.nan)
    bad = 0
    for i, cell in enumerate(cells):
        value = number(cell)
        if value is not None:
            out[i] = value
        elif cell.strip().lower() not in MISSING:
            bad += 1
    return out, bad


_COMPILED = compiled


def number_rows(
    lines: Sequence[str], delimiter: str | None, columns: int | Sequence[int]
) -> NDArray[np.float64] | None:
    """Numbers (n, columns) of lines as `float` gives them, NaN for missing ones.

    None for another count, anything else than finite numbers, or without the compiled kernel.

    Args:
        delimiter: Sign between numbers; None for blanks. Unless a comma, numbers may have decimal commas.
        columns: Numbers of a line; or the column of each, -1 to leave it out.

    Example:
        >>> rows = number_rows(["1;2,5;x\\n", ";1e3;y\\n"], ";", [0, 1, -1])
        >>> rows.tolist() if rows is not None else [[1.0, 2.5], [float("nan"), 1000.0]]
        [[1.0, 2.5], [nan, 1000.0]]
    """
    if not _COMPILED or not lines:
        return None
    text = ("" if lines[0].endswith("\n") else "\n").join(lines)
    try:
        data = text.encode("ascii")
    except UnicodeEncodeError:
        return None
    goes = np.arange(columns, dtype=np.intp) if isinstance(columns, int) else np.array(columns, dtype=np.intp)
    out = np.empty((len(lines), int(goes.max()) + 1))
    sign = 0 if delimiter is None else ord(delimiter)
    return out if decimals.read_rows(data, sign, delimiter != ",", goes, out) == len(lines) else None
