"""Large tables of frames: blocks in an unnamed file, with pages released after reading."""

import mmap
import os
import tempfile
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError, InputError

LARGE = 100_000_000
"""Bytes from which a table is kept in a file: smaller ones are quicker in memory."""


_BLOCK = 250_000  # Numbers that are worked on at a time: 2 MB
_MAY_WRITE = hasattr(os, "pwrite")  # not on Windows


class _Pages(mmap.mmap):
    """Mapped file of a table, its descriptor and the address of its first number."""

    file = -1
    address = 0

    def __del__(self) -> None:
        if self.file >= 0:
            os.close(self.file)


def room(rows: int, width: int) -> NDArray[np.float64]:
    """Returns uninitialised table (`rows`, `width`): in memory, or if large in a file that vanishes with it."""
    size = rows * width * 8
    if size > LARGE:
        try:
            with tempfile.TemporaryFile() as stream:  # the mapping keeps the file; its name is gone at once
                stream.truncate(size)
                pages = _Pages(stream.fileno(), size)
                pages.file = os.dup(stream.fileno())
            table = np.frombuffer(pages, dtype=float).reshape(rows, width)
            pages.address = table.ctypes.data
            return table
        except (OSError, ValueError):
            pass  # no room on the disk: memory may do
    return np.empty((rows, width))


def put_rows(values: NDArray[np.float64], first: int, block: NDArray[np.float64]) -> None:
    """Set rows of a table `values` (n, k) from the `first` on to a `block` (m, k).

    Tables in files are written, not assigned: a page that is assigned to is first read from the file, or cleared.
    InputError where the disk has no room.
    """
    pages = _mapping(values)
    if pages is None or not values.flags.c_contiguous or not _MAY_WRITE:
        values[first : first + len(block)] = block
        return
    at = values.ctypes.data - pages.address + first * values.shape[1] * 8
    left = np.ascontiguousarray(block, dtype=float).reshape(-1).view(np.uint8).data
    while len(left):
        try:
            written = os.pwrite(pages.file, left, at)
        except OSError as error:
            raise InputError(
                f"no room in {tempfile.gettempdir()} for a table of up to {values.nbytes / 1e6:.0f} MB "
                f"({error.strerror}); free some, or name another folder by TMPDIR"
            ) from None
        at += written
        left = left[written:]


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
        put_rows(out, rows.start, block(rows))
        let_go(out)
    return out


def scale_frames(values: NDArray[np.float64], factor: float | NDArray[np.float64]) -> None:
    """Multiply a table `values` (n, k) in place by `factor`: a number, or one (k,) a column."""
    for rows in blocks_of_frames(values):
        put_rows(values, rows.start, values[rows] * factor)


class ColumnExtremes(NamedTuple):
    """Of a table's columns.

    `low`, `high`: smallest and largest number (k,) of each, at most and at least 0; `lacking`: blocks of rows that hold
    a NaN.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    lacking: tuple[slice, ...]


def column_extremes(values: NDArray[np.float64]) -> ColumnExtremes:
    """Extremes of each column of a table (n, k), in one pass."""
    low = np.zeros(values.shape[1])
    high = np.zeros(values.shape[1])
    lacking = []
    for rows in blocks_of_frames(values):
        part = values[rows]
        least = _by_halves(np.minimum, part)
        if np.isnan(least).any():
            lacking.append(rows)
            least = _by_halves(np.fmin, part)
        np.fmin(low, least, out=low)
        np.fmax(high, _by_halves(np.fmax, part), out=high)
    return ColumnExtremes(low, high, tuple(lacking))


def _by_halves(chosen: Callable[..., NDArray[np.float64]], rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """`chosen.reduce(rows)`: whole rows at once are many times as quick as row by row."""
    while len(rows) > 1:
        half = (len(rows) + 1) // 2
        rows = chosen(rows[:half], rows[-half:])
    return np.asarray(rows[0])


def let_go(array: NDArray[Any]) -> None:
    """Release pages of `array` in a mapped table: re-read from file when needed."""
    pages = _mapping(array)
    if pages is not None and hasattr(mmap, "MADV_DONTNEED"):
        pages.madvise(mmap.MADV_DONTNEED)


def _mapping(array: NDArray[Any]) -> _Pages | None:
    base: Any = array
    while base is not None and not isinstance(base, _Pages):
        base = base.obj if isinstance(base, memoryview) else getattr(base, "base", None)
    return base


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
        put_rows(self._values, self._filled, block)
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
            put_rows(self._values, rows_of_block.start, before[rows_of_block])
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
