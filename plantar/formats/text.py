"""Reading text exports: any encoding, any line end, comma or point, and numbers that are none."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError

__all__ = ["encoding_of", "number", "number_in", "open_text", "row_of_numbers", "seconds_of_clock"]

_NUMBER = re.compile(r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?")


def open_text(path: Path) -> TextIO:
    """A text file opened for reading line by line, its encoding found from its beginning, its line ends made one.

    Args:
        path: The file.

    Returns:
        The open stream.

    Raises:
        FormatError: If the file cannot be read.
    """
    try:
        with path.open("rb") as stream:
            head = stream.read(1 << 20)
        return path.open(encoding=encoding_of(head), errors="replace", newline=None)
    except OSError as error:
        raise FormatError(f"{path}: cannot be read ({error.strerror})") from None


def encoding_of(head: bytes) -> str:
    """Encoding of a text from its first bytes: UTF-16 and UTF-8 where they are marked or valid, else Latin-1.

    Example:
        >>> encoding_of("N/cm²".encode()), encoding_of("N/cm²".encode("latin-1"))
        ('utf-8', 'latin-1')
    """
    for mark, encoding in ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig")):
        if head.startswith(mark):
            return encoding
    try:
        head[: -4 if len(head) > 4096 else None].decode("utf-8")
    except UnicodeDecodeError:
        good = len(re.findall(rb"[\xc2-\xdf][\x80-\xbf]|[\xe0-\xef][\x80-\xbf]{2}", head))
        return "utf-8" if good else "latin-1"  # one damaged byte does not make another encoding
    return "utf-8"


def number(text: str) -> float | None:
    """A number with a decimal point or comma, None where it is none or not finite.

    Example:
        >>> number(" 1,5 "), number("1.5e3"), number("1.2.3"), number("nan")
        (1.5, 1500.0, None, None)
    """
    cleaned = text.strip().strip('"')
    if not _NUMBER.fullmatch(cleaned):
        return None
    value = float(cleaned.replace(",", "."))
    return value if np.isfinite(value) else None


def number_in(text: str) -> float | None:
    """The first number in a text, None where there is none.

    Example:
        >>> number_in("5.08 mm"), number_in("none")
        (5.08, None)
    """
    match = _NUMBER.search(text)
    return number(match[0]) if match else None


def row_of_numbers(cells: Sequence[str]) -> tuple[NDArray[np.float64], int]:
    """Cells of a row as numbers, NaN where a cell is none.

    Args:
        cells: The cells' texts.

    Returns:
        The numbers, and how many cells hold something that is not a number; empty ones do not count.
    """
    out = np.full(len(cells), np.nan)
    bad = 0
    for i, cell in enumerate(cells):
        value = number(cell)
        if value is not None:
            out[i] = value
        elif cell.strip():
            bad += 1
    return out, bad


def seconds_of_clock(text: str) -> float | None:
    """Seconds since midnight of a time such as 08:21:17.982, None where it is none.

    Example:
        >>> seconds_of_clock("08:21:17.982")
        30077.982
    """
    match = re.search(r"(\d{1,2}):(\d{2}):(\d{2}(?:[.,:]\d+)?)", text)
    if match is None:
        return None
    seconds = match[3].replace(",", ".").replace(":", ".")
    return round(3600.0 * int(match[1]) + 60.0 * int(match[2]) + float(seconds), 6)
