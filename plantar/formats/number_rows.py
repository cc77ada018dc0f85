"""Lines of plain numbers, many at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.kernels import is_compiled
from plantar.kernels.formats import decimals

__all__ = ["number_rows"]

_COMPILED = is_compiled("decimals")


def number_rows(
    lines: Sequence[str], delimiter: str | None, columns: int | Sequence[int]
) -> NDArray[np.float64] | None:
    """Returns the numbers (n, columns) of lines, NaN where one is missing, each to the last bit as `float` gives it.

    None where a line has another count of them or anything that is no finite number, and without the compiled kernel.

    Args:
        lines: The lines, with their ends or without.
        delimiter: The sign between numbers, between two of which a number may be missing; None for any blanks. Unless
            it is a comma, numbers may have a decimal comma.
        columns: Number of numbers of a line; or for each of them the column that it goes to, -1 where it is left out.

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
