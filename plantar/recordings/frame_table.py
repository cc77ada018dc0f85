"""Large tables of frames: blocks in an unnamed file, with pages released after reading."""

import mmap
import tempfile
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError

LARGE = 100_000_000
"""Bytes from which a table is kept in a file: smaller ones are quicker in memory."""


_BLOCK = 250_000  # Numbers that are worked on at a time: 2 MB


def room(rows: int, width: int) -> NDArray[np.float64]:
    """Returns uninitialised table (`rows`, `width`): in memory, or if large in a file that vanishes with it."""
    size = rows * width * 8
    if size > LARGE:
        try:
            with tempfile.TemporaryFile() as stream:  # the mapping keeps the file; its name is gone at once
                stream.truncate(size)
                pages = mmap.mmap(stream.fileno(), size)
            return np.frombuffer(pages, dtype=float).reshape(rows, width)
        except (OSError, ValueError):
            pass  # no room on the disk: memory may do
    return np.empty((rows, width))


def blocks_of_frames(values: NDArray[Any]) -> Iterator[slice]:
    """Row slices of a table `values` (n, k) in 2 MB blocks, each's pages released after it."""
    rows = max(1, _BLOCK // max(1, values[:1].size))
    for start in range(0, len(values), rows):
        yield slice(start, min(start + rows, len(values)))
        let_go(values)


def table_of_blocks(values: NDArray[np.float64], block: Callable[[slice], NDArray[np.float64]]) -> NDArray[np.float64]:
    """Returns table like `values` (n, k), large ones in a file, of what `block` gives for each slice of rows."""
    out = room(*values.shape)
    for rows in blocks_of_frames(values):
        out[rows] = block(rows)
        let_go(out)
    return out


def scale_frames(values: NDArray[np.float64], factor: float | NDArray[np.float64]) -> None:
    """Multiply a table `values` (n, k) in place by `factor`: a number, or one (k,) a column."""
    for rows in blocks_of_frames(values):
        values[rows] *= factor


def column_maxima(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest number (k,) of each column of a table (n, k), without missing ones; at least 0."""
    top = np.zeros(values.shape[1])
    for rows in blocks_of_frames(values):
        np.fmax(top, np.fmax.reduce(values[rows], axis=0, initial=0.0), out=top)
    return top


def let_go(array: NDArray[Any]) -> None:
    """Release pages of `array` in a mapped table: re-read from file when needed."""
    base: Any = array
    while base is not None and not isinstance(base, mmap.mmap):
        base = base.obj if isinstance(base, memoryview) else getattr(base, "base", None)
    if base is not None and hasattr(mmap, "MADV_DONTNEED"):
        base.madvise(mmap.MADV_DONTNEED)


MOST_VALUES = 400_000_000
"""Most numbers that a recording may hold: 3.2 GB."""


class FrameTable:
    """Number table that grows by blocks of `width` columns, with room for the `expected` rows.

    Growing beyond, by a quarter, invalidates earlier views of `rows`.

    Example:
        >>> table = FrameTable(2, expected=3)
        >>> for _ in range(5):
        ...     table.add(np.ones((1, 2)))
        >>> table.rows.shape
        (5, 2)
    """

    def __init__(self, width: int, expected: int) -> None:
        self._values = room(max(0, min(expected, MOST_VALUES // max(width, 1))), width)
        self._filled = 0
        self._written = 0

    def __len__(self) -> int:
        return self._filled

    def add(self, block: NDArray[np.float64]) -> None:
        """Add rows `block` (m, width); FormatError beyond MOST_VALUES."""
        end = self._filled + len(block)
        if end * self._values.shape[1] > MOST_VALUES:
            raise FormatError(
                f"more than {MOST_VALUES // max(self._values.shape[1], 1)} frames of {self._values.shape[1]} values; "
                f"allowed: {MOST_VALUES / 1e6:g} million values in all"
            )
        if end > len(self._values):
            self._grow(end + end // 4)
        self._values[self._filled : end] = block
        self._filled = end
        self._written += block.nbytes
        if self._written > LARGE:
            let_go(self._values)
            self._written = 0

    def _grow(self, rows: int) -> None:
        if self._values.flags.owndata and rows * self._values.shape[1] * 8 <= LARGE:
            self._values.resize((rows, self._values.shape[1]), refcheck=False)  # moves pages, copies nothing
            return
        before = self._values
        self._values = room(rows, self._values.shape[1])
        for rows_of_block in blocks_of_frames(before[: self._filled]):
            self._values[rows_of_block] = before[rows_of_block]
            let_go(self._values)

    def drop_last(self) -> None:
        """Remove the last row."""
        self._filled -= 1

    @property
    def rows(self) -> NDArray[np.float64]:
        """Rows (n, width), a view."""
        return self._values[: self._filled]

    def columns(self, kept: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Rows (n, k) of columns in mask `kept` (width,), compacted in place; uses up the table."""
        count = int(kept.sum())
        flat = self._values.reshape(-1)
        for rows in blocks_of_frames(self.rows):  # a row never lands behind where it is read from
            block = self._values[rows][:, kept]
            flat[rows.start * count : rows.start * count + block.size] = block.ravel()
        out = flat[: self._filled * count].reshape(self._filled, count)
        self._values = np.empty((0, count))
        self._filled = 0
        return out
