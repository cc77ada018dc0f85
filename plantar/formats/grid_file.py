"""NPZ and NPY files of one array that is read piece by piece: footsteps or frames of a walkway, of any size."""

import io
import math
import os
import tokenize
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import open_input
from plantar.common.files.zip_archive import open_archive
from plantar.errors import FormatError

LARGEST = 4e9
"""Largest size of an array in bytes that is read in pieces: 25 minutes of a walkway in bytes."""

_PACKS = 1100.0  # zlib packs zeros to no less than a 1,032nd, and most of a walkway is zeros
_HEADER = 4096  # bytes of a file, or unpacked part, that hold numpy's header
_LOCAL = 30  # bytes of a ZIP part's own header before its name


@dataclass(frozen=True)
class ArrayHead:
    """Shape and type of a file's array."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]


def head_of_array(head: bytes) -> ArrayHead | None:
    """Shape and type of the first array by a file's first bytes, packed or not; None where they show none."""
    data = head
    if head[:4] == b"PK\x03\x04" and len(head) > _LOCAL:
        method = int.from_bytes(head[8:10], "little")
        names = sum(int.from_bytes(head[at : at + 2], "little") for at in (26, 28))
        data = head[_LOCAL + names :]
        if method == 8:
            try:
                data = zlib.decompressobj(-zlib.MAX_WBITS).decompress(data[:_HEADER], _HEADER)
            except zlib.error:
                return None
    return _head(data[:_HEADER])


def read_header(stream: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Read numpy's header at the begin of a stream: shape, whether by columns, and type; ValueError if it is none."""
    version = np.lib.format.read_magic(stream)
    if version not in ((1, 0), (2, 0)):
        raise ValueError(f"version {version[0]}.{version[1]} of numpy's format")
    reader = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    return reader(stream)


def _head(data: bytes) -> ArrayHead | None:
    try:
        shape, fortran, dtype = read_header(io.BytesIO(data))
    except (ValueError, EOFError, SyntaxError, tokenize.TokenError):  # numpy reads old headers as Python's text
        return None
    return ArrayHead(shape, dtype) if not fortran and dtype.kind in "iufb" and shape else None


class GridArray:
    """An open array whose first dimension is read in blocks, in order and once."""

    def __init__(self, stream: IO[bytes], head: ArrayHead) -> None:
        self.shape = head.shape
        self.dtype = head.dtype
        self._stream = stream

    def blocks(self, most_bytes: int) -> Iterator[NDArray[Any]]:
        """Blocks of up to so many bytes, and of one entry at least."""
        one = math.prod(self.shape[1:]) * self.dtype.itemsize
        count = max(1, most_bytes // max(1, one))
        left = self.shape[0]
        while left:
            rows = min(count, left)
            data = self._stream.read(rows * one)
            if len(data) < rows * one:
                raise FormatError(f"the array ends {left} entries early: cut short?")
            yield np.frombuffer(data, self.dtype).reshape(rows, *self.shape[1:])
            left -= rows


def opened_array(stream: IO[bytes]) -> GridArray:
    """Array of a stream at the begin of numpy's format, whose header is known to state numbers by rows."""
    shape, _, dtype = read_header(stream)
    return GridArray(stream, ArrayHead(shape, dtype))


@contextmanager
def open_grid(path: str | os.PathLike[str]) -> Iterator[GridArray]:
    """Open the one array of an NPZ or NPY file; FormatError if it is none, holds objects or is too large."""
    try:
        with open_input(path, FormatError) as stream:
            packed = stream.read(2) == b"PK"
        if not packed:
            with open_input(path, FormatError) as stream:
                yield _opened(stream, os.fstat(stream.fileno()).st_size, Path(path))
            return
        with open_archive(path, FormatError, LARGEST, _PACKS) as (archive, _):
            parts = [part for part in archive.infolist() if part.filename.endswith(".npy")]
            if not parts:
                raise FormatError(f"{path}: no array in it; allowed: an NPZ file of one array")
            part = max(parts, key=lambda p: p.file_size)
            with archive.open(part) as stream:
                yield _opened(stream, part.file_size, Path(path))
    except (zlib.error, OSError, EOFError, ValueError) as error:
        raise FormatError(f"{path}: not an array that can be read ({error})") from None


def _opened(stream: IO[bytes], size: int, path: Path) -> GridArray:
    shape, fortran, dtype = read_header(stream)
    if fortran or dtype.hasobject or dtype.kind not in "iufb":
        raise FormatError(f"{path}: an array of {dtype}{' by columns' if fortran else ''}; allowed: numbers by rows")
    if min(shape, default=0) < 0 or math.prod(shape) * dtype.itemsize > min(LARGEST, size):
        raise FormatError(
            f"{path}: an array of shape {shape} in {size} bytes; allowed: what its shape states, up to "
            f"{LARGEST / 1e9:g} GB"
        )
    return GridArray(stream, ArrayHead(shape, dtype))
