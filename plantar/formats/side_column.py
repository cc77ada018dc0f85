"""Tables in which a column says of which foot each row is: their rows as columns of both feet on one time base."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.side import side_of
from plantar.sides import SIDES, Side

__all__ = ["is_side_column", "on_one_time", "rows_of_sides", "with_numbers"]

_NAME = re.compile(
    r"\W*(?:side|foot|sole|insole|shoe|leg|limb|fu(?:ss|ß)|seite|pied|pie)(?:[ _-]?(?:side|id))?\W*", re.IGNORECASE
)
_MARK: dict[Side, str] = {"left": "0", "right": "1"}


def is_side_column(name: str) -> bool:
    """Whether a column of this name says of which foot a row is.

    Example:
        >>> [is_side_column(name) for name in ("Side", "foot", "sole_id", "left 12", "footprint 3")]
        [True, True, True, False, False]
    """
    return _NAME.fullmatch(name) is not None


def with_numbers(lines: Iterator[str], delimiter: str | None, column: int) -> Iterator[str]:
    """Lines in whose side column 0 stands for the left foot and 1 for the right one.

    Args:
        lines: Lines of a table.
        delimiter: What stands between its cells; None for blanks.
        column: The side column.

    Yields:
        The lines; those whose cell names no foot as they are.
    """
    known: dict[str, str] = {}
    for line in lines:
        cells = line.split(delimiter)
        if column < len(cells):
            text = cells[column]
            if text not in known:
                side = side_of(text.strip().strip('"'))
                known[text] = text if side is None else _MARK[side]
            cells[column] = known[text]
        yield (delimiter or " ").join(cells)


def rows_of_sides(values: NDArray[np.float64], warnings: list[str]) -> dict[Side, NDArray[np.int64]]:
    """The rows of each foot.

    Args:
        values: What the side column (n,) holds as numbers.
        warnings: Where an assumption is put.

    Returns:
        Indices of the rows of each foot that has some.

    Raises:
        FormatError: If the column holds more than two values.
    """
    kinds = np.unique(values[np.isfinite(values)])
    if len(kinds) > 2 or len(kinds) == 0:
        raise FormatError(
            f"the column of sides holds {len(kinds)} different values; allowed: two, such as left and right"
        )
    if not set(kinds.tolist()) <= {0.0, 1.0}:
        warnings.append(
            f"the column of sides holds {kinds[0]:g} and {kinds[-1]:g}: the smaller is taken as the left foot"
        )
    lost = int((~np.isfinite(values)).sum())
    if lost:
        warnings.append(f"{lost} row(s) name no foot: left out")
    if len(kinds) == 1:
        side: Side = "right" if kinds[0] == 1.0 else "left"
        return {side: np.flatnonzero(values == kinds[0])}
    return {side: np.flatnonzero(values == kind) for side, kind in zip(SIDES, kinds, strict=True)}


def on_one_time(
    time: NDArray[np.float64], rows: dict[Side, NDArray[np.int64]], columns: Sequence[NDArray[np.float64]]
) -> tuple[NDArray[np.float64], dict[Side, NDArray[np.float64]], bool]:
    """Rows of both feet side by side.

    Args:
        time: Time (n,) of each row.
        rows: The rows of each foot.
        columns: Columns (n,) of values.

    Returns:
        Times (m,); values (m, k) of each foot; and whether the feet's times differed, so that the right foot's values
        were interpolated at the left one's.
    """
    if len(rows) == 1:
        ((side, own),) = rows.items()
        return time[own], {side: np.column_stack([c[own] for c in columns])}, False
    left, right = rows["left"], rows["right"]
    if len(left) == len(right) and np.array_equal(time[left], time[right], equal_nan=True):
        return time[left], {side: np.column_stack([c[own] for c in columns]) for side, own in rows.items()}, False
    right = right[np.isfinite(time[right])]
    right = right[np.argsort(time[right], kind="stable")]
    begin, end = time[right[0]], time[right[-1]]
    left = left[(time[left] >= begin) & (time[left] <= end)]
    if len(left) < 2:
        raise FormatError("the rows of the two feet share no time")
    feet: dict[Side, NDArray[np.float64]] = {
        "left": np.column_stack([c[left] for c in columns]),
        "right": np.column_stack([np.interp(time[left], time[right], c[right]) for c in columns]),
    }
    return time[left], feet, True
