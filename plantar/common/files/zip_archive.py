"""Opens foreign ZIP archives (NPZ, 3MF, XLSX): unpacked size is checked first."""

import os
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

from plantar.common.files.input_file import open_input
from plantar.errors import PlantarError

_MOST_PARTS = 4096
_LARGEST_LIST = 1_000_000  # bytes of the list of parts
_ANYHOW = 100e6  # bytes that any archive may unpack to
_RATIO = 100.0  # measurements and meshes pack to a tenth or so, zeros to a thousandth
ALLOWED = f"up to {_ANYHOW / 1e6:.0f} MB, or {_RATIO:g} times the file"
"""What `is_bomb` lets pass, for messages."""

_END = b"PK\x05\x06"
_END_64 = b"PK\x06\x06"


def is_bomb(size: float, unpacked: float, ratio: float = _RATIO) -> bool:
    """Returns whether a file of `size` bytes unpacks to more than measurements and meshes do: `unpacked`, as stated.

    `ratio`: how many times its size, by default 100.

    Example:
        >>> is_bomb(1e6, 99e6), is_bomb(1e6, 101e6), is_bomb(2e6, 101e6)
        (False, True, False)
    """
    return unpacked > _ANYHOW and unpacked > ratio * size


@contextmanager
def open_archive(
    path: str | os.PathLike[str], error: type[PlantarError], most: float, ratio: float = _RATIO
) -> Iterator[tuple[zipfile.ZipFile, BinaryIO]]:
    """Open the ZIP archive at `path`; yields archive and its file.

    Raises `error` for a bad one, or one that unpacks to more than `most` bytes in all, or than `ratio` times its size:
    above 100 only for what is read in pieces.

    Example:
        >>> import tempfile
        >>> with tempfile.NamedTemporaryFile(suffix=".zip") as file:
        ...     with zipfile.ZipFile(file, "w") as archive:
        ...         archive.writestr("a", "text")
        ...     file.flush()
        ...     with open_archive(file.name, PlantarError, most=100) as (archive, _):
        ...         archive.read("a")
        b'text'
    """
    with open_input(path, error) as stream:
        size = os.fstat(stream.fileno()).st_size
        if _size_of_list(stream, size) > _LARGEST_LIST:
            raise error(f"{path}: an archive of more parts than can be read; allowed: up to {_MOST_PARTS}")
        stream.seek(0)
        try:
            archive = zipfile.ZipFile(stream)
        except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, struct.error) as problem:
            raise error(f"{path}: not an archive that can be read ({problem})") from None
        with archive:
            parts = archive.infolist()
            unpacked = sum(part.file_size for part in parts)
            if any(part.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) for part in parts):
                raise error(f"{path}: parts packed in a way that is not read; allowed: stored or deflated")
            if len(parts) > _MOST_PARTS:
                raise error(f"{path}: an archive of {len(parts)} parts; allowed: up to {_MOST_PARTS}")
            if unpacked > most:
                raise error(f"{path}: unpacks to {unpacked / 1e6:.0f} MB; allowed: up to {most / 1e6:.0f} MB")
            if is_bomb(size, unpacked, ratio):
                raise error(
                    f"{path}: {size / 1e6:.3g} MB that unpack to {unpacked / 1e6:.0f} MB; allowed: {ALLOWED} "
                    "(store it uncompressed)"
                )
            yield archive, stream


def read_part(archive: zipfile.ZipFile, name: str, error: type[PlantarError], where: str) -> bytes:
    """Returns bytes of part `name` of an `archive` of `open_archive`, checked by stated length and checksum.

    Raises `error`, its message beginning with `where`, if missing, damaged or encrypted.
    """
    try:
        return archive.read(name)
    except KeyError:
        raise error(f"{where}: the archive lacks the part {name[:80]}") from None
    except (
        zipfile.BadZipFile,
        zlib.error,
        ValueError,
        OSError,
        EOFError,
        RuntimeError,
        NotImplementedError,
        struct.error,
    ) as problem:
        raise error(f"{where}: a part of the archive is damaged ({problem})") from None


def _size_of_list(stream: BinaryIO, size: int) -> int:
    """Bytes of the archive's list of parts stated at its end, or 0."""
    tail_size = min(size, 66_000)
    stream.seek(size - tail_size)
    tail = stream.read(tail_size)
    at = tail.rfind(_END)
    if at < 0 or len(tail) < at + 22:
        return 0
    stated = int(struct.unpack_from("<I", tail, at + 12)[0])
    larger = tail.rfind(_END_64)
    if stated == 0xFFFFFFFF and larger >= 0 and len(tail) >= larger + 56:
        return int(struct.unpack_from("<Q", tail, larger + 40)[0])
    return stated
