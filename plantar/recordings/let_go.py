"""Large tables of frames, kept in an unnamed file whose pages are released once they were read."""

from __future__ import annotations

import mmap
import tempfile
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["LARGE", "blocks_of_frames", "column_maxima", "let_go", "room", "scale_frames"]

LARGE = 100_000_000
"""Bytes from which a table is kept in a file: smaller ones are quicker in memory."""


_BLOCK = 250_000
"""Numbers that are worked on at a time: 2 MB."""


def room(rows: int, width: int) -> NDArray[np.float64]:
    """Returns an uninitialised table (`rows`, `width`): in memory, or where it is large in a file that vanishes with
    it.
    """
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
    """Row slices of a table `values` (n, k) in blocks of 2 MB; the pages of each are released after it."""
    rows = max(1, _BLOCK // max(1, values[:1].size))
    for start in range(0, len(values), rows):
        yield slice(start, min(start + rows, len(values)))
        let_go(values)


def scale_frames(values: NDArray[np.float64], factor: float | NDArray[np.float64]) -> None:
    """Multiply a table `values` (n, k) in place by a `factor`: a number, or one (k,) for each column."""
    for rows in blocks_of_frames(values):
        values[rows] *= factor


def column_maxima(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest number (k,) of each column of a table (n, k), missing ones left out; 0 at the least."""
    top = np.zeros(values.shape[1])
    for rows in blocks_of_frames(values):
        np.fmax(top, np.fmax.reduce(values[rows], axis=0, initial=0.0), out=top)
    return top


def let_go(array: NDArray[Any]) -> None:
    """Release the pages of `array` where it is part of a mapped table: they are read again from its file when
    needed.
    """
    base: Any = array
    while base is not None and not isinstance(base, mmap.mmap):
        base = base.obj if isinstance(base, memoryview) else getattr(base, "base", None)
    if base is not None and hasattr(mmap, "MADV_DONTNEED"):
        base.madvise(mmap.MADV_DONTNEED)
