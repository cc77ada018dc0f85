"""Frames that are gathered block by block, so that a long recording is in memory once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.recordings.let_go import LARGE, blocks_of_frames, let_go, room

__all__ = ["MOST_VALUES", "FrameTable"]

MOST_VALUES = 400_000_000
"""Most numbers that a recording may hold: 3.2 GB."""


class FrameTable:
    """A table of numbers that grows by blocks of rows of `width` numbers, with room for the `expected` rows.

    It grows by a quarter beyond; earlier views of `rows` are invalid then.

    Example:
        >>> table = FrameTable(2, expected=3)
        >>> for _ in range(5):
        ...     table.add(np.ones((1, 2)))
        >>> table.rows.shape
        (5, 2)
    """

    def __init__(self, width: int, expected: int) -> None:
        self._values = room(max(0, min(expected, MOST_VALUES // max(width, 1))), width)
        self._filled = self._written = 0

    def __len__(self) -> int:
        return self._filled

    def add(self, block: NDArray[np.float64]) -> None:
        """Add rows `block` (m, width); a FormatError if the table becomes larger than MOST_VALUES."""
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
        before, self._values = self._values, room(rows, self._values.shape[1])
        for rows_of_block in blocks_of_frames(before[: self._filled]):
            self._values[rows_of_block] = before[rows_of_block]
            let_go(self._values)

    def drop_last(self) -> None:
        """Remove the last row."""
        self._filled -= 1

    @property
    def rows(self) -> NDArray[np.float64]:
        """The rows (n, width), a view."""
        return self._values[: self._filled]

    def columns(self, kept: NDArray[np.bool_]) -> NDArray[np.float64]:
        """The rows (n, k) of the columns in the mask `kept` (width,), compacted in place; the table is used up."""
        count = int(kept.sum())
        flat = self._values.reshape(-1)
        for rows in blocks_of_frames(self.rows):  # a row never lands behind where it is read from
            block = self._values[rows][:, kept]
            flat[rows.start * count : rows.start * count + block.size] = block.ravel()
        out = flat[: self._filled * count].reshape(self._filled, count)
        self._values, self._filled = np.empty((0, count)), 0
        return out
